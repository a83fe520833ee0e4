#pragma once

#include <atomic>
#include <cstdint>

// glibc's malloc, told what this program is: a few large requests at once on any of many threads. Left alone it makes
// eight arenas a core, each of which comes to hold what the largest request on it has freed.

namespace papilio::server {

/// Makes threads share as many arenas as requests compute at once. Call before there are threads.
void share_arenas(int slots);

/// Gives what large requests have freed back to the system, once they are done.
class FreeMemory {
 public:
  /// A request is done. Any thread may call it.
  void count_request() { ++done_; }
  /// To be called now and then while nothing computes: returns free memory if requests were done since the last time.
  /// Takes milliseconds.
  void give_back();

 private:
  std::atomic<uint64_t> done_ = 0;
  uint64_t given_back_at_ = 0;
};

}  // namespace papilio::server
