#include "server/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace papilio::server {
namespace {

constexpr size_t piece_bytes = 64 << 10;

/// Regular file opened for reading; after a failure, errno has the reason.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file)
      : fd_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {  // O_NONBLOCK: a pipe must not block
    struct stat status {};
    if (fd_ < 0 || ::fstat(fd_, &status) != 0) return;
    is_regular_ = S_ISREG(status.st_mode);
    size_ = static_cast<size_t>(status.st_size);
    if (!is_regular_) errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
  }
  ~OpenFile() {
    const int reason = errno;
    if (fd_ >= 0) ::close(fd_);
    errno = reason;
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] bool is_open() const { return is_regular_; }
  [[nodiscard]] size_t size() const { return size_; }
  /// Reads the remaining bytes, at most `size`. Returns their number; negative with errno.
  [[nodiscard]] ssize_t read(char* bytes, size_t size) const {
    size_t total = 0;
    while (total < size) {
      const ssize_t got = ::read(fd_, bytes + total, size - total);
      if (got == 0) break;
      if (got > 0) total += static_cast<size_t>(got);
      if (got < 0 && errno != EINTR) return -1;
    }
    return static_cast<ssize_t>(total);
  }

 private:
  const int fd_;
  bool is_regular_ = false;
  size_t size_ = 0;
};

}  // namespace

std::shared_ptr<const std::string> read_file(const std::filesystem::path& file) {
  const OpenFile in(file);
  if (!in.is_open()) return nullptr;
  std::string bytes(in.size(), '\0');
  const ssize_t got = in.read(bytes.data(), bytes.size());
  if (got < 0) return nullptr;
  bytes.resize(static_cast<size_t>(got));
  return std::make_shared<const std::string>(std::move(bytes));
}

bool file_holds(const std::filesystem::path& file, std::string_view bytes) {
  const OpenFile in(file);
  if (!in.is_open() || in.size() != bytes.size()) return false;
  std::string piece(std::min(bytes.size(), piece_bytes), '\0');
  while (!bytes.empty()) {
    const std::string_view expected = bytes.substr(0, piece.size());
    const ssize_t got = in.read(piece.data(), expected.size());
    if (got < 0 || std::string_view(piece).substr(0, static_cast<size_t>(got)) != expected) return false;
    bytes.remove_prefix(expected.size());
  }
  return true;
}

}  // namespace papilio::server
