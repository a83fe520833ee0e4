#include "tests/support/peak_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "papilio/buffer.h"

namespace papilio::test {
namespace {

/// Returns the peak resident memory of this process, in MiB.
double most_resident() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

[[noreturn]] void send(int end, const std::function<double()>& work) {
  bool sent = false;
  try {
    const double found = work();
    sent = ::write(end, &found, sizeof(found)) == static_cast<ssize_t>(sizeof(found));
  } catch (const std::exception&) {  // the parent reports the missing result
  }
  std::_Exit(sent ? 0 : 1);
}

}  // namespace

double in_child_process(const std::function<double()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) send(ends[1], work);
  ::close(ends[1]);
  double found = 0;
  const bool received = ::read(ends[0], &found, sizeof(found)) == static_cast<ssize_t>(sizeof(found));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!received) throw std::runtime_error("the process that was measured has failed");
  return found;
}

double peak_memory_of(const std::function<void()>& work, const std::function<void()>& before) {
  release_spare_blocks();
  ::malloc_trim(0);
  return in_child_process([&] {
    before();
    const double resident = most_resident();
    work();
    return most_resident() - resident;
  });
}

}  // namespace papilio::test
