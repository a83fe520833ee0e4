#pragma once

#include <string>

#include "server/http/connection.h"
#include "server/http/exchange.h"
#include "server/http/gate.h"
#include "server/http/http.h"
#include "server/http/listener.h"
#include "server/http/routes.h"

namespace papilio::server {

/// The requests of one connection, one after the other.
class Session {
 public:
  Session(Connection& connection, const HttpOptions& options, ByteBudget& held, const Routes& routes, Gate& gate,
          const Listener& listener)
      : connection_(connection), options_(options), held_(held), routes_(routes), gate_(gate), listener_(listener) {}

  void run();

 private:
  /// Returns whether another request may follow.
  bool answer_one(bool last);
  [[nodiscard]] Response refusal(const Exchange& exchange, const proto::Problem& problem, Finished& finished) const;

  Connection& connection_;
  const HttpOptions& options_;
  ByteBudget& held_;
  const Routes& routes_;
  Gate& gate_;
  const Listener& listener_;
};

}  // namespace papilio::server
