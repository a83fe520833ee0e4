#include "server/store/new_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <random>
#include <string>

namespace papilio::server {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view part_extension = ".part";
constexpr std::chrono::minutes longest_write{10};  ///< bound of a write without a lock, as in earlier versions
constexpr mode_t mode = 0640;

/// Returns a name such as "1234-5678.part" in a folder.
fs::path part_in(const fs::path& folder) {
  std::random_device random;
  return folder / (std::to_string(::getpid()) + "-" + std::to_string(random()) + std::string(part_extension));
}

bool is_part(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == part_extension && stem.find('-') != std::string::npos &&
         stem.find_first_not_of("0123456789-") == std::string::npos;
}

/// Returns the path of an unnamed file.
std::string descriptor_path(int fd) { return "/proc/self/fd/" + std::to_string(fd); }

}  // namespace

NewFile::NewFile(fs::path folder, Until until) : folder_(std::move(folder)) {
  if (until == Until::unnamed) {
    fd_ = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    if (fd_ >= 0) return;
  }
  const fs::path part = part_in(folder_);
  fd_ = ::open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
  if (fd_ < 0) return;
  part_ = part;
  (void)::flock(fd_, LOCK_EX | LOCK_NB);  // without locks, only `longest_write` decides
}

NewFile::~NewFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

bool NewFile::write_and_sync(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes.remove_prefix(static_cast<size_t>(written));
  }
  return ::fsync(fd_) == 0;
}

bool NewFile::link_as(const fs::path& file) const {
  return ::linkat(AT_FDCWD, descriptor_path(fd_).c_str(), AT_FDCWD, file.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

bool NewFile::publish(const fs::path& file) {
  if (part_.empty()) {
    if (link_as(file)) return true;
    if (errno != EEXIST) return false;
    const fs::path part = part_in(folder_);  // only a rename replaces
    if (!link_as(part)) return false;
    part_ = part;
  }
  if (::rename(part_.c_str(), file.c_str()) != 0) {
    if (errno != EISDIR || ::rmdir(file.c_str()) != 0 || ::rename(part_.c_str(), file.c_str()) != 0) return false;
  }
  part_.clear();
  return true;
}

NewFile::Until supported_until(const fs::path& folder) {
  NewFile probe(folder, NewFile::Until::unnamed);
  const fs::path name = part_in(folder);
  if (!probe.is_open() || !probe.publish(name)) return NewFile::Until::part;
  ::unlink(name.c_str());
  return NewFile::Until::unnamed;
}

void remove_if_abandoned(const fs::path& file) {
  std::error_code error;
  if (!is_part(file)) return;
  const auto written = fs::last_write_time(file, error);
  if (error || fs::file_time_type::clock::now() - written <= longest_write) return;
  const int fd = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const bool is_locked = fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!is_locked) ::unlink(file.c_str());
  if (fd >= 0) ::close(fd);
}

}  // namespace papilio::server
