#pragma once

#include <filesystem>
#include <string_view>

namespace papilio::server {

/// A file that has its name only once it is whole. Until then it has none (O_TMPFILE), so that nothing is left of it
/// when the process is killed; or, where the file system cannot do that, the name of a part file, locked by its writer.
/// Not for several threads at once.
class NewFile {
 public:
  /// What it is until it is published. `unnamed` is `part` in a folder whose file system has no unnamed files.
  enum class Until { unnamed, part };

  /// `is_open` says whether it could be made in the folder; else errno has the reason.
  NewFile(std::filesystem::path folder, Until until);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  /// Appends, and waits until the disk has it. False with errno.
  [[nodiscard]] bool write_and_sync(std::string_view bytes) const;
  /// Gives it its name, in its folder. A file or an empty folder of that name is replaced. False with errno.
  [[nodiscard]] bool publish(const std::filesystem::path& file);

 private:
  [[nodiscard]] bool link_as(const std::filesystem::path& file) const;

  const std::filesystem::path folder_;
  std::filesystem::path part_;  ///< the name it has before `publish`; empty: none
  int fd_ = -1;
};

/// Whether an unnamed file can be made in the folder and given a name: one is, and is removed.
[[nodiscard]] NewFile::Until supported_until(const std::filesystem::path& folder);

/// Removes a part file whose writer was interrupted: not written to for ten minutes, and locked by nobody. Files of
/// other names are left alone.
void remove_if_abandoned(const std::filesystem::path& file);

}  // namespace papilio::server
