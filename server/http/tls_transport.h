#pragma once

#include <openssl/ssl.h>

#include <memory>
#include <string>

#include "server/http/transport.h"

namespace papilio::server {

/// The server's side of one TLS connection.
class TlsTransport final : public Transport {
 public:
  /// Throws std::bad_alloc.
  TlsTransport(int fd, SSL_CTX* context);
  ~TlsTransport() override;

  Step read(char* into, size_t size) override;
  /// What is written with `more` is kept, up to a record's size, and encrypted together with what follows.
  Step write(std::string_view bytes, bool more) override;
  /// Besides the socket's end, the client's close_notify counts, unless data that nobody has read yet came before it.
  bool peer_gone() override;
  Step end_writing() override;

 private:
  struct Free {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };
  /// The step that OpenSSL's result means.
  Step step_of(int result, size_t bytes);
  Step send_close_notify();

  std::unique_ptr<SSL, Free> ssl_;
  std::string kept_;         ///< written with `more`, and what is sent in the same record
  size_t kept_of_call_ = 0;  ///< of it, the bytes of a call that is still to report them
  bool failed_ = false;      ///< OpenSSL allows no further call
};

}  // namespace papilio::server
