#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "papilio/refine.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Limit of the machine: time to copy the bytes of the uniform result, compared with computing them. And large results:
// time per output triangle for 5.7 and 22.8 million triangles, compared with 1.4 million.

namespace papilio::bench {
namespace {

Options uniform_options(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  options.face_limit = 32'000'000;
  options.edges = false;
  options.measure_error = false;
  return options;
}

struct Refinement {
  double faces;                 ///< of the result
  std::function<double()> run;  ///< seconds
};

Refinement refinement(const char* mesh, int levels) {
  const auto coarse = std::make_shared<Mesh>(build_mesh(test::real_mesh(mesh)));
  return {coarse->topology.face_count() * std::pow(4.0, levels), [coarse, levels] {
            Mesh copy = *coarse;
            return seconds([&] { (void)refine(std::move(copy), uniform_options(levels)); });
          }};
}

void add_copy(const char* name, int levels) {
  const Mesh result = refine(build_mesh(test::real_mesh(name)), uniform_options(levels)).mesh;
  const size_t bytes = 4 * (result.topology.origin.size() + result.topology.twin.size()) + 12 * result.positions.size();
  const auto from = std::make_shared<std::vector<char>>(bytes, 1);
  const auto to = std::make_shared<std::vector<char>>(bytes, 2);
  add({.name = "limit/copy of the result/" + std::string(name) + "/" + std::to_string(levels),
       .divisor = static_cast<double>(result.topology.face_count()),
       .unit = "ns/triangle out",
       .ours = refinement(name, levels).run,
       .peer = [=] { return seconds([&] { std::memcpy(to->data(), from->data(), from->size()); }); }});
}

void add_growth(const char* name, int levels, int few_levels) {
  const Refinement large = refinement(name, levels);
  const Refinement small = refinement(name, few_levels);
  add({.name = "growth/" + std::string(name) + "/" + std::to_string(levels) + " of " + std::to_string(few_levels),
       .divisor = large.faces,
       .unit = "ns/triangle out",
       .ours = large.run,
       .peer = [=] { return small.run() * large.faces / small.faces; }});
}

}  // namespace

void add_limits() {
  add_copy("elephant20k.drc", 3);
  add_copy("elephant89k.drc", 3);
  add_growth("elephant62.5k.drc", 4, 2);  // 16 million triangles, compared with 1 million
  add_growth("elephant62.5k.drc", 4, 3);
  add_growth("elephant89k.drc", 3, 2);
  add_growth("elephant89k.drc", 4, 2);
}

}  // namespace papilio::bench
