#include "server/http/tls_transport.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <new>
#include <utility>

namespace papilio::server {
namespace {

constexpr size_t record_bytes = SSL3_RT_MAX_PLAIN_LENGTH;
constexpr size_t most_bytes_a_write = 16 * record_bytes;

// Socket BIO for OpenSSL. Its own would raise SIGPIPE, and block on a blocking socket.

int fd_of(BIO* bio) { return static_cast<Transport*>(BIO_get_data(bio))->fd(); }

/// Converts a step to the result of a BIO's call: a count, 0 at the end, -1 if it must be repeated.
int result_of(BIO* bio, const Transport::Step& step, int retry_flag) {
  BIO_clear_retry_flags(bio);
  if (step.bytes > 0 || step.wait_for == 0) return static_cast<int>(step.bytes);
  BIO_set_flags(bio, retry_flag | BIO_FLAGS_SHOULD_RETRY);
  return -1;
}

int read_bio(BIO* bio, char* into, int size) {
  return result_of(bio, receive_some(fd_of(bio), into, static_cast<size_t>(size)), BIO_FLAGS_READ);
}

int write_bio(BIO* bio, const char* bytes, int size) {
  return result_of(bio, send_some(fd_of(bio), {bytes, static_cast<size_t>(size)}, false), BIO_FLAGS_WRITE);
}

long control_bio(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

const BIO_METHOD* socket_method() {
  static const BIO_METHOD* const method = [] {
    BIO_METHOD* made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket");
    if (made == nullptr) throw std::bad_alloc();
    BIO_meth_set_read(made, read_bio);
    BIO_meth_set_write(made, write_bio);
    BIO_meth_set_ctrl(made, control_bio);
    return made;
  }();
  return method;
}

}  // namespace

TlsTransport::TlsTransport(int fd, SSL_CTX* context) : Transport(fd), ssl_(SSL_new(context)) {
  BIO* bio = ssl_ ? BIO_new(socket_method()) : nullptr;
  if (bio == nullptr) throw std::bad_alloc();
  BIO_set_data(bio, static_cast<Transport*>(this));
  BIO_set_init(bio, 1);
  SSL_set_bio(ssl_.get(), bio, bio);
  SSL_set_accept_state(ssl_.get());
}

TlsTransport::~TlsTransport() {
  if ((SSL_get_shutdown(ssl_.get()) & SSL_SENT_SHUTDOWN) == 0) send_close_notify();
}

Transport::Step TlsTransport::step_of(int result, size_t bytes) {
  if (result > 0) return {bytes, 0};
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {0, POLLIN};
    case SSL_ERROR_WANT_WRITE:
      return {0, POLLOUT};
    case SSL_ERROR_ZERO_RETURN:
      return {};
    default:
      failed_ = true;
      ERR_clear_error();
      return {};
  }
}

Transport::Step TlsTransport::read(char* into, size_t size) {
  if (failed_) return {};
  ERR_clear_error();
  size_t count = 0;
  const int result = SSL_read_ex(ssl_.get(), into, size, &count);
  return step_of(result, count);
}

Transport::Step TlsTransport::write(std::string_view bytes, bool more) {
  if (failed_) return {};
  ERR_clear_error();
  if (kept_of_call_ == 0 && (more || !kept_.empty())) {
    kept_of_call_ = std::min(bytes.size(), record_bytes - kept_.size());
    kept_ += bytes.substr(0, kept_of_call_);
    if (more && kept_.size() < record_bytes) return {std::exchange(kept_of_call_, 0), 0};
  }
  const std::string_view next = kept_.empty() ? bytes.substr(0, most_bytes_a_write) : kept_;
  size_t count = 0;
  const int result = SSL_write_ex(ssl_.get(), next.data(), next.size(), &count);
  if (result <= 0 || kept_.empty()) return step_of(result, count);
  kept_.clear();  // one record, which OpenSSL takes whole or not at all
  return {std::exchange(kept_of_call_, 0), 0};
}

bool TlsTransport::peer_gone() {
  pollfd one{fd(), POLLIN | POLLRDHUP, 0};
  if (failed_) return true;
  if (::poll(&one, 1, 0) <= 0) return false;
  if ((one.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0) return true;
  char byte = 0;
  size_t count = 0;
  ERR_clear_error();
  const Step step = step_of(SSL_peek_ex(ssl_.get(), &byte, 1, &count), 1);
  return step.bytes == 0 && step.wait_for == 0;
}

Transport::Step TlsTransport::end_writing() {
  const Step step = send_close_notify();
  if (step.wait_for == 0) ::shutdown(fd(), SHUT_WR);
  return step;
}

Transport::Step TlsTransport::send_close_notify() {
  if (failed_ || SSL_is_init_finished(ssl_.get()) == 0) return {};
  ERR_clear_error();
  const int result = SSL_shutdown(ssl_.get());
  return result < 0 ? step_of(result, 0) : Step{};
}

}  // namespace papilio::server
