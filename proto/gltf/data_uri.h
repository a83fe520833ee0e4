#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace papilio::proto::gltf {

/// Returns whether a URI contains its data.
[[nodiscard]] bool is_data_uri(std::string_view uri);

/// Decodes the base64 data of a data URI (RFC 2397, RFC 4648); returns nothing for other encodings and damaged data.
[[nodiscard]] std::optional<std::string> decode_data_uri(std::string_view uri);

/// Encodes bytes as a data URI with the media type of `like`, or application/octet-stream if that is no data URI.
[[nodiscard]] std::string encode_data_uri(std::string_view bytes, std::string_view like);

}  // namespace papilio::proto::gltf
