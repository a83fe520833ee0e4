#include "server/http/transport.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace papilio::server {
namespace {

class PlainTransport final : public Transport {
 public:
  using Transport::Transport;

  Step read(char* into, size_t size) override { return receive_some(fd(), into, size); }
  Step write(std::string_view bytes, bool more) override { return send_some(fd(), bytes, more); }
  bool peer_gone() override {
    pollfd one{fd(), POLLRDHUP, 0};
    return ::poll(&one, 1, 0) > 0 && (one.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
  }
  Step end_writing() override {
    ::shutdown(fd(), SHUT_WR);
    return {};
  }
};

/// Makes a system call, repeats it after an interruption, and converts its result to a step.
template <class Call>
Transport::Step step_of(const Call& call, short wait_for) {
  for (;;) {
    const ssize_t count = call();
    if (count > 0) return {static_cast<size_t>(count), 0};
    if (count == 0 || (errno != EAGAIN && errno != EINTR)) return {};
    if (errno == EAGAIN) return {0, wait_for};
  }
}

}  // namespace

Transport::~Transport() { ::close(fd_); }

std::unique_ptr<Transport> plain_transport(int fd) { return std::make_unique<PlainTransport>(fd); }

Transport::Step receive_some(int fd, char* into, size_t size) {
  return step_of([&] { return ::recv(fd, into, size, MSG_DONTWAIT); }, POLLIN);
}

Transport::Step send_some(int fd, std::string_view bytes, bool more) {
  const int flags = MSG_NOSIGNAL | MSG_DONTWAIT | (more ? MSG_MORE : 0);
  return step_of([&] { return ::send(fd, bytes.data(), bytes.size(), flags); }, POLLOUT);
}

}  // namespace papilio::server
