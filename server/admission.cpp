#include "server/admission.h"

#include <algorithm>
#include <tuple>

namespace papilio::server {

using proto::Code;
using proto::Problem;
using std::chrono::steady_clock;

Admission::Admission(int slots, int queue, std::chrono::milliseconds express_time)
    : slots_(slots), queue_(queue), express_time_(express_time) {}

std::shared_ptr<Admission::Slot> Admission::enter(const std::string& client, Work work, const Question& client_gone) {
  auto slot = std::make_shared<Slot>(*this, work);
  const Problem gone(Code::cancelled, "The client went away while its request waited.");
  {
    std::unique_lock lock(mutex_);
    slot->account_ = accounts_.try_emplace(client).first;
    slot->is_counted_ = true;
    ++slot->account_->second.requests;
    slot->rank_ = given_ + work.expected;
    join_queue(*slot);
    dispatch();
    if (slot->lane_ == Lane::none) refuse_latest(*slot);
    if (!wait_for_turn(*slot, lock, client_gone)) throw Problem(gone);
    if (slot->is_refused_) throw busy();
  }
  if (client_gone()) throw Problem(gone);
  return slot;
}

void Admission::Slot::take_turn(const Question& client_gone) {
  if (lane_ == Lane::ordinary || work_.most <= small_work) return;
  if (steady_clock::now() - since_ >= admission_.express_time_) admission_.yield(*this, client_gone);
}

void Admission::yield(Slot& slot, const Question& client_gone) {
  std::unique_lock lock(mutex_);
  if (slot.lane_ == Lane::express) {
    if (ordinary_ == slots_ && large_ >= large_places())
      throw Problem(Code::busy, "The work is larger than expected, and all " + std::to_string(slots_) +
                                    " computing slots and " + std::to_string(large_places()) +
                                    " waiting places for large work are taken. Try again after the time in "
                                    "Retry-After.");
    slot.lane_ = Lane::none;
    --express_;
    slot.is_paused_ = true;
    slot.rank_ += slot.work_.most - slot.work_.expected;
    join_queue(slot);
    dispatch();
  }
  (void)wait_for_turn(slot, lock, client_gone);  // the caller polls `client_gone` itself
}

bool Admission::wait_for_turn(Slot& slot, std::unique_lock<std::mutex>& lock, const Question& client_gone) {
  const auto is_decided = [&] { return slot.lane_ != Lane::none || slot.is_refused_; };
  while (!changed_.wait_for(lock, std::chrono::milliseconds(100), is_decided)) {
    lock.unlock();
    const bool gone = client_gone();
    lock.lock();
    if (!gone || is_decided()) continue;
    leave_queue(slot);
    return false;
  }
  return true;
}

void Admission::release(Slot& slot) {
  const std::lock_guard lock(mutex_);
  if (!slot.is_counted_) return;
  leave_queue(slot);
  if (slot.lane_ == Lane::ordinary) --ordinary_;
  if (slot.lane_ == Lane::express) --express_;
  --slot.account_->second.requests;
  dispatch();
  forget_settled_accounts();
}

void Admission::dispatch() {
  while (ordinary_ < slots_) {
    Slot* const next = first_waiting(false);
    if (next == nullptr) break;
    grant(*next, Lane::ordinary);
  }
  if (express_ == 0)
    if (Slot* const next = first_waiting(true)) grant(*next, Lane::express);
  changed_.notify_all();
}

Admission::Slot* Admission::first_waiting(bool small_only) const {
  Slot* first = nullptr;
  const auto order = [&](const Slot& slot) { return std::tuple(start_of(slot.account_->second), slot.rank_); };
  for (Slot* const slot : waiting_)
    if (!(small_only && slot->is_large()) && (first == nullptr || order(*slot) < order(*first))) first = slot;
  return first;
}

void Admission::grant(Slot& slot, Lane lane) {
  leave_queue(slot);
  Account& account = slot.account_->second;
  const uint64_t start = start_of(account);
  const uint64_t work = slot.is_paused_ ? slot.work_.most : slot.work_.expected;
  account.next_start = start + work;
  given_ += work;
  if (lane == Lane::ordinary) {
    ++ordinary_;
    virtual_time_ = start;
  } else {
    ++express_;
    slot.since_ = steady_clock::now();
  }
  slot.lane_ = lane;
}

void Admission::join_queue(Slot& slot) {
  waiting_.splice(waiting_.end(), slot.node_);
  ++slot.account_->second.waiting;
  if (slot.is_large()) ++large_;
}

void Admission::leave_queue(Slot& slot) {
  if (!slot.node_.empty()) return;
  slot.node_.splice(slot.node_.end(), waiting_, slot.place_);
  --slot.account_->second.waiting;
  if (slot.is_large()) --large_;
}

void Admission::refuse_latest(const Slot& newcomer) {
  const bool large_only = newcomer.is_large() && large_ > large_places();
  if (!large_only && static_cast<int>(waiting_.size()) <= queue_) return;
  Slot* refused = nullptr;
  for (Slot* const slot : waiting_) {
    if (slot->is_paused_ || (large_only && !slot->is_large())) continue;
    if (refused == nullptr || slot->account_->second.waiting >= refused->account_->second.waiting) refused = slot;
  }
  leave_queue(*refused);
  refused->is_refused_ = true;
  changed_.notify_all();
}

uint64_t Admission::start_of(const Account& account) const { return std::max(virtual_time_, account.next_start); }

void Admission::forget_settled_accounts() {
  if (ordinary_ + express_ == 0 && waiting_.empty()) {
    virtual_time_ = given_ = 0;
    for (auto& [client, account] : accounts_) account.next_start = 0;
  }
  std::erase_if(accounts_, [&](const auto& entry) {
    return entry.second.requests == 0 && entry.second.next_start <= virtual_time_;
  });
}

int Admission::computing() const {
  const std::lock_guard lock(mutex_);
  return ordinary_ + express_;
}

int Admission::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(waiting_.size());
}

bool Admission::full() const {
  const std::lock_guard lock(mutex_);
  return is_full();
}

void Admission::refuse_when_full(const std::string& client) const {
  const std::lock_guard lock(mutex_);
  if (!is_full()) return;
  const auto account = accounts_.find(client);
  const int waiting = account == accounts_.end() ? 0 : account->second.waiting;
  const auto gives_way = [&](const Slot* slot) {
    return !slot->is_paused_ && slot->account_->second.waiting > waiting + 1;
  };
  if (std::ranges::none_of(waiting_, gives_way)) throw busy();
}

Problem Admission::busy() const {
  return {Code::busy, "All " + std::to_string(slots_) + " computing slots and " + std::to_string(queue_) +
                          " waiting places are taken, or the places for large work, half of them. Try again after the "
                          "time in Retry-After."};
}

}  // namespace papilio::server
