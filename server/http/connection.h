#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/http/transport.h"

namespace papilio::server {

/// Connection to one client, with a bound on every wait. Used by one thread, except abort(). Reading throws `Problem`;
/// writing returns its success.
class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes the socket. `read_wait` bounds the time for a whole head, and for each stretch of a body. In each stretch at
  /// least a kilobyte per second must arrive, so that a client that drips single bytes cannot occupy its thread.
  Connection(std::unique_ptr<Transport> transport, std::chrono::seconds read_wait, std::chrono::seconds write_wait);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Returns the address of the socket's other end, regardless of header fields.
  [[nodiscard]] const std::string& remote_address() const { return remote_address_; }

  /// Starts the clock for a request: its first byte must arrive within `idle`, including a TLS handshake before it.
  void await_request(std::chrono::seconds idle);
  /// Result of waiting for a head.
  struct Gathered {
    enum class State {
      ready,    ///< complete: take_head() returns the head, or throws why it is refused
      waiting,  ///< incomplete: call again when the socket is ready for `wait_for`, or at the deadline
      ended,    ///< closed by the client, or no byte in time
    };
    State state;
    short wait_for = 0;
  };
  /// Receives a head of up to `limit` bytes, and waits for it at most `patience`.
  Gathered gather_head(size_t limit, Clock::duration patience);
  /// Returns the time at which a silent client is dropped.
  [[nodiscard]] Clock::time_point deadline() const { return deadline_; }
  /// Returns the time at which the first byte of the head arrived.
  [[nodiscard]] Clock::time_point head_begun() const { return head_begun_; }
  /// Returns the head, including its empty line, once it is ready. Throws `Problem`: headers_too_large beyond `limit`
  /// bytes, request_timeout, and bad_request at a line feed without a carriage return.
  std::string take_head(size_t limit);
  /// Shrinks the buffer to the received bytes.
  void shrink();
  [[nodiscard]] int fd() const { return transport_->fd(); }

  /// Starts the clock for a body.
  void begin_body();
  /// Returns at least one byte of the body, to be consumed by consume(). Throws `Problem` request_timeout, or
  /// bad_request if the connection is closed early.
  std::string_view peek();
  void consume(size_t count);
  [[nodiscard]] bool has_buffered() const { return begin_ < end_; }

  /// Writes the bytes. Returns false if the client is gone, or takes no byte for `write_wait`; the total time has no
  /// bound. `more`: further bytes follow at once, and may share a packet.
  bool write(std::string_view bytes, bool more = false);
  /// Returns whether the client has closed its side (a half-close counts) or the connection is lost.
  [[nodiscard]] bool peer_gone();

  /// Reads on until a client that is still sending has received the answer: otherwise its unread bytes would reset the
  /// connection, and the answer would be lost.
  void linger();
  /// Ends every wait of this connection at once. Thread-safe.
  void abort() const;

  [[nodiscard]] uint64_t bytes_in() const { return bytes_in_; }
  [[nodiscard]] uint64_t bytes_out() const { return bytes_out_; }

 private:
  [[nodiscard]] std::string_view buffered() const { return std::string_view(buffer_).substr(begin_, end_ - begin_); }
  enum class Received { bytes, closed, timeout };
  /// Waits until the socket is ready. Returns false if the deadline has passed, ready or not.
  [[nodiscard]] bool wait(short events, Clock::time_point deadline) const;
  /// Waits until the socket can be written. Returns false if the client takes no measurable bytes for `write_wait`.
  [[nodiscard]] bool wait_to_write(short events) const;
  Received receive(Clock::time_point deadline);
  /// Reads received bytes, without waiting.
  Transport::Step receive_now();
  enum class HeadState { incomplete, complete, bad_line, too_large };
  /// Scans the bytes not yet scanned.
  HeadState scan_head(size_t limit);

  const std::unique_ptr<Transport> transport_;
  const std::chrono::seconds read_wait_;
  const std::chrono::seconds write_wait_;
  std::string remote_address_;
  std::string buffer_;  ///< buffer of fixed size; bytes from begin_ to end_ are received and not consumed
  size_t begin_ = 0, end_ = 0;
  bool broken_ = false;         ///< whether a write has failed; later writes are skipped
  Clock::time_point deadline_;  ///< deadline of the head, or of its first byte
  Clock::time_point head_begun_;
  bool has_begun_ = false;       ///< whether the first byte of a head has arrived
  bool has_empty_line_ = false;  ///< whether an empty line before the head was skipped
  size_t scanned_ = 0;           ///< bytes of the head that scan_head() has scanned
  Clock::time_point body_deadline_;
  uint64_t body_stretch_ = 0;  ///< bytes since the deadline was last moved
  uint64_t bytes_in_ = 0;
  uint64_t bytes_out_ = 0;
};

}  // namespace papilio::server
