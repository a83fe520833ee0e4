#pragma once

#include <memory>
#include <string_view>

namespace papilio::server {

/// Bytes of one socket, plain or encrypted; owns the socket. No call blocks: each returns its progress, or the event to
/// wait for. Used by one thread, except fd().
class Transport {
 public:
  /// Result of a call.
  struct Step {
    size_t bytes = 0;    ///< transferred bytes; unless 0, `wait_for` is meaningless
    short wait_for = 0;  ///< POLLIN or POLLOUT: call again once the socket is ready; 0: the connection has ended
  };

  explicit Transport(int fd) : fd_(fd) {}
  virtual ~Transport();
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  [[nodiscard]] int fd() const { return fd_; }

  virtual Step read(char* into, size_t size) = 0;
  /// Writes bytes. After a step without bytes, the next call must pass equal bytes. `more`: further bytes follow at
  /// once, and may share a packet; a write without `more` must follow.
  virtual Step write(std::string_view bytes, bool more) = 0;
  /// Returns whether the client has closed its side (a half-close counts) or the connection is lost. Bytes that it sent
  /// before can still be read.
  [[nodiscard]] virtual bool peer_gone() = 0;
  /// Announces the end of writing to the client. Call again while the step has an event to wait for.
  virtual Step end_writing() = 0;

 private:
  const int fd_;
};

[[nodiscard]] std::unique_ptr<Transport> plain_transport(int fd);

// System calls as `Step`s: non-blocking, and without SIGPIPE.

[[nodiscard]] Transport::Step receive_some(int fd, char* into, size_t size);
[[nodiscard]] Transport::Step send_some(int fd, std::string_view bytes, bool more);

}  // namespace papilio::server
