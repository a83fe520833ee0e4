#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <mutex>

#include "server/http/connection.h"

namespace papilio::server {

/// Memory of the answers that are being sent. A client may take its time over an answer, but not over memory that
/// others need: where all answers together pass the budget, those that have been sent longest are cut. Any thread may
/// use it.
class HeldAnswers {
 public:
  explicit HeldAnswers(uint64_t budget) : budget_(budget) {}
  HeldAnswers(const HeldAnswers&) = delete;
  HeldAnswers& operator=(const HeldAnswers&) = delete;

  /// What the answer on one connection holds, until it is destroyed.
  class Share {
   public:
    /// The connection must outlive the share.
    Share(HeldAnswers& all, const Connection& connection);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// The answer holds so many bytes from now on, in place of what it held. Several answers may hold the same
    /// `object`, which counts once; null: nobody else holds it. May cut other answers.
    void hold(uint64_t bytes, const void* object = nullptr);
    /// Whether the answer was cut to make room for others.
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

  /// What all answers hold now, those that are cut excepted.
  [[nodiscard]] uint64_t bytes() const;

 private:
  // With the mutex held.
  void discount(const Share& share);
  void cut_oldest_but(const Share& newest);

  const uint64_t budget_;
  mutable std::mutex mutex_;  ///< guards all below, and what the shares have
  std::list<Share*> shares_;  ///< the oldest first
  std::map<const void*, int> holders_;
  uint64_t bytes_ = 0;
};

}  // namespace papilio::server
