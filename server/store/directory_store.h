#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>

#include "server/store/mesh_store.h"

namespace papilio::server {

/// Keeps each mesh in a file of its own, DIRECTORY/ab/abcd....drc. A file is written under a temporary name, synced and
/// renamed, so that a mesh is there whole or not at all, whatever ends the process. Several servers may share the
/// directory. A file whose content is not what its name says is taken away and counts as absent.
class DirectoryStore final : public MeshStore {
 public:
  /// Makes the directory if need be, and sweeps out what interrupted writes left. Throws std::runtime_error.
  DirectoryStore(std::filesystem::path directory, uint64_t budget);

  bool put(const std::string& id, std::string_view bytes) override;
  bool contains(const std::string& id) override;
  Bytes get(const std::string& id) override;
  bool remove(const std::string& id) override;
  [[nodiscard]] std::string_view kind() const override { return "directory"; }
  [[nodiscard]] std::optional<Usage> usage() override;

 private:
  [[nodiscard]] std::filesystem::path file_of(const std::string& id) const;
  void count_files();
  void make_room(uint64_t bytes);

  const std::filesystem::path directory_;
  const uint64_t budget_;
  std::mutex mutex_;
  /// Guarded by mutex_. Others may write into the directory too: it is counted anew once a minute, and before a
  /// refusal.
  Usage usage_;
  std::chrono::steady_clock::time_point counted_;
};

}  // namespace papilio::server
