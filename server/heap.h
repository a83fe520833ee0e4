#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

// glibc's malloc, told what this program is: a few large requests at once on any of many threads, each of which needs
// about as much as the one before. Left alone it makes eight arenas a core, each of which comes to hold what the
// largest request on it has freed; and it gives every request's memory back to the system and takes it again, a fault
// for each page of it.

namespace papilio::server {

/// Makes threads share as many arenas as requests compute at once, and keep what is freed for the next request; where
/// `new` finds no memory, the core's spare blocks (papilio/buffer.h) are given back before it fails. Call before there
/// are threads.
void set_up_heap(int slots);

/// Gives what requests have freed back to the system: once there are no more of them, and now and then while they come,
/// as those to come may be smaller.
class FreeMemory {
 public:
  /// A request is done. To be called by the thread that has worked on it.
  void count_request();
  /// To be called every second while nothing computes: returns free memory if requests were done, but none since the
  /// call before, or else at every fifth call. Takes milliseconds.
  void give_back();

 private:
  std::mutex mutex_;
  uint64_t done_ = 0, seen_ = 0, given_back_at_ = 0;
  int calls_ = 0;                          ///< since it was given back
  uint64_t round_ = 1;                     ///< of giving back
  std::vector<std::vector<char>> blocks_;  ///< one of each thread that has worked in this round
};

}  // namespace papilio::server
