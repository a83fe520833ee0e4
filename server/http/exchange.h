#pragma once

#include <optional>
#include <string>

#include "server/http/body.h"
#include "server/http/byte_budget.h"
#include "server/http/connection.h"
#include "server/http/head.h"
#include "server/http/http.h"

namespace papilio::server {

/// One request on its connection, in the form for handlers.
class Exchange final : public Request {
 public:
  /// Starts without a head. `held`: budget of all bodies.
  Exchange(Connection& connection, const HttpOptions& options, ByteBudget& held)
      : connection_(connection), options_(options), held_(held) {}

  /// Takes the ready head from the connection and parses it. Throws `Problem`.
  void receive();
  /// Throws `Problem` for a body that would not be read.
  void refuse_unreadable() const;
  /// Returns whether another request may follow: the client keeps the connection, and no byte of this request is left,
  /// which would be executed as a request.
  [[nodiscard]] bool may_keep_alive() const;
  [[nodiscard]] const Head& head() const { return head_; }
  /// Returns the body's share of the budget.
  void release_body() { held_.give_back(); }
  /// Sets the client's name; an empty one stands for its address.
  void set_client(const std::string& name);
  void set_path_parameters(Fields parameters) { path_parameters_ = std::move(parameters); }

  [[nodiscard]] const std::string& method() const override { return head_.method; }
  [[nodiscard]] const std::string& path() const override { return head_.path; }
  [[nodiscard]] std::string path_parameter(std::string_view name) const override;
  [[nodiscard]] const Fields& query() const override { return head_.query; }
  [[nodiscard]] std::string header(std::string_view name) const override { return head_.field(name); }
  [[nodiscard]] const std::string& remote_address() const override { return connection_.remote_address(); }
  [[nodiscard]] const std::string& client() const override { return client_; }
  [[nodiscard]] const std::string& id() const override { return id_; }
  [[nodiscard]] std::string content_type() const override;
  [[nodiscard]] Body read_body() override;
  [[nodiscard]] bool client_gone() const override { return connection_.peer_gone(); }

 private:
  Connection& connection_;
  const HttpOptions& options_;
  ByteBudget::Share held_;
  Head head_;
  Fields path_parameters_;
  std::string id_;
  std::string client_;
  Framing framing_;
  std::optional<BodyReader> body_;  ///< reader; empty until the framing is known
  bool body_taken_ = false;
};

}  // namespace papilio::server
