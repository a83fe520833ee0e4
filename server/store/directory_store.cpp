#include "server/store/directory_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <optional>
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

constexpr std::chrono::minutes count_interval{1};
constexpr int most_counts = 3;  ///< upper bound of recounts while meshes change; changes wait for the last one

/// Logs the reason for the operator, and returns the problem for the client.
Problem unavailable(const fs::path& path, const std::string& reason) {
  log_event("error", "store", {{"path", path.string()}, {"reason", reason}});
  return {Code::store_unavailable,
          "The store of meshes cannot be used at present. Try again after the time in "
          "Retry-After."};
}

Problem unavailable(const fs::path& path) { return unavailable(path, std::strerror(errno)); }

/// Waits until the names in a folder are on the disk.
bool sync_folder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool is_synced = fd >= 0 && ::fsync(fd) == 0;
  const int reason = errno;
  if (fd >= 0) ::close(fd);
  errno = reason;
  return is_synced;
}

}  // namespace

DirectoryStore::DirectoryStore(fs::path directory, uint64_t budget, std::chrono::milliseconds sweep_interval)
    : files_(std::move(directory)), budget_(budget) {
  const fs::path& folder = files_.directory();
  std::error_code error;
  fs::create_directories(folder, error);
  until_ = supported_until(folder);
  if (!NewFile(folder, until_).is_open())
    throw std::runtime_error("cannot write into the store's directory " + folder.string() + ": " +
                             std::strerror(errno));
  try {
    files_.remove_abandoned();
    count_files();
  } catch (const fs::filesystem_error& failure) {
    throw std::runtime_error("cannot read the store's directory " + folder.string() + ": " + failure.code().message());
  }
  sweeper_ =
      std::jthread([this, sweep_interval](const std::stop_token& stop) { sweep_at_intervals(stop, sweep_interval); });
}

void DirectoryStore::sweep_at_intervals(const std::stop_token& stop, std::chrono::milliseconds interval) {
  std::mutex mutex;
  std::condition_variable_any stopping;  // notified only by the stop request
  std::unique_lock lock(mutex);
  while (!stopping.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
    try {
      files_.remove_abandoned();
    } catch (const std::exception& error) {
      log_event("error", "store", {{"path", files_.directory().string()}, {"reason", error.what()}});
    }
  }
}

bool DirectoryStore::put(const std::string& id, std::string_view bytes) {
  const fs::path file = files_.file_of(id);
  const std::optional<uint64_t> there = size_of(file);
  if (there && file_holds(file, bytes)) return false;
  if (there) log_event("error", "store", {{"path", file.string()}, {"reason", "the file is damaged; it is replaced"}});
  Room room(*this, bytes.size() - std::min<uint64_t>(bytes.size(), there.value_or(0)));
  write(file, bytes, room);
  return true;
}

void DirectoryStore::write(const fs::path& file, std::string_view bytes, Room& room) {
  const fs::path folder = file.parent_path();
  std::error_code error;
  const bool is_new = fs::create_directories(folder, error);
  if (is_new && !sync_folder(files_.directory())) throw unavailable(files_.directory());
  NewFile written(folder, until_);
  if (!written.is_open() || !written.write_and_sync(bytes) || !publish(written, file, bytes.size(), room)) {
    if (errno == ENOSPC || errno == EDQUOT)
      throw Problem(Code::store_full, "The store's disk is full. Delete meshes, or ask the operator for room.");
    if (errno == ENOTEMPTY || errno == EEXIST)
      throw unavailable(file, "a folder with files is in the place of a mesh; move it away");
    throw unavailable(file);
  }
  if (!sync_folder(folder)) throw unavailable(folder);
}

bool DirectoryStore::publish(NewFile& written, const fs::path& file, uint64_t bytes, Room& room) {
  const std::lock_guard lock(mutex_);
  const std::optional<uint64_t> replaced = size_of(file);
  if (!written.publish(file)) return false;
  being_written_ -= room.give_up();
  usage_.meshes += replaced ? 0 : 1;
  usage_.bytes += bytes - std::min(usage_.bytes + bytes, replaced.value_or(0));
  ++changes_;
  return true;
}

std::optional<uint64_t> DirectoryStore::size_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    if (errno != ENOENT && errno != ENOTDIR) throw unavailable(file);
    return std::nullopt;
  }
  return S_ISREG(status.st_mode) ? std::optional<uint64_t>(status.st_size) : std::nullopt;
}

bool DirectoryStore::contains(const std::string& id) { return size_of(files_.file_of(id)).has_value(); }

MeshStore::Bytes DirectoryStore::get(const std::string& id) {
  const fs::path file = files_.file_of(id);
  if (!size_of(file)) return nullptr;
  MeshStore::Bytes bytes = read_file(file);
  if (bytes == nullptr) {
    if (errno != ENOENT) throw unavailable(file);
    return nullptr;
  }
  if (sha256(*bytes) == id) return bytes;
  // The file stays: another server may be replacing it now, and its mesh must not be removed.
  log_event("error", "store",
            {{"path", file.string()}, {"reason", "the content is not what the name says; send the mesh again"}});
  return nullptr;
}

bool DirectoryStore::remove(const std::string& id) {
  const fs::path file = files_.file_of(id);
  const std::optional<uint64_t> bytes = size_of(file);
  if (!bytes) return false;
  const std::lock_guard lock(mutex_);
  if (::unlink(file.c_str()) != 0) {
    if (errno != ENOENT) throw unavailable(file);
    return false;
  }
  usage_.meshes -= std::min<uint64_t>(usage_.meshes, 1);
  usage_.bytes -= std::min(usage_.bytes, *bytes);
  ++changes_;
  return true;
}

void DirectoryStore::count_files() {
  std::unique_lock lock(mutex_);
  for (int count = 1;; ++count) {
    const uint64_t changes = changes_;
    const bool others_wait = count == most_counts;
    if (!others_wait) lock.unlock();
    const Usage counted = files_.count();
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
  try {
    store_.count_files();
  } catch (const fs::filesystem_error& error) {
    throw unavailable(error.path1(), error.code().message());
  }
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
