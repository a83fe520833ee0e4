#pragma once

#include <optional>
#include <string>

#include "server/http/body.h"
#include "server/http/byte_budget.h"
#include "server/http/connection.h"
#include "server/http/head.h"
#include "server/http/http.h"

namespace papilio::server {

/// One request on its connection, as the handlers see it.
class Exchange final : public Request {
 public:
  /// `held`: what its body takes of the memory for all bodies.
  Exchange(Connection& connection, const HttpOptions& options, ByteBudget& held)
      : connection_(connection), options_(options), held_(held) {}

  /// Takes the head, which is ready, from the connection and parses it. Throws `Problem`.
  void receive();
  /// Refuses a body that would not be read. Throws `Problem`.
  void refuse_unreadable() const;
  /// True when the next bytes of the connection begin another request, and the client wants to send one.
  /// False for as long as any of this one's are left: they would be executed as a request.
  [[nodiscard]] bool may_keep_alive() const;
  [[nodiscard]] const Head& head() const { return head_; }
  /// The body's memory is free again.
  void release_body() { held_.give_back(); }
  /// Without a name the client is known by its address.
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
  std::optional<BodyReader> body_;  ///< empty until the framing is known
  bool body_taken_ = false;
};

}  // namespace papilio::server
