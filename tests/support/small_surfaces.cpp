#include "tests/support/small_surfaces.h"

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>

namespace papilio::test {
namespace {

using Faces = std::vector<Triangle>;

/// Returns the face to the left of each directed edge, with its corner.
using Sides = std::map<std::array<uint32_t, 2>, std::array<size_t, 2>>;

Sides sides_of(const Faces& faces) {
  Sides sides;
  for (size_t f = 0; f < faces.size(); ++f)
    for (size_t i = 0; i < 3; ++i) sides[{faces[f][i], faces[f][(i + 1) % 3]}] = {f, i};
  return sides;
}

/// Returns the faces in the order and numbering of a traversal from a corner.
Faces numbered_from(const Faces& faces, const Sides& sides, size_t face, size_t corner) {
  std::map<uint32_t, uint32_t> number;
  std::vector<bool> met(faces.size(), false);
  std::vector<std::array<size_t, 2>> queue{{face, corner}};
  met[face] = true;
  Faces out;
  for (size_t at = 0; at < queue.size(); ++at) {
    const auto [f, first] = queue[at];
    Triangle& made = out.emplace_back();
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t v = faces[f][(first + i) % 3];
      made[i] = number.try_emplace(v, static_cast<uint32_t>(number.size())).first->second;
      const auto beyond = sides.find({faces[f][(first + i + 1) % 3], v});
      if (beyond == sides.end() || met[beyond->second[0]]) continue;
      met[beyond->second[0]] = true;
      queue.push_back(beyond->second);
    }
  }
  return out;
}

/// Returns a canonical form, equal for surfaces that differ only by numbering.
Faces canonical(const Faces& faces) {
  const Sides sides = sides_of(faces);
  Faces least;
  for (size_t f = 0; f < faces.size(); ++f)
    for (size_t i = 0; i < 3; ++i) {
      Faces numbered = numbered_from(faces, sides, f, i);
      if (least.empty() || numbered < least) least = std::move(numbered);
    }
  return least;
}

uint32_t vertex_count(const Faces& faces) {
  uint32_t most = 0;
  for (const Triangle& t : faces) most = std::max({most, t[0], t[1], t[2]});
  return most + 1;
}

/// Returns the surfaces with one more triangle.
void grow(const Faces& faces, std::set<Faces>& grown) {
  const Sides sides = sides_of(faces);
  const uint32_t vertices = vertex_count(faces);
  for (const auto& [side, where] : sides) {
    const auto [a, b] = side;
    if (sides.contains({b, a})) continue;
    for (uint32_t apex = 0; apex <= vertices; ++apex) {
      if (apex == a || apex == b || sides.contains({a, apex}) || sides.contains({apex, b})) continue;
      Faces more = faces;
      more.push_back({b, a, apex});
      grown.insert(canonical(more));
    }
  }
}

}  // namespace

std::vector<TriangleMesh> small_surfaces(uint32_t triangles) {
  std::set<Faces> all{{{0, 1, 2}}};
  for (uint32_t n = 1; n < triangles; ++n) {
    std::set<Faces> grown;
    for (const Faces& faces : all) grow(faces, grown);
    all = std::move(grown);
  }
  std::mt19937 random(8);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  std::vector<TriangleMesh> meshes;
  for (const Faces& faces : all) {
    TriangleMesh& mesh = meshes.emplace_back();
    mesh.triangles.assign(faces.begin(), faces.end());
    for (uint32_t v = 0; v < vertex_count(faces); ++v)
      mesh.positions.push_back({coordinate(random), coordinate(random), coordinate(random)});
  }
  return meshes;
}

}  // namespace papilio::test
