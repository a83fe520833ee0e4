#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace papilio::server {

/// Bytes that all requests together may hold. Any thread may use it.
class ByteBudget {
 public:
  explicit ByteBudget(uint64_t bytes) : bytes_(static_cast<int64_t>(bytes)), left_(bytes_) {}

  /// A share of the budget that grows, and is given back when it is destroyed.
  class Share {
   public:
    explicit Share(ByteBudget& budget) : budget_(budget) {}
    ~Share() { give_back(); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// False when the budget does not allow so many bytes in all; the share is then what it was.
    [[nodiscard]] bool grow_to(uint64_t bytes) {
      const int64_t more = static_cast<int64_t>(bytes) - held_;
      if (more <= 0) return true;
      if (budget_.left_.fetch_sub(more) < more) {
        budget_.left_ += more;
        return false;
      }
      held_ += more;
      return true;
    }

    void give_back() { budget_.left_ += std::exchange(held_, 0); }

   private:
    ByteBudget& budget_;
    int64_t held_ = 0;
  };

  /// What all shares hold; more for a moment while one is refused.
  [[nodiscard]] uint64_t held() const { return static_cast<uint64_t>(bytes_ - left_); }

 private:
  const int64_t bytes_;
  std::atomic<int64_t> left_;
};

}  // namespace papilio::server
