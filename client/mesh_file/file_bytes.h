#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace papilio::client {

/// A file that cannot be read or written: `what()` names the file, says what is wrong and what to do about
/// it.
struct FileError : std::runtime_error {
  FileError(const std::filesystem::path& path, const std::string& what)
      : std::runtime_error(path.string() + ": " + what) {}
};

/// False also where the system does not say: opening the file then says why.
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

/// The whole file. Throws `FileError` if it is absent, a folder, cannot be read, or holds more than `limit`
/// bytes; of a larger one no more than `limit` bytes and a little are read. An empty file gives an empty
/// string.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, uint64_t limit);

/// What standard input is called in messages.
inline constexpr const char* standard_input_name = "standard input";
/// All of standard input, as `read_bytes`.
[[nodiscard]] std::string read_standard_input(uint64_t limit);

/// Puts `bytes` at `path`, all or nothing: they go to a temporary file in the same folder, which is then
/// renamed, so that whoever reads `path` finds the old content or the new. A symbolic link is followed.
/// Throws `FileError` with the reason (no folder, no permission, disk full, not a regular file), and leaves
/// neither a temporary file nor a change behind. Not flushed to the disk: a power cut may lose it.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace papilio::client
