#pragma once

#include <openssl/ssl.h>

#include <memory>
#include <string>

#include "server/http/transport.h"

namespace papilio::server {

/// Server's side of one TLS connection.
class TlsTransport final : public Transport {
 public:
  /// Takes the socket. Throws std::bad_alloc.
  TlsTransport(int fd, SSL_CTX* context);
  ~TlsTransport() override;

  Step read(char* into, size_t size) override;
  /// Writes bytes. With `more`, up to a record's size is kept and encrypted together with later bytes.
  Step write(std::string_view bytes, bool more) override;
  /// Returns whether the socket is closed, or the client's close_notify has arrived without unread data before it.
  bool peer_gone() override;
  Step end_writing() override;

 private:
  struct Free {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };
  /// Converts OpenSSL's result to a step.
  Step step_of(int result, size_t bytes);
  Step send_close_notify();

  std::unique_ptr<SSL, Free> ssl_;
  std::string kept_;         ///< bytes written with `more`, and later bytes of the same record
  size_t kept_of_call_ = 0;  ///< bytes of `kept_` that a repeated call has to report
  bool failed_ = false;      ///< whether OpenSSL permits no further call
};

}  // namespace papilio::server
