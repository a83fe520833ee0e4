#include "server/http/connection.h"

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "proto/problem.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;
using std::chrono::milliseconds;

constexpr size_t receive_bytes = 64 << 10;
constexpr uint64_t least_bytes_a_second = 1 << 10;
constexpr std::chrono::seconds longest_linger{2};

std::string peer_address(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* number = address.ss_family == AF_INET6
                           ? static_cast<const void*>(&reinterpret_cast<sockaddr_in6*>(&address)->sin6_addr)
                           : &reinterpret_cast<sockaddr_in*>(&address)->sin_addr;
  return ::inet_ntop(address.ss_family, number, text.data(), text.size()) ? text.data() : "";
}

/// Returns the bytes written to the socket that the client's system has not acknowledged.
int unacknowledged_bytes(int fd) {
  int bytes = 0;
  ::ioctl(fd, SIOCOUTQ, &bytes);
  return bytes;
}

}  // namespace

Connection::Connection(std::unique_ptr<Transport> transport, std::chrono::seconds read_wait,
                       std::chrono::seconds write_wait)
    : transport_(std::move(transport)),
      read_wait_(read_wait),
      write_wait_(write_wait),
      remote_address_(peer_address(transport_->fd())) {
  // The socket becomes writable when little is left unsent, not when a third of a buffer of megabytes is free. This
  // tells a slow client from one that does not read.
  const int unsent = 64 << 10;
  ::setsockopt(transport_->fd(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent, sizeof unsent);
}

bool Connection::wait(short events, Clock::time_point deadline) const {
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (left <= milliseconds(0)) return false;
    pollfd one{transport_->fd(), events, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(left.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

Transport::Step Connection::receive_now() {
  if (begin_ > 0) std::ranges::copy(buffered(), buffer_.begin());
  end_ -= std::exchange(begin_, 0);
  if (buffer_.size() < end_ + receive_bytes) buffer_.resize(end_ + receive_bytes);
  const Transport::Step step = transport_->read(buffer_.data() + end_, receive_bytes);
  end_ += step.bytes;
  return step;
}

Connection::Received Connection::receive(Clock::time_point deadline) {
  for (;;) {
    const Transport::Step step = receive_now();
    if (step.bytes > 0) return Received::bytes;
    if (step.wait_for == 0) return Received::closed;
    if (!wait(step.wait_for, deadline)) return Received::timeout;
  }
}

void Connection::await_request(std::chrono::seconds idle) {
  deadline_ = Clock::now() + idle;
  has_begun_ = has_empty_line_ = false;
  scanned_ = 0;
}

Connection::Gathered Connection::gather_head(size_t limit, Clock::duration patience) {
  const auto patient_until = Clock::now() + patience;
  for (;;) {
    if (has_buffered() && !has_begun_) {
      has_begun_ = true;
      head_begun_ = Clock::now();
      deadline_ = head_begun_ + read_wait_;
    }
    if (has_begun_ && scan_head(limit) != HeadState::incomplete) return {Gathered::State::ready};
    if (Clock::now() >= deadline_) return {has_begun_ ? Gathered::State::ready : Gathered::State::ended};
    const Transport::Step step = receive_now();
    if (step.bytes > 0) continue;
    if (step.wait_for == 0) return {Gathered::State::ended};
    if (!wait(step.wait_for, std::min(deadline_, patient_until)) && Clock::now() < deadline_)
      return {Gathered::State::waiting, step.wait_for};
  }
}

Connection::HeadState Connection::scan_head(size_t limit) {
  // Skips one empty line before the request: some clients send it after a body (RFC 9112, section 2.2).
  if (!has_empty_line_ && buffered().starts_with("\r\n")) {
    begin_ += 2;
    has_empty_line_ = true;
    scanned_ = 0;
  }
  const std::string_view held = buffered();
  for (; scanned_ < std::min(held.size(), limit); ++scanned_) {
    if (held[scanned_] != '\n') continue;
    if (scanned_ == 0 || held[scanned_ - 1] != '\r') return HeadState::bad_line;
    if (held.substr(0, scanned_ + 1).ends_with("\r\n\r\n")) return HeadState::complete;
  }
  return scanned_ == limit ? HeadState::too_large : HeadState::incomplete;
}

std::string Connection::take_head(size_t limit) {
  switch (scan_head(limit)) {
    case HeadState::complete: {
      std::string head(buffered().substr(0, scanned_ + 1));
      consume(head.size());
      return head;
    }
    case HeadState::bad_line:
      throw Problem(Code::bad_request, "Every line of a request's head must end in CR LF.");
    case HeadState::too_large:
      throw Problem(Code::headers_too_large,
                    "The request line and the header fields exceed " + std::to_string(limit) + " bytes together.");
    default:
      throw Problem(Code::request_timeout,
                    "The request's head did not arrive in " + std::to_string(read_wait_.count()) + " seconds.");
  }
}

void Connection::shrink() {
  buffer_ = std::string(buffered());
  buffer_.shrink_to_fit();
  end_ -= std::exchange(begin_, 0);
}

void Connection::begin_body() {
  body_deadline_ = Clock::now() + read_wait_;
  body_stretch_ = 0;
}

std::string_view Connection::peek() {
  if (!has_buffered()) {
    const Received received = receive(body_deadline_);
    if (received == Received::closed) throw Problem(Code::bad_request, "The body ended before its declared end.");
    if (received == Received::timeout)
      throw Problem(Code::request_timeout, "The body stalled: it must bring at least " +
                                               std::to_string(least_bytes_a_second) + " bytes a second.");
    body_stretch_ += end_ - begin_;
    if (body_stretch_ >= least_bytes_a_second * static_cast<uint64_t>(read_wait_.count())) begin_body();
  }
  return buffered();
}

void Connection::consume(size_t count) {
  begin_ += count;
  bytes_in_ += count;
}

bool Connection::write(std::string_view bytes, bool more) {
  while (!bytes.empty() && !broken_) {
    const Transport::Step step = transport_->write(bytes, more);
    bytes.remove_prefix(step.bytes);
    bytes_out_ += step.bytes;
    if (step.bytes == 0) broken_ = step.wait_for == 0 || !wait_to_write(step.wait_for);
  }
  return !broken_;
}

// A socket becomes writable only after tens of kilobytes were taken. Progress of a slow client shows in the
// acknowledged bytes.
bool Connection::wait_to_write(short events) const {
  auto deadline = Clock::now() + write_wait_;
  for (int unacknowledged = unacknowledged_bytes(transport_->fd());;) {
    const auto now = Clock::now();
    if (now >= deadline) return false;
    if (wait(events, std::min(deadline, now + Clock::duration(write_wait_) / 8))) return true;
    const int left = unacknowledged_bytes(transport_->fd());
    if (left < unacknowledged) deadline = Clock::now() + write_wait_;
    unacknowledged = left;
  }
}

bool Connection::peer_gone() { return broken_ || transport_->peer_gone(); }

void Connection::linger() {
  if (broken_) return;
  for (short wait_for = transport_->end_writing().wait_for; wait_for != 0;
       wait_for = transport_->end_writing().wait_for)
    if (!wait_to_write(wait_for)) return;
  const auto deadline = Clock::now() + std::min(read_wait_, longest_linger);
  do {
    begin_ = end_;
  } while (Clock::now() < deadline && receive(deadline) == Received::bytes);
}

void Connection::abort() const { ::shutdown(transport_->fd(), SHUT_RDWR); }

}  // namespace papilio::server
