#include "tests/bench/kept_connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <stdexcept>
#include <utility>

namespace papilio::bench {
namespace {

constexpr size_t receive_bytes = 256 << 10;

}  // namespace

std::string_view KeptConnection::ask(std::string_view request) {
  if (is_closed_by_peer()) close();
  if (fd_ < 0) connect();
  if (::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
    throw std::runtime_error("papilio-server does not take a request");
  end_ = 0;
  size_t head_bytes = std::string::npos;
  while (head_bytes == std::string::npos) {
    receive();
    head_bytes = std::string_view(bytes_.data(), end_).find("\r\n\r\n");
  }
  head_bytes += 4;
  const std::string head = bytes_.substr(0, head_bytes);
  constexpr std::string_view length_name = "\r\nContent-Length: ";
  const size_t length = head.find(length_name);
  if (!head.starts_with("HTTP/1.1 200 ") || length == std::string::npos)
    throw std::runtime_error("papilio-server does not answer as it should: " + head);
  size_t body_bytes = 0;
  std::from_chars(head.data() + length + length_name.size(), head.data() + head.size(), body_bytes);
  if (bytes_.size() < head_bytes + body_bytes + receive_bytes) bytes_.resize(head_bytes + body_bytes + receive_bytes);
  while (end_ < head_bytes + body_bytes) receive();
  if (head.find("\r\nConnection: close\r\n") != std::string::npos) close();
  return std::string_view(bytes_).substr(head_bytes, body_bytes);
}

/// Returns whether the server has closed the connection as idle: other rows run in between.
bool KeptConnection::is_closed_by_peer() const {
  char byte = 0;
  return fd_ >= 0 && ::recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

void KeptConnection::connect() {
  fd_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port_));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("papilio-server does not listen");
  const int yes = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

void KeptConnection::close() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void KeptConnection::receive() {
  if (bytes_.size() < end_ + receive_bytes) bytes_.resize(end_ + receive_bytes);
  const ssize_t count = ::recv(fd_, bytes_.data() + end_, bytes_.size() - end_, 0);
  if (count <= 0) throw std::runtime_error("papilio-server ends the connection before its answer");
  end_ += static_cast<size_t>(count);
}

}  // namespace papilio::bench
