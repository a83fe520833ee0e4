#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

namespace papilio::server {

/// Cache of values by text key, bounded in bytes; least recently used values are evicted. Values are shared, so that an
/// evicted one stays valid for its users. Thread-safe.
template <class Value>
class Lru {
 public:
  /// Bytes of an entry besides its value: nodes, key, counters.
  static constexpr uint64_t entry_bytes = 256;

  explicit Lru(uint64_t budget) : budget_(budget) {}

  /// Returns the value and marks it most recently used; null if there is none.
  std::shared_ptr<Value> get(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    order_.splice(order_.begin(), order_, found->second.place);
    return found->second.value;
  }

  /// Stores the value, or updates its size; a value larger than the budget is not stored. Returns whether the key is
  /// new.
  bool put(const std::string& key, std::shared_ptr<Value> value, uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    const bool is_new = !drop(key);
    if (bytes + entry_bytes > budget_) return is_new;
    std::list<std::string> place{key};
    entries_.emplace(key, Entry{std::move(value), bytes + entry_bytes, place.begin()});
    order_.splice(order_.begin(), place);  // last, as it cannot fail: both lists have the key, or neither
    bytes_ += bytes + entry_bytes;
    while (bytes_ > budget_) drop(order_.back());
    return is_new;
  }

  /// Removes the value. Returns whether there was one.
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

  /// Drops an entry. The key may refer to the string in `order_`.
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
  std::list<std::string> order_;  ///< keys, most recently used first
  std::unordered_map<std::string, Entry> entries_;
  uint64_t bytes_ = 0;
};

}  // namespace papilio::server
