#pragma once

#include <memory>
#include <string>

#include "server/http/connection.h"
#include "server/http/exchange.h"
#include "server/http/gate.h"
#include "server/http/held_answers.h"
#include "server/http/http.h"
#include "server/http/listener.h"
#include "server/http/routes.h"

namespace papilio::server {

/// Session on one connection: its requests, one after the other. Used by one thread at a time.
class Session {
 public:
  Session(std::unique_ptr<Transport> transport, const HttpOptions& options, ByteBudget& held, HeldAnswers& answers,
          const Routes& routes, Gate& gate, const Listener& listener);

  /// Next event of the session.
  struct Next {
    enum class What { request, bytes, nothing };
    What what;
    short wait_for = 0;  ///< for `bytes`: events that the socket must be ready for
  };
  /// Answers one request if its head is complete or arrives at once. Does not block for a silent client.
  Next run();
  [[nodiscard]] Connection& connection() { return connection_; }

 private:
  /// Answers one request. Returns whether another may follow.
  bool answer_one(bool last);
  [[nodiscard]] Response refusal(const Exchange& exchange, const proto::Problem& problem, Finished& finished) const;

  Connection connection_;
  int served_ = 0;
  const HttpOptions& options_;
  ByteBudget& held_;
  HeldAnswers& answers_;
  const Routes& routes_;
  Gate& gate_;
  const Listener& listener_;
};

}  // namespace papilio::server
