#pragma once

#include <openssl/ssl.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace papilio::test {

/// Writes a new P-256 key and its self-signed certificate as PEM files.
void write_certificate(const std::filesystem::path& certificate, const std::filesystem::path& key,
                       const std::string& common_name);

/// A TLS client on a loopback port with control of records and shutdown. It trusts any certificate. SIGPIPE is blocked
/// in the thread that creates it.
class TlsClient {
 public:
  /// Connects without a handshake, which the first `send` or `receive` does.
  explicit TlsClient(int port, int receive_buffer = 0);
  ~TlsClient();
  TlsClient(const TlsClient&) = delete;
  TlsClient& operator=(const TlsClient&) = delete;

  bool handshake() { return SSL_connect(ssl_.get()) == 1; }
  bool send(std::string_view bytes);
  /// Sends raw bytes without encryption.
  bool send_raw(std::string_view bytes) const;
  /// Receives at least one byte and at most `most`; "" at the end.
  std::string receive(size_t most = 65536);
  /// Receives until the bytes end with `end` or the connection ends.
  std::string receive_until(std::string_view end);
  /// Returns true if the server ends the connection with a close_notify, not with a bare end or a reset.
  bool at_proper_end();
  /// Sends close_notify and leaves the socket open.
  void say_goodbye() { SSL_shutdown(ssl_.get()); }
  /// Sends a record without data. Returns false once the connection is closed.
  bool send_key_update();

  [[nodiscard]] std::string common_name() const;          ///< of the server's certificate
  [[nodiscard]] std::string protocol() const;             ///< chosen by ALPN
  void offer_protocols(std::string_view list);            ///< in ALPN's form
  [[nodiscard]] int records() const { return records_; }  ///< of application data, received
  [[nodiscard]] int fd() const { return fd_; }

 private:
  struct Free {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
    void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
  };
  int fd_;
  std::unique_ptr<SSL_CTX, Free> context_;
  std::unique_ptr<SSL, Free> ssl_;
  int records_ = 0;
};

}  // namespace papilio::test
