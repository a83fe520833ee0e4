#include <algorithm>
#include <cmath>

#include "papilio/refine.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/soup.h"

// Any triangles with any parameters: the result is valid and within its budgets.

using namespace papilio;

namespace {

/// Aborts if closing gaps makes a defect, or a face without an original.
void require_no_worse(const TriangleMesh& soup, const BuildReport& exact, double gap) {
  BuildReport found;
  const Mesh closed = build_mesh(soup, &found, gap);
  fuzz::require_sound(closed);
  fuzz::require(
      found.non_manifold_edges <= exact.non_manifold_edges && found.misoriented_edges <= exact.misoriented_edges,
      "no edge is worse than before");
  fuzz::require(found.pinched_vertices <= exact.pinched_vertices, "no vertex is worse than before");
  fuzz::require(found.boundary_edges <= exact.boundary_edges, "nothing is torn open");
  fuzz::require(found.degenerate_faces == exact.degenerate_faces && found.repeated_faces == exact.repeated_faces,
                "faces stay");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::ByteSource bytes(data, size);
  fuzz::unless_refused([&] {
    Options options = fuzz::take_parameters(bytes, 3).options;
    options.face_limit = 10'000;
    const TriangleMesh soup = fuzz::take_soup(bytes);
    BuildReport exact;
    const Mesh coarse = build_mesh(soup, &exact);
    fuzz::require_sound(coarse);
    for (const double gap : {rounding_gap, 1e-2}) require_no_worse(soup, exact, gap);
    const Result result = refine(coarse, options);
    fuzz::require_sound(result.mesh);
    const uint64_t most = options.max_faces == 0 ? options.face_limit : std::min(options.max_faces, options.face_limit);
    fuzz::require(result.mesh.topology.face_count() <= most, "the budget holds");
    fuzz::require(result.levels <= options.levels, "no level was made that was not asked for");
    fuzz::require(result.error >= 0 && result.error_pixels >= 0, "errors are numbers");
    fuzz::require(
        options.simplify_hidden ||
            std::ranges::equal(coarse.positions, std::span(result.mesh.positions).first(coarse.positions.size())),
        "coarse vertices stay where they are");
  });
  return 0;
}
