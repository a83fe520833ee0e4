#pragma once

#include <filesystem>
#include <string>

namespace papilio::client {

/// Returns the bytes of a file that `document` names by a relative URI, in its folder or below. Throws `FileError`.
[[nodiscard]] std::string read_beside(const std::filesystem::path& document, const std::string& uri);

}  // namespace papilio::client
