#pragma once

#include <filesystem>
#include <string>

namespace papilio::client {

/// Returns the bytes of a file by the relative URI in `document`, in its folder or below. Throws `FileError`.
[[nodiscard]] std::string read_beside(const std::filesystem::path& document, const std::string& uri);

}  // namespace papilio::client
