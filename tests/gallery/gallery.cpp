// gallery FOLDER MODEL...: draws refined models for visual inspection. FOLDER/NAME.png shows the coarse mesh, the plain
// scheme and the shape rules: above with flat shading, below with normals that are split at creases. Also prints a row
// of figures for each model. gallery --sheet FILE MODEL...: draws all models into one picture, one row each, with flat
// shading.

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/lib/compare.h"
#include "client/lib/mesh_stream.h"
#include "papilio/refine.h"
#include "proto/refinement.h"
#include "tests/gallery/harm.h"
#include "tests/support/rasteriser.h"

namespace papilio::test {
namespace {

constexpr uint32_t side = 360;  // pixels of one picture
constexpr uint64_t most_faces = 400'000;

View view_of(const Mesh& mesh) {
  View view = overview(mesh, side, side);
  view.lights = {Vec3d{0.5, 0.9, 0.8}};
  return view;
}

/// Returns the mesh with separate vertices for each face, for flat shading.
Mesh faceted(const Mesh& mesh) {
  Mesh out;
  const uint32_t corners = mesh.topology.half_edge_count();
  out.topology.vertex_count = corners;
  for (uint32_t h = 0; h < corners; ++h) {
    out.topology.origin.push_back(h);
    out.positions.push_back(mesh.positions[mesh.topology.origin[h]]);
  }
  return out;
}

/// Returns the mesh with a vertex for each normal: smooth, split at creases.
Mesh parted_at_creases(Mesh mesh) {
  mesh.attributes = {};
  add_normals(mesh);
  Mesh out;
  out.topology.vertex_count = mesh.attributes.point_count;
  out.topology.origin = mesh.attributes.point;
  out.positions.resize(mesh.attributes.point_count);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    out.positions[mesh.attributes.point[h]] = mesh.positions[mesh.topology.origin[h]];
  return out;
}

/// Grid of pictures.
class Sheet {
 public:
  Sheet(uint32_t columns, uint32_t rows)
      : width_(columns * side), height_(rows * side), grey_(size_t{width_} * height_) {}

  void put(uint32_t column, uint32_t row, const Image& image) {
    for (uint32_t y = 0; y < side; ++y)
      for (uint32_t x = 0; x < side; ++x)
        grey_[(size_t{row} * side + y) * width_ + column * side + x] = shade_of(image.at(x, y));
  }
  /// Brightness of the pixels; white in the background.
  [[nodiscard]] static uint8_t shade_of(float light) {
    return light == 0 ? 255 : static_cast<uint8_t>(std::lround(25 + 205 * light));
  }
  void write(const std::filesystem::path& file) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width_;
    image.height = height_;
    image.format = PNG_FORMAT_GRAY;
    if (png_image_write_to_file(&image, file.c_str(), 0, grey_.data(), 0, nullptr) == 0)
      throw std::runtime_error(file.string() + ": " + static_cast<const char*>(image.message));
  }

 private:
  uint32_t width_, height_;
  std::vector<uint8_t> grey_;
};

struct Model {
  std::string name;
  int levels = 3;
  Mesh coarse, plain;
  Result ours;
};

Model refine_both(const std::filesystem::path& file) {
  Model model;
  model.name = file.filename().string();
  model.coarse = build_mesh(client::triangles_of(client::read_mesh({file})), nullptr, rounding_gap);
  while (model.levels > 1 && (uint64_t{model.coarse.topology.face_count()} << (2 * model.levels)) > most_faces)
    --model.levels;
  model.plain = refine(model.coarse, {.levels = model.levels, .shape = Shape::plain}).mesh;
  model.ours = refine(model.coarse, {.levels = model.levels});
  return model;
}

void show(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const Model model = refine_both(file);
  const View view = view_of(model.coarse);
  Sheet sheet(3, 2);
  uint32_t column = 0;
  for (const Mesh* mesh : {&model.coarse, &model.plain, &model.ours.mesh}) {
    sheet.put(column, 0, render(faceted(*mesh), view));
    sheet.put(column++, 1, render(parted_at_creases(*mesh), view));
  }
  sheet.write(folder / (file.stem().string() + ".png"));

  const Harm before = harm_of(model.coarse, model.plain, model.levels);
  const Harm now = harm_of(model.coarse, model.ours.mesh, model.levels);
  std::printf("%-28s %7u %6u %6u  %6.3f %6.3f  %7.4f %7.4f  %7.4f  %s\n", model.name.c_str(),
              model.coarse.topology.face_count(), before.folds, now.folds, 100 * before.overshoot, 100 * now.overshoot,
              100 * before.distance, 100 * now.distance, 100 * rms_distance(model.ours.mesh, model.plain),
              proto::shape_text(model.ours.shape).c_str());
}

void draw_sheet(const std::filesystem::path& to, const std::vector<std::string>& files) {
  Sheet sheet(3, static_cast<uint32_t>(files.size()));
  uint32_t row = 0;
  for (const std::string& file : files) {
    const Model model = refine_both(file);
    uint32_t column = 0;
    for (const Mesh* mesh : {&model.coarse, &model.plain, &model.ours.mesh})
      sheet.put(column++, row, render(faceted(*mesh), view_of(model.coarse)));
    ++row;
  }
  sheet.write(to);
}

/// Skips models that cannot be read. Returns whether all were read.
bool show_all(const std::string& folder, const std::vector<std::string>& files) {
  std::filesystem::create_directories(folder);
  std::printf("%-28s %7s %13s  %13s  %15s  %7s  %s\n", "% of the diagonal; plain, ours", "faces", "folds", "overshoot",
              "RMS to coarse", "between", "taken for");
  bool is_good = true;
  for (const std::string& file : files) {
    try {
      show(folder, file);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      is_good = false;
    }
    std::fflush(stdout);
  }
  return is_good;
}

}  // namespace
}  // namespace papilio::test

int main(int argument_count, char** arguments) try {
  std::vector<std::string> words(arguments + 1, arguments + argument_count);
  const bool is_sheet = !words.empty() && words[0] == "--sheet";
  if (is_sheet) words.erase(words.begin());
  if (words.size() < 2) throw std::invalid_argument("gallery takes a folder, or --sheet and a file, and models");
  const std::vector<std::string> files(words.begin() + 1, words.end());
  if (!is_sheet) return papilio::test::show_all(words[0], files) ? 0 : 1;
  papilio::test::draw_sheet(words[0], files);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "gallery: %s\n", error.what());
  return 1;
}
