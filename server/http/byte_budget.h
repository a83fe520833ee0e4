#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace papilio::server {

/// Budget of bytes that all requests together may hold. Thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(uint64_t bytes) : bytes_(static_cast<int64_t>(bytes)), left_(bytes_) {}

  /// Growing share of the budget. The destructor returns it.
  class Share {
   public:
    explicit Share(ByteBudget& budget) : budget_(budget) {}
    ~Share() { give_back(); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Grows the share to `bytes`. Returns false, with the share unchanged, if the budget does not suffice.
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

  /// Returns the bytes of all shares; briefly more while one is refused.
  [[nodiscard]] uint64_t held() const { return static_cast<uint64_t>(bytes_ - left_); }

 private:
  const int64_t bytes_;
  std::atomic<int64_t> left_;
};

}  // namespace papilio::server
