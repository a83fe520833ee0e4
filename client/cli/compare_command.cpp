#include <iostream>
#include <nlohmann/json.hpp>

#include "client/cli/commands.h"
#include "client/lib/mesh_stream.h"

namespace papilio::client {

void compare_command(const CompareFlags& flags) {
  if (flags.a.is_standard() && flags.b.is_standard())
    throw UsageError("Standard input is one mesh. Name a file for the other.");
  const auto read = [](const MeshPlace& place) {
    const MeshBytes file = read_mesh(place);
    warn_of_detail(file);
    return triangles_of(file);
  };
  const proto::FormattedMesh a = read(flags.a);
  const proto::FormattedMesh b = read(flags.b);
  const Comparison found = compare(a, b, flags.options, {flags.a.name(), flags.b.name()});
  const nlohmann::ordered_json document{
      {"hausdorff", found.hausdorff},     {"rms", found.rms},
      {"max_forward", found.max_forward}, {"max_backward", found.max_backward},
      {"rms_forward", found.rms_forward}, {"rms_backward", found.rms_backward},
      {"diagonal", found.diagonal},       {"normal_degrees_mean", found.normal_degrees_mean}};
  if (flags.json) {
    std::cout << document.dump(2) << '\n';
    return;
  }
  const auto line = [&](const char* what, double value) {
    std::cout << what << value;
    if (found.diagonal > 0) std::cout << " (" << 100 * value / found.diagonal << " % of the first mesh's diagonal)";
    std::cout << '\n';
  };
  line("Hausdorff distance  ", found.hausdorff);
  line("RMS distance        ", found.rms);
  std::cout << "normals differ by   " << found.normal_degrees_mean << " degrees on average\n";
}

}  // namespace papilio::client
