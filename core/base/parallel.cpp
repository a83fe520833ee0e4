#include "base/parallel.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <vector>

namespace papilio {

uint32_t parts_of(uint32_t count, int threads) {
  return std::clamp(count / least_per_thread, 1U, static_cast<uint32_t>(std::max(threads, 1)));
}

void for_each_part(uint32_t parts, uint32_t count, const std::function<void(uint32_t, uint32_t, uint32_t)>& work) {
  const auto start_of = [&](uint32_t part) { return static_cast<uint32_t>(uint64_t{count} * part / parts); };
#if defined(__wasm__)  // std::thread is not declared
  for (uint32_t part = 0; part < parts; ++part) work(part, start_of(part), start_of(part + 1));
#else
  if (parts <= 1) {
    work(0, 0, count);
    return;
  }
  std::vector<std::exception_ptr> failures(parts);
  const auto run = [&](uint32_t part) {
    try {
      work(part, start_of(part), start_of(part + 1));
    } catch (...) {
      failures[part] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(parts);
  uint32_t started = 1;
  try {
    for (; started < parts; ++started) threads.emplace_back(run, started);
  } catch (...) {
    // Too many threads, or too little memory: the remaining parts run on this thread.
  }
  run(0);
  for (uint32_t part = started; part < parts; ++part) run(part);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
#endif
}

}  // namespace papilio
