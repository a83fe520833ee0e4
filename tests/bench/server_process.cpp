#include "tests/bench/server_process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace papilio::bench {

ServerProcess::ServerProcess() {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "papilio-server").string();
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe to papilio-server");
  pid_ = fork();
  if (pid_ == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    execl(program.c_str(), program.c_str(), "--port", "0", nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::string line;  // listening on http://127.0.0.1:PORT
  for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) line += c;
  close(ends[0]);
  const size_t colon = line.rfind(':');
  if (colon != std::string::npos) std::from_chars(line.data() + colon + 1, line.data() + line.size(), port_);
  if (port_ == 0) throw std::runtime_error(program + " does not start; build it");
}

ServerProcess::~ServerProcess() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

}  // namespace papilio::bench
