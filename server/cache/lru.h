#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

namespace papilio::server {

/// Values under text keys, up to a number of bytes; what was used longest ago gives way. Values are shared, so that one
/// that gives way lives on with those who use it. Any thread may use it.
template <class Value>
class Lru {
 public:
  /// What an entry takes besides its value: nodes, key, counters.
  static constexpr uint64_t entry_bytes = 256;

  explicit Lru(uint64_t budget) : budget_(budget) {}

  /// Null when there is none; else it is now the one used last.
  std::shared_ptr<Value> get(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    order_.splice(order_.begin(), order_, found->second.place);
    return found->second.value;
  }

  /// Keeps the value, or takes note of its new size; one that is larger than the whole budget is not kept. True when
  /// it is new.
  bool put(const std::string& key, std::shared_ptr<Value> value, uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    const bool is_new = !drop(key);
    if (bytes + entry_bytes > budget_) return is_new;
    std::list<std::string> place{key};
    entries_.emplace(key, Entry{std::move(value), bytes + entry_bytes, place.begin()});
    order_.splice(order_.begin(), place);  // last, since it cannot fail: both or neither have the key
    bytes_ += bytes + entry_bytes;
    while (bytes_ > budget_) drop(order_.back());
    return is_new;
  }

  /// True when it was there.
  bool remove(const std::string& key) {
    const std::lock_guard lock(mutex_);
    return drop(key);
  }

  [[nodiscard]] bool contains(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    return entries_.contains(key);
  }
  [[nodiscard]] uint64_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }
  [[nodiscard]] uint64_t size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
  }
  [[nodiscard]] uint64_t budget() const { return budget_; }

 private:
  struct Entry {
    std::shared_ptr<Value> value;
    uint64_t bytes;
    std::list<std::string>::iterator place;
  };

  /// The key may be the one in `order_`.
  bool drop(const std::string& key) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return false;
    bytes_ -= found->second.bytes;
    order_.erase(found->second.place);
    entries_.erase(found);
    return true;
  }

  const uint64_t budget_;
  mutable std::mutex mutex_;
  std::list<std::string> order_;  ///< the one used last first
  std::unordered_map<std::string, Entry> entries_;
  uint64_t bytes_ = 0;
};

}  // namespace papilio::server
