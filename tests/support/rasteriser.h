#pragma once

#include <cstdint>
#include <vector>

#include "core/criteria/view_culling.h"
#include "papilio/mesh.h"

// A small software rasteriser for the comparison of pictures.

namespace papilio::test {

/// Grey, 0..1, row by row from the top.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<float> grey;  ///< [width * height]

  [[nodiscard]] float at(uint32_t x, uint32_t y) const { return grey[size_t{y} * width + x]; }
};

/// Returns a view of the whole mesh from above and to the right of its front, without lights. `width`, `height`: in
/// pixels.
[[nodiscard]] View overview(const Mesh& mesh, double width, double height);

/// Draws the mesh in the view at the viewport's size on black, with a z-buffer. Shading per sample: Lambert's law with
/// perspective-correct vertex normals, summed over the view's lights and clamped to 1. Back faces and faces that cross
/// the near plane are not drawn. `samples` squared samples per pixel.
[[nodiscard]] Image render(const Mesh& mesh, const View& view, uint32_t samples = 2);

/// Returns the peak signal-to-noise ratio of images of one size, in decibels; infinity if they are equal.
[[nodiscard]] double psnr(const Image& a, const Image& b);

}  // namespace papilio::test
