#include "server/admission.h"

#include <chrono>
#include <string>

#include "proto/problem.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

Admission::Admission(int slots, int queue) : slots_(slots), queue_(queue) {}

std::shared_ptr<Admission::Slot> Admission::enter(const std::function<bool()>& client_gone) {
  std::unique_lock lock(mutex_);
  if (is_full()) throw busy();
  const uint64_t ticket = next_ticket_++;
  const auto place = waiting_.insert(waiting_.end(), ticket);
  const auto my_turn = [&] { return computing_ < slots_ && waiting_.front() == ticket; };
  while (true) {
    const bool free = changed_.wait_for(lock, std::chrono::milliseconds(100), my_turn);
    if (client_gone()) {
      waiting_.erase(place);
      changed_.notify_all();
      throw Problem(Code::cancelled, "The client went away while its request waited.");
    }
    if (free) break;
  }
  waiting_.erase(place);
  changed_.notify_all();
  return std::make_shared<Slot>(*this);
}

void Admission::leave() {
  {
    const std::lock_guard lock(mutex_);
    --computing_;
  }
  changed_.notify_all();
}

int Admission::computing() const {
  const std::lock_guard lock(mutex_);
  return computing_;
}

int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(waiting_.size());
}

bool Admission::full() const {
  const std::lock_guard lock(mutex_);
  return is_full();
}

void Admission::refuse_when_full() const {
  if (full()) throw busy();
}

Problem Admission::busy() const {
  return {Code::busy, "All " + std::to_string(slots_) + " computing slots and " + std::to_string(queue_) +
                          " waiting places are taken. Try again after the time in Retry-After."};
}

}  // namespace papilio::server
