#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/http/transport.h"

namespace papilio::server {

/// One client's socket, with a bound on every wait. It is read and written by one thread; `abort` alone may
/// be called from another. Reading throws `Problem`; writing tells by its result.
class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  /// `read_wait` bounds a whole head, and each stretch of a body: in every `read_wait`
  /// at least a kilobyte a second must arrive, so that a client which drips single bytes cannot hold its
  /// thread.
  Connection(std::unique_ptr<Transport> transport, std::chrono::seconds read_wait, std::chrono::seconds write_wait);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// From the socket alone: nothing that a client writes into a header changes it.
  [[nodiscard]] const std::string& remote_address() const { return remote_address_; }

  /// Waits for the first byte of a request, a TLS handshake before it included. False when the client has closed or
  /// brought none within `idle`, or once `give_up` (asked a few times a second) says so.
  bool wait_for_request(std::chrono::seconds idle, const std::function<bool()>& give_up);
  /// The head up to and with its empty line; "" when the client closed before its end. Throws
  /// headers_too_large past `limit` bytes, request_timeout, and bad_request at a line feed without its
  /// carriage return.
  std::string read_head(size_t limit);

  /// Starts the clock for a body.
  void begin_body();
  /// At least one byte of the body, to be given back by `consume`. Throws request_timeout or bad_request
  /// (closed early).
  std::string_view peek();
  void consume(size_t count);
  [[nodiscard]] bool has_buffered() const { return begin_ < end_; }

  /// False once the client is gone or has taken nothing for the whole of `write_wait`. `more`: what follows
  /// comes at once, and may share a packet with this.
  bool write(std::string_view bytes, bool more = false);
  /// True once the client has closed its side (a half-close counts) or the connection is lost.
  [[nodiscard]] bool peer_gone();

  /// Lets the client read the answer before the socket goes, though it is still sending: without this the
  /// unread bytes reset the connection and the answer is lost.
  void linger();
  /// Ends every wait of this connection at once.
  void abort() const;

  [[nodiscard]] uint64_t bytes_in() const { return bytes_in_; }
  [[nodiscard]] uint64_t bytes_out() const { return bytes_out_; }

 private:
  [[nodiscard]] std::string_view buffered() const { return std::string_view(buffer_).substr(begin_, end_ - begin_); }
  enum class Received { bytes, closed, timeout };
  /// False once the deadline has passed, ready or not.
  [[nodiscard]] bool wait(short events, Clock::time_point deadline) const;
  Received receive(Clock::time_point deadline);

  const std::unique_ptr<Transport> transport_;
  const std::chrono::seconds read_wait_;
  const std::chrono::seconds write_wait_;
  std::string remote_address_;
  std::string buffer_;  ///< from begin_ to end_: received, not consumed; it keeps its size, as growing would fill it
  size_t begin_ = 0, end_ = 0;
  bool broken_ = false;  ///< a write has failed: no further one is tried
  Clock::time_point body_deadline_;
  uint64_t body_stretch_ = 0;  ///< bytes since the deadline was last moved
  uint64_t bytes_in_ = 0;
  uint64_t bytes_out_ = 0;
};

}  // namespace papilio::server
