#include "proto/detail/pack.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "proto/detail/base_coder.h"
#include "proto/detail/distance_search.h"
#include "proto/detail/encodings.h"
#include "proto/detail/packed_normals.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/detail/plain_original.h"
#include "proto/detail/used_materials.h"
#include "proto/error_translation.h"
#include "proto/gltf/material_attribute.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::detail {
namespace {

/// Typical largest distance of the measured models, in RMS distances: start of a search for it.
constexpr double largest_of_rms = 8;
/// Bound of a simplified mesh's largest distance, in RMS distances: about what other simplifiers leave.
constexpr double most_of_rms = 16;
/// Lower bound of the faces of an original to be simplified: with fewer, each may be a feature, and few bytes are
/// saved.
constexpr size_t fewest_to_simplify = 5000;
/// Upper bounds of the area that is turned over, a share of the whole. Scans have up to .003 at RMS distances of at
/// most .0005, in small faces round noise: up to .02 of all faces. Of two plates with thin steps .017 and .08 were
/// turned; they stayed .013 and .026 of the diagonal from the original. With attributes small faces turn at borders and
/// seams, within the surface: up to .019 of an intact model.
constexpr double most_folded = 0.01, most_folded_with_attributes = 0.03;
/// Start of a search for a number of bytes, an RMS distance, and the power of it that the bytes approximately follow.
constexpr double first_for_bytes = 1e-3, power_of_bytes = -0.8;

class Packer {
 public:
  Packer(const TriangleMesh& original, gltf::Materials materials, const PackOptions& options)
      : options_(options), mesh_(build_mesh(original, nullptr, rounding_gap)), materials_(std::move(materials)) {}

  Packed run() {
    packed_.wanted_rms = has_other_goal() ? 0 : options_.rms;
    for (const gltf::Image& image : materials_.images) packed_.image_bytes += image.bytes.size();
    try {
      encode();
    } catch (const Error& error) {
      if (error.fault() != Fault::bad_surface) throw;
      packed_.reason = error.what();
    }
    plain_ = plain_original(std::move(mesh_));
    if (options_.bytes > 0)
      choose_within_bytes();
    else if (options_.largest > 0)
      choose_within_largest();
    else
      choose_at_rms();
    return std::move(packed_);
  }

 private:
  [[nodiscard]] bool has_other_goal() const { return options_.bytes > 0 || options_.largest > 0; }

  void poll() const {
    if (options_.cancelled && options_.cancelled()) throw Error(Fault::cancelled, "Packing was cancelled.");
  }

  /// Encodes for the goal, and keeps the best encoding.
  void encode() {
    const TriangleMesh surface = mesh_.triangles();
    Encodings encodings(surface, materials_, options_, has_other_goal() ? most_probes : 1);
    const auto encode_round = [&](std::span<const double> distances) {
      std::vector<double> values;
      for (Encoding& made : encodings.encode(distances)) {
        values.push_back(std::max(value_of(made), std::numeric_limits<double>::min()));
        if (is_torn(made))
          packed_.reason =
              "In a packed model " + format_rounded(100 * made.folded_area) + " % of the area would be turned over.";
        else if (!best_ || is_better(made, *best_))
          best_ = std::move(made);
      }
      packed_.encodings = encodings.count();
      return values;
    };
    if (options_.bytes > 0)
      (void)search_distance(
          {.value = static_cast<double>(options_.bytes), .power = power_of_bytes, .first = first_for_bytes},
          encode_round);
    else if (options_.largest > 0)
      (void)search_distance({.value = options_.largest, .power = 1, .first = options_.largest / largest_of_rms},
                            encode_round);
    else
      (void)encode_round(std::span(&options_.rms, 1));
  }

  /// Returns whether too much is turned over for the surface to look like the original, near as it may be.
  [[nodiscard]] bool is_torn(const Encoding& made) const {
    return made.folded_area > (mesh_.attributes.attributes.empty() ? most_folded : most_folded_with_attributes);
  }

  /// Returns the value that is compared with the goal of a search.
  [[nodiscard]] double value_of(const Encoding& made) const {
    return options_.bytes > 0 ? static_cast<double>(made.glb.size()) : reach_of(made.model).largest;
  }
  [[nodiscard]] bool fits(const Encoding& made) const {
    return value_of(made) <= (options_.bytes > 0 ? static_cast<double>(options_.bytes) : options_.largest);
  }
  /// Returns whether one encoding is better than another: the finest or smallest within the goal, else the nearest.
  [[nodiscard]] bool is_better(const Encoding& made, const Encoding& other) const {
    if (fits(made) != fits(other)) return fits(made);
    if (!fits(made)) return value_of(made) < value_of(other);
    return options_.bytes > 0 ? reach_of(made.model).rms < reach_of(other.model).rms
                              : made.glb.size() < other.glb.size();
  }

  void choose_at_rms() {
    const double reached = best_ ? reach_of(best_->model).rms : 0;
    PlainDraco plain = plain_at(std::max(options_.rms, reached), compared());
    if (options_.simplifies && plain_.mesh.attributes.empty() &&
        plain_.mesh.topology.face_count() >= fewest_to_simplify) {
      packed_.simplified = write_simplified_draco(
          plain_.mesh.triangles(),
          {.rms = options_.rms, .largest = most_of_simplified(), .cancelled = options_.cancelled}, plain_.normals,
          materials_);
      if (packed_.simplified && is_smallest(*packed_.simplified, plain)) return take_simplified(plain);
    }
    if (best_ && best_->glb.size() < plain.glb.size()) return take_packed(plain);
    if (best_)
      packed_.reason = "At an RMS distance of " + format_rounded(std::max(options_.rms, reached)) +
                       " of the diagonal plain Draco takes " + std::to_string(plain.glb.size()) +
                       " bytes, and a packed model " + std::to_string(best_->glb.size()) + ".";
    take_plain(reached > options_.rms || plain_.compared ? plain_at(options_.rms, plain_.mesh) : std::move(plain));
  }

  /// Returns the bound of a simplified mesh's largest distance: it loses small distant parts only if the packed model
  /// does.
  [[nodiscard]] double most_of_simplified() const {
    const bool reaches = best_ && reach_of(best_->model).rms <= options_.rms;
    return std::max(most_of_rms * options_.rms, reaches ? reach_of(best_->model).largest : 0);
  }

  /// Returns whether a simplified mesh is the smallest file.
  [[nodiscard]] bool is_smallest(const SimplifiedDraco& simplified, const PlainDraco& plain) const {
    const uint64_t bytes = simplified.bytes;
    const bool is_packed_farther = best_ && reach_of(best_->model).rms > options_.rms;
    return bytes < plain.glb.size() && (!best_ || is_packed_farther || bytes < best_->glb.size());
  }

  void take_simplified(const PlainDraco& plain) {
    SimplifiedDraco& simplified = *packed_.simplified;
    if (best_)
      packed_.reason = "At an RMS distance of " + format_rounded(options_.rms) +
                       " of the diagonal a simplified mesh of " + std::to_string(simplified.faces) + " faces takes " +
                       std::to_string(simplified.bytes) + " bytes as Draco, and a packed model " +
                       std::to_string(best_->glb.size()) +
                       (reach_of(best_->model).rms > options_.rms ? " without reaching it." : ".");
    note(plain);
    packed_.glb = std::move(simplified.glb);
  }

  void choose_within_largest() {
    PlainDraco plain = plain_within(options_.largest, compared());
    if (best_ && fits(*best_) && best_->glb.size() < plain.glb.size()) return take_packed(plain);
    if (best_ && !fits(*best_))
      packed_.reason = "No packed model was found that is nowhere farther than " + format_rounded(options_.largest) +
                       " of the diagonal from the original.";
    else if (best_)
      packed_.reason = "With no distance above " + format_rounded(options_.largest) +
                       " of the diagonal plain Draco takes " + std::to_string(plain.glb.size()) +
                       " bytes, and a packed model " + std::to_string(best_->glb.size()) + ".";
    take_plain(plain_.compared ? plain_within(options_.largest, plain_.mesh) : std::move(plain));
  }

  void choose_within_bytes() {
    std::optional<PlainDraco> plain = finest_plain();
    const bool is_fit = best_ && fits(*best_);
    if (is_fit && (!plain || reach_of(best_->model).rms < plain->rms))
      return take_packed(plain_at(reach_of(best_->model).rms, compared()));
    if (!plain) refuse_bytes();
    if (is_fit)
      packed_.reason = "In " + std::to_string(options_.bytes) + " bytes plain Draco has an RMS distance of " +
                       format_rounded(plain->rms) + " of the diagonal, and a packed model " +
                       format_rounded(reach_of(best_->model).rms) + ".";
    else if (best_)
      packed_.reason = "No packed model of at most " + std::to_string(options_.bytes) + " bytes was found.";
    take_plain(std::move(*plain));
  }

  [[noreturn]] void refuse_bytes() const {
    size_t fewest = plain_of(fewest_position_bits, plain_.mesh).glb.size();
    if (best_) fewest = std::min(fewest, best_->glb.size());
    throw Problem(Code::result_too_large, "The smallest file found has " + std::to_string(fewest) +
                                              " bytes, more than " + std::to_string(options_.bytes) + ". Allow more.");
  }

  void take_packed(const PlainDraco& plain) {
    note(plain);
    packed_.folds = best_->folds;
    packed_.parted = best_->parted;
    packed_.glb = std::move(best_->glb);
    packed_.model = std::move(best_->model);
  }

  void take_plain(PlainDraco plain) {
    note(plain);
    packed_.glb = std::move(plain.glb);
  }

  void note(const PlainDraco& plain) {
    packed_.plain_bytes = plain.glb.size();
    packed_.plain_bits = plain.position_bits;
    packed_.plain_rms = plain.rms;
    packed_.plain_has_normals = plain_.has_normals;
  }

  /// Returns the mesh that packed models are compared with; it has normals only if packed models reproduce them.
  [[nodiscard]] const Mesh& compared() const { return plain_.compared ? *plain_.compared : plain_.mesh; }
  [[nodiscard]] PlainOptions plain_options(const Mesh& mesh) const {
    const bool has_normals = plain_.has_normals && &mesh == &plain_.mesh;
    return {.poll = [this] { poll(); },
            .materials = &materials_,
            .normals = has_normals ? NormalStyle::absent : plain_.normals};
  }
  [[nodiscard]] PlainDraco plain_at(double rms, const Mesh& mesh) const {
    return write_plain_draco(mesh, rms, plain_options(mesh));
  }
  [[nodiscard]] PlainDraco plain_of(int bits, const Mesh& mesh) const {
    return write_plain_grid(mesh, bits, plain_options(mesh));
  }
  /// Returns the file with the fewest bits that moves no position by more than `largest`, a share of the diagonal.
  [[nodiscard]] PlainDraco plain_within(double largest, const Mesh& mesh) const {
    const Box box = bounding_box(mesh.positions);
    int bits = fewest_position_bits;
    while (bits < most_position_bits && tight_grid_distance(box, bits) > largest * box.diagonal()) ++bits;
    return plain_of(bits, mesh);
  }
  /// Returns the file with the most bits within the allowed bytes.
  [[nodiscard]] std::optional<PlainDraco> finest_plain() const {
    std::optional<PlainDraco> finest;
    for (int low = fewest_position_bits, high = most_position_bits; low <= high;) {
      const int bits = (low + high) / 2;
      PlainDraco plain = plain_of(bits, plain_.mesh);
      if (plain.glb.size() > options_.bytes) {
        high = bits - 1;
      } else {
        finest = std::move(plain);
        low = bits + 1;
      }
    }
    return finest;
  }

  const PackOptions& options_;
  Mesh mesh_;  ///< moved to `plain_` once it is encoded
  PlainOriginal plain_;
  gltf::Materials materials_;
  std::optional<Encoding> best_;
  Packed packed_;
};

bool has_several(const std::vector<uint32_t>& of_triangle) {
  return std::ranges::adjacent_find(of_triangle, std::ranges::not_equal_to{}) != of_triangle.end();
}

}  // namespace

Packed pack(const gltf::MaterialMesh& original, const PackOptions& options) {
  gltf::MaterialMesh surface;
  surface.materials = used_materials(original.materials);
  surface.mesh.positions = original.mesh.positions;
  surface.mesh.triangles = original.mesh.triangles;
  if (std::optional<Attribute> texcoords = texcoords_to_pack(original.mesh))
    surface.mesh.attributes.push_back(std::move(*texcoords));
  else
    for (gltf::Image& image : surface.materials.images) image.bytes.clear();  // no texture can be shown
  if (std::optional<Attribute> colours = colours_to_pack(original.mesh))
    surface.mesh.attributes.push_back(std::move(*colours));
  std::optional<Attribute> normals = normals_to_pack(original.mesh);
  if (normals) surface.mesh.attributes.push_back(std::move(*normals));
  if (has_several(surface.materials.of_triangle)) {
    gltf::add_material_attribute(surface);
    if (normals) std::swap(surface.mesh.attributes.back(), surface.mesh.attributes[surface.mesh.attributes.size() - 2]);
  }
  return translate_errors([&] { return Packer(surface.mesh, std::move(surface.materials), options).run(); });
}

Packed pack(const TriangleMesh& original, const PackOptions& options) {
  const TriangleMesh surface{original.positions, original.triangles};
  return translate_errors([&] { return Packer(surface, {}, options).run(); });
}

}  // namespace papilio::proto::detail
