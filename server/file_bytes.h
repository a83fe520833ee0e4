#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace papilio::server {

/// The bytes of a file; null where it cannot be opened (errno says why) or read.
[[nodiscard]] std::shared_ptr<const std::string> read_file(const std::filesystem::path& file);

}  // namespace papilio::server
