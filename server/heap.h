#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

// Configuration of glibc's malloc for this program: few large requests at once, on any of many threads, each with about
// as much memory as the one before. By default it makes eight arenas per core, each of which retains the memory of the
// largest request on it. It also returns each request's memory to the system and takes it again, with a fault per page.

namespace papilio::server {

/// Limits the arenas to the number of concurrent computations, and retains freed memory for the next request. If `new`
/// finds no memory, the core's spare blocks (papilio/buffer.h) are released before it fails. Call before any thread is
/// started.
void set_up_heap(int slots);

/// Return of freed memory to the system: once requests have ceased, and occasionally between requests, as later ones
/// may be smaller.
class FreeMemory {
 public:
  /// Counts a finished request. Call on the thread that worked on it.
  void count_request();
  /// Returns free memory if requests were done, but none since the last call; or else at every fifth call. Call every
  /// second while nothing computes. Takes milliseconds.
  void give_back();

 private:
  std::mutex mutex_;
  uint64_t done_ = 0, seen_ = 0, given_back_at_ = 0;
  int calls_ = 0;                          ///< calls since memory was returned
  uint64_t round_ = 1;                     ///< number of returns
  std::vector<std::vector<char>> blocks_;  ///< one block of each thread that has worked in this round
};

}  // namespace papilio::server
