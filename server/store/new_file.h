#pragma once

#include <filesystem>
#include <string_view>

namespace papilio::server {

/// File that is named only once it is complete. Until then it has no name (O_TMPFILE), so that a killed process leaves
/// nothing behind; or, if the file system does not support that, the name of a part file, locked by its writer. Not
/// thread-safe.
class NewFile {
 public:
  /// State until publication. `unnamed` becomes `part` in a folder whose file system has no unnamed files.
  enum class Until { unnamed, part };

  /// Creates the file in a folder; is_open() tells whether it succeeded, else errno has the reason.
  NewFile(std::filesystem::path folder, Until until);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  /// Appends bytes, and waits until they are on the disk. Returns false with errno.
  [[nodiscard]] bool write_and_sync(std::string_view bytes) const;
  /// Names the file, in its folder. Replaces a file or an empty folder of that name. Returns false with errno.
  [[nodiscard]] bool publish(const std::filesystem::path& file);

 private:
  [[nodiscard]] bool link_as(const std::filesystem::path& file) const;

  const std::filesystem::path folder_;
  std::filesystem::path part_;  ///< name before publish(); empty: none
  int fd_ = -1;
};

/// Returns whether the folder supports unnamed files that are named later. Creates one and removes it.
[[nodiscard]] NewFile::Until supported_until(const std::filesystem::path& folder);

/// Removes a part file whose writer was interrupted: not written to for ten minutes, and not locked. Ignores files of
/// other names.
void remove_if_abandoned(const std::filesystem::path& file);

}  // namespace papilio::server
