#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace papilio::server {

/// Returns the bytes of a regular file; null with errno if it cannot be opened or read (EISDIR for a folder).
[[nodiscard]] std::shared_ptr<const std::string> read_file(const std::filesystem::path& file);

/// Returns whether `file` is a regular file with these bytes. Reads it piece by piece, up to the first difference.
[[nodiscard]] bool file_holds(const std::filesystem::path& file, std::string_view bytes);

}  // namespace papilio::server
