#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <string>

#include "server/store/mesh_store.h"

namespace papilio::server {

/// Files below the directory of a store: DIRECTORY/ab/abcd....drc, and the part files of writers. Other files are
/// ignored. An unreadable folder is skipped, with one warning. Thread-safe. Functions throw
/// std::filesystem::filesystem_error if the directory itself cannot be read.
class StoreFiles {
 public:
  explicit StoreFiles(std::filesystem::path directory) : directory_(std::move(directory)) {}

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  [[nodiscard]] std::filesystem::path file_of(const std::string& id) const;

  /// Returns the number of meshes, and their bytes.
  [[nodiscard]] MeshStore::Usage count();
  /// Removes the part files of interrupted writers.
  void remove_abandoned();

 private:
  using Visit = std::function<void(const std::filesystem::directory_entry& file)>;
  /// Visits the files in the directory and in its folders.
  void visit(const Visit& visit_file);
  void visit_folder(const std::filesystem::path& folder, const Visit& visit_file);
  void warn_once(const std::filesystem::path& folder, const std::string& reason);

  const std::filesystem::path directory_;
  std::mutex mutex_;
  std::set<std::filesystem::path> warned_;  ///< folders already warned of, guarded by mutex_
};

}  // namespace papilio::server
