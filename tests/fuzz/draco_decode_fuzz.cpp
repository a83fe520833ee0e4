#include "proto/draco_reader.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/soup.h"

// Any bytes as a mesh: reading of a request body, as the service does.

using namespace papilio;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr proto::Limits limits{.max_input_faces = 20'000, .max_input_vertices = 20'000, .max_output_faces = 40'000};
  fuzz::unless_refused([&] {
    const proto::FormattedMesh read = proto::read_draco(fuzz::text_of(data, size), limits);
    fuzz::require(read.triangles.size() <= limits.max_input_faces, "the limit on faces holds");
    fuzz::require(read.attributes.size() == read.format.attributes.size(), "every attribute has a format");
    fuzz::require_sound(build_mesh(read));
  });
  return 0;
}
