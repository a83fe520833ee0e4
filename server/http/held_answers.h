#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <mutex>

#include "server/http/connection.h"

namespace papilio::server {

/// Memory of the answers being sent. A client may read slowly, but not at the cost of others: if all answers together
/// exceed the budget, the oldest are cut. Thread-safe.
class HeldAnswers {
 public:
  explicit HeldAnswers(uint64_t budget) : budget_(budget) {}
  HeldAnswers(const HeldAnswers&) = delete;
  HeldAnswers& operator=(const HeldAnswers&) = delete;

  /// Memory of the answer on one connection, until it is destroyed.
  class Share {
   public:
    /// Starts without memory. The connection must outlive the share.
    Share(HeldAnswers& all, const Connection& connection);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Sets the bytes that the answer holds. An `object` held by several answers counts once; null: not shared. May cut
    /// other answers.
    void hold(uint64_t bytes, const void* object = nullptr);
    /// Returns whether the answer was cut to make room for others.
    [[nodiscard]] bool is_cut() const;

   private:
    friend class HeldAnswers;
    HeldAnswers& all_;
    const Connection& connection_;
    std::list<Share*>::iterator place_;
    uint64_t bytes_ = 0;
    const void* object_ = nullptr;
    bool is_cut_ = false;
  };

  /// Returns the bytes that all answers hold, except cut ones.
  [[nodiscard]] uint64_t bytes() const;

 private:
  /// Subtracts a share's bytes, with the mutex held.
  void discount(const Share& share);
  void cut_oldest_but(const Share& newest);

  const uint64_t budget_;
  mutable std::mutex mutex_;  ///< guards the fields that follow, and the fields of shares
  std::list<Share*> shares_;  ///< shares, the oldest first
  std::map<const void*, int> holders_;
  uint64_t bytes_ = 0;
};

}  // namespace papilio::server
