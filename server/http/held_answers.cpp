#include "server/http/held_answers.h"

#include <algorithm>

namespace papilio::server {

HeldAnswers::Share::Share(HeldAnswers& all, const Connection& connection) : all_(all), connection_(connection) {
  const std::lock_guard lock(all_.mutex_);
  place_ = all_.shares_.insert(all_.shares_.end(), this);
}

HeldAnswers::Share::~Share() {
  const std::lock_guard lock(all_.mutex_);
  if (!is_cut_) all_.discount(*this);
  all_.shares_.erase(place_);
}

void HeldAnswers::Share::hold(uint64_t bytes, const void* object) {
  const std::lock_guard lock(all_.mutex_);
  if (is_cut_) return;
  const bool counts = object == nullptr || ++all_.holders_[object] == 1;
  all_.discount(*this);
  bytes_ = bytes;
  object_ = object;
  if (counts) all_.bytes_ += bytes;
  all_.cut_oldest_but(*this);
}

bool HeldAnswers::Share::is_cut() const {
  const std::lock_guard lock(all_.mutex_);
  return is_cut_;
}

uint64_t HeldAnswers::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void HeldAnswers::discount(const Share& share) {
  if (share.object_ != nullptr) {
    const auto holders = holders_.find(share.object_);
    if (--holders->second > 0) return;
    holders_.erase(holders);
  }
  bytes_ -= share.bytes_;
}

void HeldAnswers::cut_oldest_but(const Share& newest) {
  while (bytes_ > budget_) {
    const auto oldest = std::ranges::find_if(
        shares_, [&](const Share* share) { return share != &newest && !share->is_cut_ && share->bytes_ > 0; });
    if (oldest == shares_.end()) return;
    (*oldest)->is_cut_ = true;
    discount(**oldest);
    (*oldest)->connection_.abort();
  }
}

}  // namespace papilio::server
