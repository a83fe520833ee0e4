#include "tests/soak/socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <cstdint>

namespace papilio::soak {

using Clock = std::chrono::steady_clock;

Socket::Socket(int port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) close();
}

bool Socket::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(sent));
  }
  return true;
}

void Socket::finish() const { ::shutdown(fd_, SHUT_WR); }

bool Socket::receive(std::string& bytes, size_t most, Clock::time_point deadline) const {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  pollfd one{fd_, POLLIN, 0};
  if (left <= 0 || ::poll(&one, 1, static_cast<int>(left)) <= 0) return false;
  std::string piece(most, '\0');
  const ssize_t count = ::recv(fd_, piece.data(), piece.size(), 0);
  if (count <= 0) return false;
  bytes.append(piece, 0, static_cast<size_t>(count));
  return true;
}

int Socket::status(std::chrono::seconds longest, std::string* code) {
  const auto deadline = Clock::now() + longest;
  std::string text;
  while (text.find("\r\n\r\n") == std::string::npos && receive(text, 4096, deadline)) continue;
  if (text.empty()) return 0;
  constexpr std::string_view version = "HTTP/1.1 ";
  int status = -1;
  if (text.starts_with(version) && text.find("\r\n\r\n") != std::string::npos)
    std::from_chars(text.data() + version.size(), text.data() + text.size(), status);
  if (code == nullptr || status < 400) return status;
  constexpr std::string_view field = "\"code\":";
  while (text.find(field) == std::string::npos && receive(text, 4096, deadline)) continue;
  const size_t begin = std::min(text.find(field), text.size());
  const size_t open = std::min(text.find('"', begin + field.size()), text.size());
  const size_t end = std::min(text.find('"', open + 1), text.size());
  if (open < end) code->append(text, open + 1, end - open - 1);
  return status;
}

void Socket::skip(size_t most, std::chrono::seconds longest) {
  std::string ignored;
  receive(ignored, most, Clock::now() + longest);
}

void Socket::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

void Socket::reset() {
  const linger now{1, 0};
  ::setsockopt(fd_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  close();
}

}  // namespace papilio::soak
