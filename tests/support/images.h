#pragma once

#include <string>

// Bytes with the signatures of images. They are never decoded.

namespace papilio::test {

inline std::string png_bytes(const std::string& content) { return "\x89PNG\r\n\x1a\n" + content; }
inline std::string jpeg_bytes(const std::string& content) { return "\xff\xd8\xff" + content; }

}  // namespace papilio::test
