#include "server/store/directory_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <stdexcept>

#include "proto/problem.h"
#include "server/file_bytes.h"
#include "server/log.h"
#include "server/sha256.h"

namespace papilio::server {

namespace fs = std::filesystem;
using proto::Code;
using proto::Problem;

namespace {

constexpr std::string_view extension = ".drc";
constexpr std::string_view unfinished = ".part";
constexpr std::chrono::minutes count_interval{1};
constexpr int most_counts = 3;                     ///< while meshes come and go; at the last they wait
constexpr std::chrono::minutes longest_write{10};  ///< what is unfinished for longer was interrupted

/// The operator's log has the reason, the client only what concerns it.
Problem unavailable(const fs::path& path, const std::string& reason) {
  log_event("error", "store", {{"path", path.string()}, {"reason", reason}});
  return {Code::store_unavailable,
          "The store of meshes cannot be used at present. Try again after the time in "
          "Retry-After."};
}

Problem unavailable(const fs::path& path) { return unavailable(path, std::strerror(errno)); }

/// A descriptor that is closed in the end.
class File {
 public:
  File(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0640)) {}
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  [[nodiscard]] bool sync() const { return ::fsync(fd_) == 0; }
  [[nodiscard]] bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) return false;
      if (written > 0) bytes.remove_prefix(static_cast<size_t>(written));
    }
    return true;
  }

 private:
  const int fd_;
};

/// "1234-5678.part"
std::string part_name() {
  std::random_device random;
  return std::to_string(::getpid()) + "-" + std::to_string(random()) + std::string(unfinished);
}

// Whatever else lies below the directory belongs to somebody else.

bool is_part(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == unfinished && stem.find('-') != std::string::npos &&
         stem.find_first_not_of("0123456789-") == std::string::npos;
}

bool is_mesh(const fs::path& file) { return file.extension() == extension && is_sha256(file.stem().string()); }

bool is_stale(const fs::directory_entry& file) {
  std::error_code error;
  const auto written = file.last_write_time(error);
  return !error && fs::file_time_type::clock::now() - written > longest_write;
}

}  // namespace

DirectoryStore::DirectoryStore(fs::path directory, uint64_t budget)
    : directory_(std::move(directory)), budget_(budget) {
  std::error_code error;
  fs::create_directories(directory_, error);
  const fs::path probe = directory_ / part_name();
  if (!File(probe, O_WRONLY | O_CREAT | O_EXCL).is_open())
    throw std::runtime_error("cannot write into the store's directory " + directory_.string() + ": " +
                             std::strerror(errno));
  fs::remove(probe, error);
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(directory_))
    if (is_part(file.path()) && is_stale(file)) fs::remove(file, error);
  count_files();
}

fs::path DirectoryStore::file_of(const std::string& id) const {
  return directory_ / id.substr(0, 2) / (id + std::string(extension));
}

bool DirectoryStore::put(const std::string& id, std::string_view bytes) {
  if (contains(id)) return false;
  Room room(*this, bytes.size());
  write(file_of(id), bytes, room);
  return true;
}

void DirectoryStore::write(const fs::path& file, std::string_view bytes, Room& room) {
  std::error_code error;
  const bool is_new = fs::create_directories(file.parent_path(), error);
  if (is_new && !File(directory_, O_RDONLY | O_DIRECTORY).sync()) throw unavailable(directory_);
  const fs::path part = file.parent_path() / part_name();
  bool written = false;
  {
    const File out(part, O_WRONLY | O_CREAT | O_EXCL);
    written = out.is_open() && out.write(bytes) && out.sync();
  }
  if (!written || !publish(part, file, room)) {
    const int reason = errno;
    fs::remove(part, error);
    if (reason == ENOSPC || reason == EDQUOT)
      throw Problem(Code::store_full, "The store's disk is full. Delete meshes, or ask the operator for room.");
    throw unavailable(part, std::strerror(reason));
  }
  if (!File(file.parent_path(), O_RDONLY | O_DIRECTORY).sync()) throw unavailable(file);
}

bool DirectoryStore::publish(const fs::path& part, const fs::path& file, Room& room) {
  const std::lock_guard lock(mutex_);
  if (::rename(part.c_str(), file.c_str()) != 0) return false;
  const uint64_t bytes = room.give_up();
  being_written_ -= bytes;
  usage_.bytes += bytes;
  ++usage_.meshes;
  ++changes_;
  return true;
}

bool DirectoryStore::contains(const std::string& id) {
  const fs::path file = file_of(id);
  std::error_code error;
  const bool is_there = fs::exists(file, error);
  if (error) throw unavailable(file, error.message());
  return is_there;
}

MeshStore::Bytes DirectoryStore::get(const std::string& id) {
  const fs::path file = file_of(id);
  errno = 0;
  MeshStore::Bytes bytes = read_file(file);
  if (bytes == nullptr) {
    if (errno != ENOENT) throw unavailable(file);
    return nullptr;
  }
  if (sha256(*bytes) == id) return bytes;
  log_event("error", "store",
            {{"path", file.string()}, {"reason", "the content is not what the name says; the file is taken away"}});
  remove(id);
  return nullptr;
}

bool DirectoryStore::remove(const std::string& id) {
  const fs::path file = file_of(id);
  std::error_code error;
  const uint64_t bytes = fs::file_size(file, error);
  if (error == std::errc::no_such_file_or_directory) return false;
  if (error) throw unavailable(file, error.message());
  const std::lock_guard lock(mutex_);
  if (!fs::remove(file, error)) {
    if (error) throw unavailable(file, error.message());
    return false;
  }
  usage_.meshes -= std::min<uint64_t>(usage_.meshes, 1);
  usage_.bytes -= std::min(usage_.bytes, bytes);
  ++changes_;
  return true;
}

MeshStore::Usage DirectoryStore::files() const {
  Usage counted;
  std::error_code error;
  for (auto file = fs::recursive_directory_iterator(directory_, error); file != fs::recursive_directory_iterator();
       file.increment(error)) {
    if (error) break;
    std::error_code gone;
    const uint64_t bytes = file->is_regular_file(gone) ? file->file_size(gone) : 0;
    if (gone || !is_mesh(file->path())) continue;
    ++counted.meshes;
    counted.bytes += bytes;
  }
  return counted;
}

void DirectoryStore::count_files() {
  std::unique_lock lock(mutex_);
  for (int count = 1;; ++count) {
    const uint64_t changes = changes_;
    const bool others_wait = count == most_counts;
    if (!others_wait) lock.unlock();
    const Usage counted = files();
    if (!others_wait) lock.lock();
    if (changes_ != changes) continue;
    usage_ = counted;
    counted_ = std::chrono::steady_clock::now();
    return;
  }
}

bool DirectoryStore::reserve(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  const bool is_counted = std::chrono::steady_clock::now() - counted_ < count_interval;
  const bool fits = is_counted && usage_.bytes + being_written_ + bytes <= budget_;
  if (fits) being_written_ += bytes;
  return fits;
}

DirectoryStore::Room::Room(DirectoryStore& store, uint64_t bytes) : store_(store), bytes_(bytes) {
  if (store_.reserve(bytes)) return;
  store_.count_files();
  if (!store_.reserve(bytes))
    throw Problem(Code::store_full,
                  "The store of " + std::to_string(store_.budget_) +
                      " bytes has no room for this mesh. Delete meshes, or ask the operator for room.");
}

DirectoryStore::Room::~Room() {
  const std::lock_guard lock(store_.mutex_);
  store_.being_written_ -= bytes_;
}

std::optional<MeshStore::Usage> DirectoryStore::usage() {
  const std::lock_guard lock(mutex_);
  return usage_;
}

}  // namespace papilio::server
