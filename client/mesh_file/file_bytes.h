#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace papilio::client {

/// Error of a file that cannot be read or written: `what()` has the file, the problem and its remedy.
struct FileError : std::runtime_error {
  FileError(const std::filesystem::path& path, const std::string& what)
      : std::runtime_error(path.string() + ": " + what) {}
};

/// Returns whether the path is a folder; false also if the system reports an error, which opening the file repeats.
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

/// Reads a whole file, perhaps empty. Throws `FileError` if it is absent, a folder, unreadable, or larger than `limit`;
/// of a larger one, only slightly more than `limit` bytes are read.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, uint64_t limit);

/// Name of standard input in messages.
inline constexpr const char* standard_input_name = "standard input";
/// Reads all of standard input, as read_bytes().
[[nodiscard]] std::string read_standard_input(uint64_t limit);

/// Writes `bytes` to `path` atomically: to a temporary file in its folder, which is then renamed, so that readers find
/// the old content or the new. Follows a symbolic link. Throws `FileError` with the reason (no folder, no permission,
/// disk full, not a regular file), and then leaves no temporary file and no change. Not flushed to the disk: a power
/// failure may lose the bytes.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace papilio::client
