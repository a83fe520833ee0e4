#include "server/http/gate.h"

namespace papilio::server {

bool Gate::enter() {
  const std::lock_guard lock(mutex_);
  if (!closed_) ++running_;
  return !closed_;
}

void Gate::leave() {
  const std::lock_guard lock(mutex_);
  if (--running_ == 0) emptied_.notify_all();
}

void Gate::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
}

bool Gate::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

int Gate::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

bool Gate::wait_until_empty(std::chrono::seconds longest) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_for(lock, longest, [this] { return running_ == 0; });
}

}  // namespace papilio::server
