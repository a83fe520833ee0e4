#pragma once

#include <cstddef>
#include <string>

namespace papilio::bench {

inline constexpr size_t image_bytes = 4'000'000;

/// Returns the elephant of 20,000 faces as a .glb scene with an image of this many bytes; 0: without an image.
[[nodiscard]] std::string textured_scene(size_t bytes_of_image);

}  // namespace papilio::bench
