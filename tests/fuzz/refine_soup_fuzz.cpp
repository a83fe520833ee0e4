#include <algorithm>
#include <cmath>

#include "papilio/refine.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/soup.h"

// Any triangles with any parameters: what comes out is sound and within its budgets.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::ByteSource bytes(data, size);
  fuzz::unless_refused([&] {
    Options options = fuzz::take_parameters(bytes, 3).options;
    options.face_limit = 10'000;
    const Mesh coarse = build_mesh(fuzz::take_soup(bytes));
    fuzz::require_sound(coarse);
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
