#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "detail/optimal_collapse.h"
#include "detail/surface_distance.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Factor between the sizes of candidates.
constexpr double ratio_of_sizes = 0.87;
constexpr size_t fewest_faces = 12;
/// Number of coded candidates: the smallest ones that reach the distance before quantization.
constexpr int coded_sizes = 4;
constexpr int fewest_bits = 6, most_bits = 18;
/// RMS distance of quantized positions along normals, a share of the grid's step.
constexpr double rms_of_step = 0.2;
constexpr uint32_t few_samples = 20'000, many_samples = 60'000;

class Simplification {
 public:
  Simplification(const TriangleMesh& original, const SimplifyOptions& options, const MeshCoder& code)
      : options_(options),
        code_(code),
        tree_(build_mesh(original).triangles()),
        box_(bounding_box(tree_.surface().positions)),
        wanted_(options.rms * box_.diagonal()),
        most_(options.largest * box_.diagonal()) {}

  std::optional<SimplifiedDetail> run() {
    std::vector<size_t> sizes;
    size_t faces = tree_.surface().triangles.size();
    while (faces >= fewest_faces) {
      sizes.push_back(faces);
      faces = static_cast<size_t>(ratio_of_sizes * static_cast<double>(faces));
    }
    const std::vector<TriangleMesh> meshes =
        collapse_to_sizes(tree_.surface(), sizes, Quadrics::memoryless, [this] { poll(); });
    // Finds the first size that is too far; distances are nearly ascending.
    const auto first_beyond = std::ranges::partition_point(
        meshes, [&](const TriangleMesh& mesh) { return is_near(distance_to(mesh, few_samples)); });
    std::optional<SimplifiedDetail> best;
    const auto count = std::min<std::ptrdiff_t>(coded_sizes, first_beyond - meshes.begin());
    for (std::ptrdiff_t i = 1; i <= count; ++i) {
      std::optional<SimplifiedDetail> made = with_fewest_bits(*(first_beyond - i));
      if (made && (!best || made->bytes < best->bytes)) best = std::move(made);
    }
    return best;
  }

 private:
  void poll() const {
    if (options_.cancelled && options_.cancelled()) throw Error(Fault::cancelled, "Simplification was cancelled.");
  }

  [[nodiscard]] SurfaceDistance distance_to(const TriangleMesh& mesh, uint32_t samples) const {
    poll();
    const SurfaceTree surface(mesh);
    SurfaceDistance distance = surface_distance(tree_, surface, samples);
    if (is_near(distance)) distance.largest = std::max(distance.largest, vertex_distance(tree_, surface));
    return distance;
  }

  [[nodiscard]] bool is_near(const SurfaceDistance& distance) const {
    return distance.rms <= wanted_ && distance.largest <= most_;
  }

  [[nodiscard]] std::optional<SimplifiedDetail> with_fewest_bits(const TriangleMesh& mesh) const {
    const Vec3d size = to_double(box_.max) - to_double(box_.min);
    const double longest = std::max({size.x, size.y, size.z});
    int bits = fewest_bits;
    while (bits < most_bits && rms_of_step * longest / std::exp2(bits) > wanted_) ++bits;
    for (; bits <= most_bits; ++bits) {
      poll();
      CodedBase coded = code_(mesh, bits);
      if (coded.triangles.triangles.empty()) continue;
      const SurfaceDistance distance = distance_to(coded.triangles, many_samples);
      if (!is_near(distance)) continue;
      const double diagonal = box_.diagonal();
      return SimplifiedDetail{
          std::move(coded.triangles), {distance.rms / diagonal, distance.largest / diagonal}, coded.bytes, bits};
    }
    return std::nullopt;
  }

  const SimplifyOptions& options_;
  const MeshCoder& code_;
  SurfaceTree tree_;  // original
  Box box_;
  double wanted_, most_;  // RMS and largest distance, in the mesh's unit
};

}  // namespace

std::optional<SimplifiedDetail> simplify_detail(const TriangleMesh& original, const SimplifyOptions& options,
                                                const MeshCoder& code) {
  if (!(options.rms >= 1e-6 && options.rms <= 0.1))
    throw Error(Fault::bad_option, "The distance must be 1e-6 to 0.1 of the diagonal.", "rms");
  if (!(options.largest > 0)) throw Error(Fault::bad_option, "The largest distance must be above 0.", "largest");
  return Simplification(original, options, code).run();
}

}  // namespace papilio
