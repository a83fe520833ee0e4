#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "server/store/mesh_store.h"
#include "server/store/new_file.h"
#include "server/store/store_files.h"

namespace papilio::server {

/// Store of each mesh in a file, DIRECTORY/ab/abcd....drc. A file is named once it is written and synced, so that a
/// mesh is stored completely or not at all, however the process ends. Several servers may share the directory.
///
/// A file whose content does not match its name, or a folder in its place, is an absent mesh to get(); put() replaces
/// it. Files of other names are ignored. An unreadable directory is store_unavailable, not an absence.
class DirectoryStore final : public MeshStore {
 public:
  static constexpr std::chrono::minutes default_sweep_interval{10};

  /// Creates the directory if necessary. Removes files of interrupted writes, now and once per interval. Throws
  /// std::runtime_error.
  DirectoryStore(std::filesystem::path directory, uint64_t budget,
                 std::chrono::milliseconds sweep_interval = default_sweep_interval);

  bool put(const std::string& id, std::string_view bytes) override;
  bool contains(const std::string& id) override;
  Bytes get(const std::string& id) override;
  bool remove(const std::string& id) override;
  [[nodiscard]] std::string_view kind() const override { return "directory"; }
  [[nodiscard]] std::optional<Usage> usage() override;

 private:
  /// Returns the size of a mesh's file; nothing if there is none. Throws `Problem` if that is unknown.
  [[nodiscard]] static std::optional<uint64_t> size_of(const std::filesystem::path& file);
  /// Counts the files. Throws std::filesystem::filesystem_error if the directory cannot be read.
  void count_files();
  /// Reserves bytes. Returns false if there is no room, or the count is outdated.
  [[nodiscard]] bool reserve(uint64_t bytes);
  /// Removes files of interrupted writes once per interval, until a stop is requested.
  void sweep_at_intervals(const std::stop_token& stop, std::chrono::milliseconds interval);

  /// Reservation for a mesh while it is written, so that concurrent writes together cannot exceed the budget. Throws
  /// `Problem` store_full.
  class Room {
   public:
    Room(DirectoryStore& store, uint64_t bytes);
    ~Room();
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;
    /// Passes the reservation to the caller. Returns its bytes.
    [[nodiscard]] uint64_t give_up() { return std::exchange(bytes_, 0); }

   private:
    DirectoryStore& store_;
    uint64_t bytes_;
  };

  void write(const std::filesystem::path& file, std::string_view bytes, Room& room);
  /// Names the written file and counts it. Returns false with errno.
  bool publish(NewFile& written, const std::filesystem::path& file, uint64_t bytes, Room& room);

  StoreFiles files_;
  NewFile::Until until_ = NewFile::Until::part;
  const uint64_t budget_;
  std::mutex mutex_;
  /// Usage, guarded by mutex_. Other servers may write into the directory too: it is recounted once a minute, and
  /// before a refusal.
  Usage usage_;
  uint64_t changes_ = 0;        ///< number of meshes added and removed with their files, guarded by mutex_
  uint64_t being_written_ = 0;  ///< reserved bytes, guarded by mutex_
  std::chrono::steady_clock::time_point counted_;
  std::jthread sweeper_;  ///< last member, as it uses the others
};

}  // namespace papilio::server
