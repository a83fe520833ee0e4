#include "proto/draco_reader.h"
#include "proto/refinement.h"
#include "tests/fuzz/fuzz.h"

// The whole path of the service: every accepted mesh is refined once, and the answer is readable. The input's size
// selects the encoding.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr proto::Limits limits{.max_input_faces = 2000, .max_input_vertices = 20'000, .max_output_faces = 20'000};
  proto::Parameters parameters;
  parameters.options.levels = 1;
  parameters.output.speed = static_cast<int>(size % 11);
  parameters.normals = size / 11 % 2 == 1;
  proto::EncodedLevel made;
  if (!fuzz::unless_refused([&] { made = proto::Refinement(fuzz::text_of(data, size), parameters, limits).run(); }))
    return 0;
  const proto::FormattedMesh read = proto::read_draco(made.bytes, {});
  fuzz::require(read.triangles.size() == made.statistics.faces, "every face arrives");
  return 0;
}
