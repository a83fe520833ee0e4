#include "server/http/parking.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <system_error>

namespace papilio::server {
namespace {

constexpr uint64_t wake_id = 0;

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

/// Calls `resume`. Out of memory, only this socket is lost.
void call(const std::function<void()>& resume) {
  try {
    resume();
  } catch (...) {
  }
}

bool watch(int epoll, int fd, uint32_t events, uint64_t id) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = id;
  return ::epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event) == 0;
}

}  // namespace

Parking::Parking(size_t most)
    : most_(most),
      epoll_(checked(::epoll_create1(EPOLL_CLOEXEC), "epoll_create1")),
      wake_(checked(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd")) {
  watch(epoll_, wake_, EPOLLIN, wake_id);
  thread_ = std::thread([this] { run(); });
}

Parking::~Parking() {
  close();
  ::close(wake_);
  ::close(epoll_);
}

void Parking::park(int fd, short events, Clock::time_point deadline, std::function<void()> resume) {
  std::function<void()> given_way;  // destroyed after the lock is released, as is `resume`
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  if (parked_.size() >= most_) given_way = take_locked(deadlines_.begin()->second);
  const uint64_t id = next_id_++;
  const bool is_next = deadlines_.empty() || deadline < deadlines_.begin()->first;
  parked_.emplace(id, Parked{fd, deadline, nullptr});
  try {
    deadlines_.emplace(deadline, id);
  } catch (...) {
    parked_.erase(id);
    throw;
  }
  parked_.at(id).resume.swap(resume);
  if (!watch(epoll_, fd, static_cast<uint32_t>(events) | EPOLLRDHUP | EPOLLONESHOT, id)) resume = take_locked(id);
  if (is_next) wake();
}

void Parking::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  wake();
  if (thread_.joinable()) thread_.join();
  decltype(parked_) left;
  const std::lock_guard lock(mutex_);
  left.swap(parked_);
  deadlines_.clear();
}

void Parking::run() {
  std::array<epoll_event, 64> events{};
  // A waker first writes `closed` or a deadline. Each turn checks both after it has read the wake-ups.
  while (const std::optional<int> wait = milliseconds_to_wait()) {
    const int count = ::epoll_wait(epoll_, events.data(), events.size(), *wait);
    for (int i = 0; i < count; ++i) {
      uint64_t counted = 0;
      if (events.at(static_cast<size_t>(i)).data.u64 == wake_id)
        (void)!::read(wake_, &counted, sizeof counted);
      else if (const auto resume = take(events.at(static_cast<size_t>(i)).data.u64))
        call(resume);
    }
    while (const auto resume = take_overdue()) call(resume);
  }
}

std::optional<int> Parking::milliseconds_to_wait() {
  const std::lock_guard lock(mutex_);
  if (closed_) return std::nullopt;
  if (deadlines_.empty()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadlines_.begin()->first - Clock::now()).count();
  return static_cast<int>(std::clamp<int64_t>(left, 0, std::numeric_limits<int>::max()));
}

std::function<void()> Parking::take_overdue() {
  const std::lock_guard lock(mutex_);
  if (closed_ || deadlines_.empty() || deadlines_.begin()->first > Clock::now()) return nullptr;
  return take_locked(deadlines_.begin()->second);
}

std::function<void()> Parking::take(uint64_t id) {
  const std::lock_guard lock(mutex_);
  return closed_ ? nullptr : take_locked(id);
}

std::function<void()> Parking::take_locked(uint64_t id) {
  const auto found = parked_.find(id);
  if (found == parked_.end()) return nullptr;
  ::epoll_ctl(epoll_, EPOLL_CTL_DEL, found->second.fd, nullptr);
  std::function<void()> resume = std::move(found->second.resume);
  deadlines_.erase({found->second.deadline, id});
  parked_.erase(found);
  return resume;
}

void Parking::wake() const {
  const uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

}  // namespace papilio::server
