#include "server/samples/samples.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "papilio/mesh.h"
#include "proto/draco_writer.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "server/file_bytes.h"
#include "server/samples/models.h"

namespace papilio::server {
namespace {

namespace fs = std::filesystem;

/// Rotates from z up, as in models.h, to y up, as in most viewers.
TriangleMesh upright(TriangleMesh mesh) {
  for (Vec3f& p : mesh.positions) p = {p.x, p.z, -p.y};
  return mesh;
}

Sample generated(const std::string& name, const TriangleMesh& triangles) {
  const Mesh mesh = build_mesh(triangles);
  return {.name = name,
          .vertices = mesh.topology.vertex_count,
          .faces = mesh.topology.face_count(),
          .draco = std::make_shared<const std::string>(
              proto::write_draco(mesh, proto::quantization_box(mesh.positions), {}))};
}

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
  });
}

Sample read_sample(const fs::path& file, const proto::Limits& limits) {
  const auto refuse = [&](const std::string& why) {
    return std::runtime_error("--samples: " + file.string() + ": " + why);
  };
  Sample sample;
  sample.name = file.stem().string();
  if (!is_name(sample.name))
    throw refuse("a sample's name has up to 64 letters, digits, points, hyphens and underscores; rename the file.");
  sample.draco = read_file(file);
  if (sample.draco == nullptr) throw refuse("cannot be read.");
  proto::Parameters unrefined;
  unrefined.options.levels = 0;
  try {
    const proto::Refinement mesh(*sample.draco, unrefined, limits);
    sample.vertices = mesh.coarse_vertices();
    sample.faces = mesh.coarse_faces();
  } catch (const proto::Problem& problem) {
    throw refuse(problem.what());
  }
  return sample;
}

}  // namespace

Samples::Samples(const std::string& folder, const proto::Limits& limits) {
  samples_.push_back(generated("knot", knot()));
  samples_.push_back(generated("mug", upright(mug())));
  samples_.push_back(generated("wheel", wheel()));
  if (folder.empty()) return;
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".drc") files.push_back(entry->path());
  if (error) throw std::runtime_error("--samples: " + folder + ": " + error.message());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    Sample sample = read_sample(file, limits);
    if (find(sample.name) != nullptr)
      throw std::runtime_error("--samples: " + file.string() +
                               ": a sample that the server makes has this name; rename the file.");
    samples_.push_back(std::move(sample));
  }
}

const Sample* Samples::find(std::string_view name) const {
  const auto found = std::ranges::find(samples_, name, &Sample::name);
  return found == samples_.end() ? nullptr : &*found;
}

}  // namespace papilio::server
