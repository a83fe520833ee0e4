#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace papilio::server {

/// The bytes of a regular file; null with errno where it cannot be opened or read (EISDIR for a folder).
[[nodiscard]] std::shared_ptr<const std::string> read_file(const std::filesystem::path& file);

/// Whether it is a regular file of just these bytes. It is read piece by piece, up to the first difference.
[[nodiscard]] bool file_holds(const std::filesystem::path& file, std::string_view bytes);

}  // namespace papilio::server
