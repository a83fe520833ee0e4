#pragma once

#include <cstdint>
#include <string_view>

namespace papilio::server {

/// Reads the line before a chunk, without its CR LF, and returns the chunk's size in bytes; a size beyond 64 bits
/// becomes the largest one. Checks and ignores extensions. Source: RFC 9112, section 7.1. Throws `Problem` bad_request
/// outside the grammar: a proxy could see another end of the line, and another request behind it.
[[nodiscard]] uint64_t chunk_size(std::string_view line);

}  // namespace papilio::server
