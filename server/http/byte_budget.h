#pragma once

#include <atomic>
#include <cstdint>

namespace papilio::server {

/// Bytes that all requests together may hold. Any thread may use it.
class ByteBudget {
 public:
  explicit ByteBudget(uint64_t bytes) : left_(static_cast<int64_t>(bytes)) {}

  /// A share of the budget that grows, and is given back when it is destroyed.
  class Share {
   public:
    explicit Share(ByteBudget& budget) : budget_(budget) {}
    ~Share() { budget_.left_ += held_; }
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

   private:
    ByteBudget& budget_;
    int64_t held_ = 0;
  };

 private:
  std::atomic<int64_t> left_;
};

}  // namespace papilio::server
