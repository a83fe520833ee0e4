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

/// Keeps each mesh in a file of its own, DIRECTORY/ab/abcd....drc. A file gets its name once it is written and synced,
/// so that a mesh is there whole or not at all, whatever ends the process. Several servers may share the directory. A
/// file whose content is not what its name says, or a folder in its place, is an absent mesh to `get`; `put` replaces
/// it. Files of other names are left alone. A directory that cannot be read is store_unavailable, not an absence.
class DirectoryStore final : public MeshStore {
 public:
  static constexpr std::chrono::minutes default_sweep_interval{10};

  /// Makes the directory if need be. Removes what interrupted writes have left, now and once an interval. Throws
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
  /// The size of the file of a mesh; none where there is no file. Throws `Problem` where that cannot be told.
  [[nodiscard]] static std::optional<uint64_t> size_of(const std::filesystem::path& file);
  /// Throws std::filesystem::filesystem_error where the directory cannot be read.
  void count_files();
  /// False when there is no room, or the count is too old to know.
  [[nodiscard]] bool reserve(uint64_t bytes);
  /// Until a stop is requested.
  void sweep_at_intervals(const std::stop_token& stop, std::chrono::milliseconds interval);

  /// Room for a mesh while it is written, so that meshes written at once cannot pass the budget together. Throws
  /// `Problem` store_full.
  class Room {
   public:
    Room(DirectoryStore& store, uint64_t bytes);
    ~Room();
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;
    /// It is the caller's from now on: how much it is.
    [[nodiscard]] uint64_t give_up() { return std::exchange(bytes_, 0); }

   private:
    DirectoryStore& store_;
    uint64_t bytes_;
  };

  void write(const std::filesystem::path& file, std::string_view bytes, Room& room);
  /// Gives the written file its name and counts it; false with errno.
  bool publish(NewFile& written, const std::filesystem::path& file, uint64_t bytes, Room& room);

  StoreFiles files_;
  NewFile::Until until_ = NewFile::Until::part;
  const uint64_t budget_;
  std::mutex mutex_;
  /// Guarded by mutex_. Others may write into the directory too: it is counted anew once a minute, and before a
  /// refusal.
  Usage usage_;
  uint64_t changes_ = 0;        ///< guarded by mutex_: meshes put and removed so far, their files with them
  uint64_t being_written_ = 0;  ///< guarded by mutex_
  std::chrono::steady_clock::time_point counted_;
  std::jthread sweeper_;  ///< last: it uses the others
};

}  // namespace papilio::server
