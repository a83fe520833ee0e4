// refine_mesh IN.obj OUT.obj: reads vertices and triangles, refines where the surface is curved, writes the result.

#include <papilio/refine.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

namespace {

papilio::TriangleMesh read_obj(std::istream& in) {
  papilio::TriangleMesh mesh;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    papilio::Vec3f position;
    papilio::Triangle corners{};
    if (kind == "v" && words >> position.x >> position.y >> position.z) mesh.positions.push_back(position);
    if (kind == "f" && words >> corners[0] >> corners[1] >> corners[2])
      mesh.triangles.push_back({corners[0] - 1, corners[1] - 1, corners[2] - 1});
  }
  return mesh;
}

void write_obj(const papilio::TriangleMesh& mesh, std::ostream& out) {
  for (const papilio::Vec3f& p : mesh.positions) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const papilio::Triangle& t : mesh.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: refine_mesh IN.obj OUT.obj\n", stderr);
    return 2;
  }
  std::ifstream in(argv[1]);
  papilio::Options options;
  options.levels = 4;
  options.tolerance = 0.002;  // share of the diagonal of the mesh's box
  try {
    const papilio::Result result = papilio::refine(papilio::build_mesh(read_obj(in)), options);
    std::ofstream out(argv[2]);
    write_obj(result.mesh.triangles(), out);
    std::printf("%u faces\n", result.mesh.topology.face_count());
    return out.flush() ? 0 : 1;
  } catch (const papilio::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
