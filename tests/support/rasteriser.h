#pragma once

#include <cstdint>
#include <vector>

#include "core/criteria/view_culling.h"
#include "papilio/mesh.h"

// A small software rasteriser: what a viewer would draw of a mesh, so that tests can compare pictures.

namespace papilio::test {

/// Grey, 0..1, row by row from the top.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<float> grey;  ///< [width * height]

  [[nodiscard]] float at(uint32_t x, uint32_t y) const { return grey[size_t{y} * width + x]; }
};

/// Draws the mesh as the view sees it, the viewport's size, on black: z-buffer, Lambert's law per sample from the
/// vertices' normals interpolated in perspective, summed over the view's lights and cut off at 1. Faces that are turned
/// away are not drawn, nor any that reach through the near plane. `samples` squared samples a pixel.
[[nodiscard]] Image render(const Mesh& mesh, const View& view, uint32_t samples = 2);

/// Peak signal-to-noise ratio in decibels, of images of one size; infinite where they are equal.
[[nodiscard]] double psnr(const Image& a, const Image& b);

}  // namespace papilio::test
