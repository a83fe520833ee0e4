#pragma once

#include <string>
#include <string_view>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Writes a packed model (proto/detail.md). `base_stream`: Draco stream that decodes to `detail.base`. Distances are
/// rounded up to four digits; all else is read back to the bit. Throws `Problem` result_too_large beyond 4 GiB, and
/// `std::invalid_argument` for a step or a distance that no reader takes.
[[nodiscard]] std::string write_packed(const EncodedDetail& detail, std::string_view base_stream);

/// Writes a .glb scene of one mesh without levels. `stream`: Draco stream that decodes to `decoded`.
[[nodiscard]] std::string write_plain(const TriangleMesh& decoded, std::string_view stream);

}  // namespace papilio::proto::detail
