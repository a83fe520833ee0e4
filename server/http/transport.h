#pragma once

#include <memory>
#include <string_view>

namespace papilio::server {

/// The bytes of one socket, plain or encrypted; owns the socket. No call waits: each says what it got done, or what
/// it would have to wait for. Used by one thread, but for `fd`.
class Transport {
 public:
  /// What a call came to.
  struct Step {
    size_t bytes = 0;    ///< moved; when there are any, `wait_for` has no meaning
    short wait_for = 0;  ///< POLLIN or POLLOUT: call again once the socket is ready; 0: the connection is at its end
  };

  explicit Transport(int fd) : fd_(fd) {}
  virtual ~Transport();
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  [[nodiscard]] int fd() const { return fd_; }

  virtual Step read(char* into, size_t size) = 0;
  /// After a step without bytes the next call must be given the same ones. `more`: what follows comes at once, and may
  /// share a packet with this; a write without `more` must follow.
  virtual Step write(std::string_view bytes, bool more) = 0;
  /// True once the client has closed its side (a half-close counts) or the connection is lost. What it had sent before
  /// can still be read.
  [[nodiscard]] virtual bool peer_gone() = 0;
  /// Tells the client that nothing more will be written. To be called again while the step says what to wait for.
  virtual Step end_writing() = 0;

 private:
  const int fd_;
};

[[nodiscard]] std::unique_ptr<Transport> plain_transport(int fd);

// The system's calls as `Step`s: without waiting, and without SIGPIPE.

[[nodiscard]] Transport::Step receive_some(int fd, char* into, size_t size);
[[nodiscard]] Transport::Step send_some(int fd, std::string_view bytes, bool more);

}  // namespace papilio::server
