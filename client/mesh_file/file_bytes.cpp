#include "client/mesh_file/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

std::string advice(int error) {
  switch (error) {
    case ENOENT:
      return "check the name and that the folder exists";
    case EACCES:
    case EPERM:
    case EROFS:
      return "check the permissions of the file and its folder";
    case ENOSPC:
    case EDQUOT:
      return "make room on the disk or choose another folder";
    case EFBIG:
      return "raise the limit on file sizes (ulimit -f) or choose another disk";
    default:
      return "choose another place";
  }
}

FileError failure(const fs::path& path, const std::string& action, int error) {
  return {path, "cannot " + action + ": " + reason(error) + "; " + advice(error)};
}

/// Open file that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  /// Closes the file. Returns false, with errno, if written bytes could not be stored (as quotas and network disks
  /// report).
  bool close() { return !is_open() || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// File that is removed at the end of its scope, unless it was renamed to `path`.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& beside) : path_(beside.parent_path() / unique_name(beside)) {}
  ~TemporaryFile() {
    if (exists_) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// Creates the file. Returns a descriptor to write to, or a closed one with errno.
  [[nodiscard]] int create() {
    const int number = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    exists_ = number >= 0;
    return number;
  }
  [[nodiscard]] bool become(const fs::path& path) {
    const bool renamed = ::rename(path_.c_str(), path.c_str()) == 0;
    if (renamed) exists_ = false;
    return renamed;
  }

 private:
  static std::string unique_name(const fs::path& beside) {
    static std::atomic<unsigned> counter{0};
    // Names may have 255 bytes: the target's name is cut to leave room.
    return "." + beside.filename().string().substr(0, 200) + "." + std::to_string(::getpid()) + "." +
           std::to_string(counter++) + ".tmp";
  }

  fs::path path_;
  bool exists_ = false;
};

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

/// Returns the target of `path` through symbolic links; the file itself need not exist.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  const fs::path target = fs::weakly_canonical(path, failed);
  return failed ? path : target;
}

/// Reads all bytes of an open file. `path`: its name for messages.
std::string read_open(int descriptor, const fs::path& path, uint64_t limit) {
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) throw failure(path, "be read", errno);
  if (S_ISDIR(about.st_mode)) throw FileError(path, "is a folder; name a file in it");
  const auto refuse_if_above_limit = [&](uint64_t size) {
    if (size > limit)
      throw FileError(path,
                      "has more than " + std::to_string(limit) + " bytes, the most that is read; simplify it first");
  };
  const auto size = S_ISREG(about.st_mode) ? static_cast<uint64_t>(about.st_size) : 0;
  refuse_if_above_limit(size);

  constexpr size_t kChunk = 1 << 16;
  std::string bytes;
  size_t used = 0;
  // One byte more than the size, so that the end of the file is read without growing.
  bytes.resize(std::max<size_t>(size + 1, kChunk));
  for (;;) {
    const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw failure(path, "be read", errno);
    if (got == 0) break;
    used += static_cast<size_t>(got);
    refuse_if_above_limit(used);
    if (used == bytes.size()) bytes.resize(2 * used);
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::string read_bytes(const fs::path& path, uint64_t limit) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) throw failure(path, "be opened", errno);
  return read_open(file.number(), path, limit);
}

std::string read_standard_input(uint64_t limit) { return read_open(STDIN_FILENO, standard_input_name, limit); }

void write_atomically(const fs::path& path, std::string_view bytes) {
  const fs::path target = resolved(path);
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) throw FileError(path, "is a folder; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw FileError(path, "is a device or pipe, which cannot be replaced; name a file");

  TemporaryFile temporary(target);
  Descriptor file(temporary.create());
  if (!file.is_open() || !write_all(file.number(), bytes) || !file.close() || !temporary.become(target))
    throw failure(path, "be written", errno);
}

}  // namespace papilio::client
