#include "tests/support/packed_levels.h"

#include "core/detail/base_attributes.h"
#include "core/detail/base_curves.h"
#include "core/detail/base_points.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/encode_values.h"
#include "core/detail/sharp_curves.h"

namespace papilio::test {

DetailSource pack_levels(const TriangleMesh& triangles, const PackedLevels& options) {
  Mesh mesh = build_mesh(triangles);
  mark_sharp_curves(mesh);
  const OriginalSurface original(std::move(mesh));
  CollapseSequence sequence(original.mesh());
  sequence.collapse_to(options.base_faces);
  const BaseMesh base = sequence.base();
  const LiftedBase lifted =
      lift_base(sequence, base, {.triangles = points_of_base(base, original.mesh())}, original, options.levels, {});
  const ResidualFit fit(original, lifted.mesh.positions,
                        place_on_original(original, lifted, options.levels, {.last = options.step}, {}), {});
  const PieceOrder order(lifted.mesh);
  return {{lifted.mesh.triangles(), encode_base_curves(lifted.mesh.topology)},
          encode_pieces(fit, order, options.piece_bytes, [&](std::span<const uint32_t> piece_counts) {
            if (!has_values(lifted.mesh.attributes.attributes)) return std::vector<CodedValues>{};
            return encode_values(original, lifted, sequence, base, fit.surface(fit.level_count()).positions,
                                 options.texcoord_step, order, piece_counts, {});
          })};
}

}  // namespace papilio::test
