#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "server/http/transport.h"

// TLS 1.2 and 1.3 by OpenSSL, without renegotiation, compression or session cache.

using SSL_CTX = struct ssl_ctx_st;

namespace papilio::server {

/// Certificate and key of a server. Thread-safe.
class TlsContext {
 public:
  /// Reads PEM files: the certificate followed by its intermediates, and its key without a passphrase. Throws
  /// std::runtime_error with the setting's name and the file.
  TlsContext(std::string certificate_file, std::string key_file);

  /// Reloads both files: new connections get the new certificate, others keep theirs. Throws as the constructor; the
  /// old ones then stay in use.
  void reload();
  /// Returns the server's side of a new connection. The handshake takes place within its first reads, and shares their
  /// bound.
  [[nodiscard]] std::unique_ptr<Transport> transport(int fd) const;

 private:
  [[nodiscard]] std::shared_ptr<SSL_CTX> current() const;

  const std::string certificate_file_;
  const std::string key_file_;
  mutable std::mutex mutex_;
  std::shared_ptr<SSL_CTX> context_;  ///< immutable context; the pointer is guarded by mutex_
};

}  // namespace papilio::server
