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

  /// Starts the clock for a request: its first byte must come within `idle`, a TLS handshake before it included.
  void await_request(std::chrono::seconds idle);
  /// What came of waiting for a head.
  struct Gathered {
    enum class State {
      ready,    ///< `take_head` gives the head, or says why it is refused
      waiting,  ///< bytes are missing: to be called again when the socket is ready for `wait_for` or at the deadline
      ended,    ///< the client has closed, or brought no byte in time
    };
    State state;
    short wait_for = 0;
  };
  /// Receives a head of up to `limit` bytes, and waits no longer than `patience` for it.
  Gathered gather_head(size_t limit, Clock::duration patience);
  /// When a client that brings nothing more is given up.
  [[nodiscard]] Clock::time_point deadline() const { return deadline_; }
  /// When the first byte of the head came.
  [[nodiscard]] Clock::time_point head_begun() const { return head_begun_; }
  /// The head up to and with its empty line, once it is ready. Throws headers_too_large past `limit` bytes,
  /// request_timeout, and bad_request at a line feed without its carriage return.
  std::string take_head(size_t limit);
  /// Keeps no more memory than what was received takes.
  void shrink();
  [[nodiscard]] int fd() const { return transport_->fd(); }

  /// Starts the clock for a body.
  void begin_body();
  /// At least one byte of the body, to be given back by `consume`. Throws request_timeout or bad_request
  /// (closed early).
  std::string_view peek();
  void consume(size_t count);
  [[nodiscard]] bool has_buffered() const { return begin_ < end_; }

  /// False once the client is gone or has taken nothing for the whole of `write_wait`, however long it takes over all
  /// of them. `more`: what follows
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
  /// False once the client has taken nothing for the whole of `write_wait`, or less than shows in that time.
  [[nodiscard]] bool wait_to_write(short events) const;
  Received receive(Clock::time_point deadline);
  /// Reads what has come, without waiting.
  Transport::Step receive_now();
  enum class HeadState { incomplete, complete, bad_line, too_large };
  /// Looks at the bytes that it has not seen yet.
  HeadState scan_head(size_t limit);

  const std::unique_ptr<Transport> transport_;
  const std::chrono::seconds read_wait_;
  const std::chrono::seconds write_wait_;
  std::string remote_address_;
  std::string buffer_;  ///< from begin_ to end_: received, not consumed; it keeps its size, as growing would fill it
  size_t begin_ = 0, end_ = 0;
  bool broken_ = false;         ///< a write has failed: no further one is tried
  Clock::time_point deadline_;  ///< of the head, or of its first byte
  Clock::time_point head_begun_;
  bool has_begun_ = false;       ///< the first byte of a head has come
  bool has_empty_line_ = false;  ///< one was passed over before the head
  size_t scanned_ = 0;           ///< bytes of the head that `scan_head` has seen
  Clock::time_point body_deadline_;
  uint64_t body_stretch_ = 0;  ///< bytes since the deadline was last moved
  uint64_t bytes_in_ = 0;
  uint64_t bytes_out_ = 0;
};

}  // namespace papilio::server
