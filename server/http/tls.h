#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "server/http/transport.h"

// TLS 1.2 and 1.3 by OpenSSL, without renegotiation, compression or session cache.

using SSL_CTX = struct ssl_ctx_st;

namespace papilio::server {

/// A server's certificate and key. Any thread may use it.
class TlsContext {
 public:
  /// PEM files: the certificate followed by its intermediates, and its key without a passphrase. Throws
  /// std::runtime_error, naming the setting and the file.
  TlsContext(std::string certificate_file, std::string key_file);

  /// Reads both files anew: connections made from then on get the new certificate, others keep theirs. Throws
  /// like the constructor; the old ones then stay in use.
  void reload();
  /// The server's side of a new connection. The handshake takes place within its first reads, so what bounds these
  /// bounds it as well.
  [[nodiscard]] std::unique_ptr<Transport> transport(int fd) const;

 private:
  [[nodiscard]] std::shared_ptr<SSL_CTX> current() const;

  const std::string certificate_file_;
  const std::string key_file_;
  mutable std::mutex mutex_;
  std::shared_ptr<SSL_CTX> context_;  ///< guarded by mutex_; what it points to is never changed
};

}  // namespace papilio::server
