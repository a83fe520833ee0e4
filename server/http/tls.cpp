#include "server/http/tls.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <array>
#include <new>
#include <stdexcept>

#include "server/http/tls_transport.h"

namespace papilio::server {
namespace {

/// Returns OpenSSL's message for its first error, and clears its queue of errors.
std::string reason() {
  const unsigned long error = ERR_get_error();
  std::array<char, 256> text{};
  ERR_error_string_n(error, text.data(), text.size());
  const char* words = ERR_reason_error_string(error);
  ERR_clear_error();
  return words == nullptr ? text.data() : words;
}

/// Selects HTTP/1.1 of the protocols that a client offers; refuses a client that offers only others.
int choose_protocol(SSL* /*ssl*/, const unsigned char** chosen, unsigned char* chosen_size,
                    const unsigned char* offered, unsigned offered_size, void* /*unused*/) {
  constexpr std::string_view own = "\x08http/1.1";
  unsigned char* found = nullptr;
  const int outcome = SSL_select_next_proto(&found, chosen_size, reinterpret_cast<const unsigned char*>(own.data()),
                                            static_cast<unsigned>(own.size()), offered, offered_size);
  *chosen = found;
  return outcome == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

/// Refuses a key with a passphrase, in place of OpenSSL's prompt on the terminal.
int no_passphrase(char* /*into*/, int /*size*/, int /*writing*/, void* /*unused*/) { return -1; }

std::shared_ptr<SSL_CTX> make_context(const std::string& certificate_file, const std::string& key_file) {
  ERR_clear_error();
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context) throw std::bad_alloc();
  SSL_CTX* const c = context.get();
  SSL_CTX_set_min_proto_version(c, TLS1_2_VERSION);
  // With TLS 1.2, only ciphers with forward secrecy and authenticated encryption.
  SSL_CTX_set_cipher_list(c, "ECDHE+AESGCM:ECDHE+CHACHA20");
  SSL_CTX_set_options(
      c, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_PRIORITIZE_CHACHA);
  SSL_CTX_set_session_cache_mode(c, SSL_SESS_CACHE_OFF);  // tickets need no cache, and get a new key with each reload
  // Without AUTO_RETRY a read ends after each record, so that a flood of records without data cannot outlast deadlines.
  SSL_CTX_clear_mode(c, SSL_MODE_AUTO_RETRY);
  SSL_CTX_set_mode(c, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER | SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_alpn_select_cb(c, choose_protocol, nullptr);
  SSL_CTX_set_default_passwd_cb(c, no_passphrase);
  if (SSL_CTX_use_certificate_chain_file(c, certificate_file.c_str()) != 1)
    throw std::runtime_error("--tls-cert " + certificate_file + " is not a readable PEM certificate: " + reason());
  if (SSL_CTX_use_PrivateKey_file(c, key_file.c_str(), SSL_FILETYPE_PEM) != 1)
    throw std::runtime_error("--tls-key " + key_file +
                             " is not a readable PEM key, without a passphrase, of --tls-cert " + certificate_file +
                             ": " + reason());
  return context;
}

}  // namespace

TlsContext::TlsContext(std::string certificate_file, std::string key_file)
    : certificate_file_(std::move(certificate_file)),
      key_file_(std::move(key_file)),
      context_(make_context(certificate_file_, key_file_)) {}

void TlsContext::reload() {
  std::shared_ptr<SSL_CTX> made = make_context(certificate_file_, key_file_);
  const std::lock_guard lock(mutex_);
  context_.swap(made);
}

std::shared_ptr<SSL_CTX> TlsContext::current() const {
  const std::lock_guard lock(mutex_);
  return context_;
}

std::unique_ptr<Transport> TlsContext::transport(int fd) const {
  return std::make_unique<TlsTransport>(fd, current().get());
}

}  // namespace papilio::server
