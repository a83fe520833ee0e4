#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>

#include "client/mesh_file/formats.h"
#include "proto/draco_writer.h"
#include "proto/gltf/meshopt.h"
#include "proto/multipart.h"
#include "proto/parameters.h"
#include "tests/support/charts.h"
#include "tests/support/draco_tools.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

// fuzz_seeds FOLDER: writes the seeds of each target to FOLDER/TARGET, and the dictionary FOLDER/words.

namespace papilio::fuzz {
namespace {

namespace fs = std::filesystem;

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& target, const std::string& bytes) {
    fs::create_directories(folder_ / target);
    write(folder_ / target / ("seed" + std::to_string(number_++)), bytes);
  }
  /// Writes an entry in the dictionary format of libFuzzer: "word" in quotes.
  void add_words(const std::vector<std::string>& words) {
    std::string lines;
    for (const std::string& word : words) lines.append("\"").append(word).append("\"\n");
    write(folder_ / "words", lines);
  }

 private:
  static void write(const fs::path& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw std::runtime_error(path.string() + " cannot be written");
  }

  fs::path folder_;
  int number_ = 0;
};

std::vector<TriangleMesh> shapes() {
  return {test::tetrahedron(), test::cube(),        test::torus(6, 4),
          test::grid(3, 3),    test::fan(5, false), test::join(test::tetrahedron(), test::octahedron(), 5)};
}

void add_meshes(Seeds& seeds) {
  std::vector<std::string> streams;
  for (const TriangleMesh& shape : shapes()) {
    streams.push_back(test::encode_with_draco(shape, test::Method::edgebreaker, true));
    streams.push_back(test::encode_with_draco(shape, test::Method::sequential));
    streams.push_back(proto::write_draco_exact(shape));
    for (const int speed : {0, 3, 5, 10}) {  // each uses another traversal and prediction
      const proto::FormattedMesh charted = test::charted_cube();
      const Mesh mesh = build_mesh(charted);
      streams.push_back(proto::write_draco(mesh, proto::quantization_box(mesh.positions), {.speed = speed},
                                           proto::attribute_encoding(mesh, charted.format)));
      const Mesh plain = build_mesh(shape);
      streams.push_back(
          proto::write_draco(plain, proto::quantization_box(plain.positions), {.position_bits = 9, .speed = speed}));
    }
  }
  for (const std::string& stream : streams)
    for (const char* target : {"draco_decode", "draco_refine"}) seeds.add(target, stream);
}

void add_mesh_files(Seeds& seeds) {
  proto::FormattedMesh mesh = test::charted_cube();
  const auto add = [&](char format, const std::string& bytes) { seeds.add("mesh_files", format + bytes); };
  add(0, client::format_obj(mesh, mesh.format));
  add(1, client::format_ply(mesh, mesh.format));
  add(1,
      "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\nproperty double y\nproperty int z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar uint vertex_indices\nend_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1.5 0 7 8 9\n3 0 1 2\n");
  add(2, client::format_off(mesh));
  add(3, client::format_stl(mesh));
  add(3,
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "endsolid s\n");
  add(4,
      "newmtl a b\nKd 1 .5 0\nKe 2\nd 0.5\nTr 0.5\nNs 96\nPr 0.25\nPm 1\nmap_Kd -s 1 1 1 -clamp on my wood.png\n"
      "norm .\\n.png\nmap_Pr -imfchan g p.png\nmap_Bump -bm 2 \"b.png\"\nnewmtl\nKd xyz 1 1 1\n");
}

/// Joins a document and its binary chunk with a zero.
std::string apart(const test::GltfScene& scene) {
  test::GltfScene::Json json = scene.json;
  json["buffers"] = {{{"byteLength", scene.binary.size()}}};
  return json.dump() + '\0' + scene.binary;
}

void add_scenes(Seeds& seeds) {
  for (const TriangleMesh& shape : shapes()) {
    test::GltfScene scene;
    scene.add_mesh(shape);
    seeds.add("gltf_document", scene.glb());
    seeds.add("gltf_document", scene.gltf());
    seeds.add("gltf_geometry", apart(scene));
    test::GltfScene draco = scene;
    draco.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", draco.add_view(proto::write_draco_exact(shape))}, {"attributes", {{"POSITION", 0}}}};
    seeds.add("gltf_geometry", apart(draco));
    test::GltfScene painted = scene;
    const std::vector<float> coordinates(2 * shape.positions.size(), 0.5F);
    painted.primitive()["attributes"]["TEXCOORD_0"] = painted.add_accessor(coordinates, "VEC2");
    painted.primitive()["material"] = 0;
    painted.json["images"] = {{{"bufferView", painted.add_view("pixels")}, {"mimeType", "image/png"}}};
    painted.json["textures"] = {{{"source", 0}}};
    painted.json["materials"] = {
        {{"name", "wood"},
         {"emissiveFactor", {0.5, 0, 1}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 1, 1, 0.5}},
           {"baseColorTexture",
            {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"rotation", 1}, {"scale", {2, 2}}}}}}}}}}}};
    seeds.add("gltf_geometry", apart(painted));
    const size_t indices = scene.add_view(std::string("\1", 1));
    scene.json["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
    scene.primitive()["mode"] = 5;
    seeds.add("gltf_geometry", apart(scene));
    const std::string bytes = proto::gltf::encode_meshopt_attributes(std::string(120, '\1'), 12);
    test::GltfScene meshopt;
    meshopt.add_mesh(shape);
    meshopt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},          {"byteOffset", meshopt.binary.size()}, {"byteLength", bytes.size()}, {"byteStride", 12},
        {"mode", "ATTRIBUTES"}, {"count", shape.positions.size()}};
    meshopt.binary += bytes;
    seeds.add("gltf_geometry", apart(meshopt));
  }
}

/// Writes packed models with random residuals, each after the byte that selects how it is read.
void add_packed_models(Seeds& seeds) {
  TriangleMesh charted = test::charted_cube();
  charted.attributes.erase(charted.attributes.begin());  // keeps the texture coordinates
  std::vector<std::string> models{test::parted_fixture().glb};
  TriangleMesh coloured = test::icosahedron();
  coloured.attributes.push_back({.components = 3, .values = std::vector<double>(3 * coloured.positions.size(), 99)});
  for (const TriangleMesh& shape : {test::tetrahedron(), test::torus(6, 4), test::icosahedron(), charted, coloured}) {
    const test::PackedFixture whole = test::packed_fixture(shape, 3);
    models.push_back(whole.glb);
    models.push_back(test::in_pieces(whole, {2, 1, 4}).glb);
  }
  for (const std::string& glb : models)
    for (const char choice : {'\x20', '\x21', '\x33'})
      seeds.add("detail", choice + test::json_of_glb(glb).dump() + '\0' + test::binary_of_glb(glb));
}

void add_parameters(Seeds& seeds) {
  std::vector<std::string> words{"true",
                                 "false",
                                 "null",
                                 "HTTP/1.1",
                                 "Content-Length: ",
                                 "Transfer-Encoding: chunked",
                                 "boundary=",
                                 "multipart/mixed",
                                 "multipart/form-data",
                                 "name=",
                                 "Host: ",
                                 "q=0.5",
                                 "byteOffset",
                                 "byteStride",
                                 "componentType",
                                 "TRIANGLES",
                                 "OCTAHEDRAL",
                                 "normalized",
                                 "TEXCOORD_0",
                                 "PAPILIO_detail"};
  for (const proto::ParameterInfo& info : proto::parameter_table()) {
    const std::string name(info.name);
    std::string value = proto::describe_default(info);
    if (!info.choices.empty()) value = info.choices.back();
    seeds.add("parameters_query", "levels=2&" + name + "=" + value);
    const size_t dot = name.find('.');
    seeds.add("parameters_json", dot == std::string::npos ? "{\"" + name + "\": \"" + value + "\"}"
                                                          : "{\"" + name.substr(0, dot) + "\": {\"" +
                                                                name.substr(dot + 1) + "\": [1, 2, 3]}}");
    words.push_back(name);
    for (const std::string_view choice : info.choices) words.emplace_back(choice);
  }
  seeds.add("parameters_query", "view.eye=0,0,3&view.error_pixels=1&flatness=0.8,0.9&output.normals=true");
  seeds.add("parameters_json", R"({"levels": 3, "flatness": [0.8, 0.9], "view": {"eye": [0, 0, 3], "fov_y": 40}})");
  seeds.add_words(words);
}

void add_messages(Seeds& seeds) {
  seeds.add("request_head",
            "POST /v1/refine?levels=2&scheme=in%2Dplace HTTP/1.1\r\nHost: here\r\nContent-Length: 12\r\n"
            "Content-Type: application/x-draco\r\nX-Request-Id: a\r\n\r\n");
  seeds.add("request_head",
            "GET http://here/v1/info HTTP/1.0\r\nTransfer-Encoding: chunked\r\nRange: bytes=0-1\r\n\r\n");
  seeds.add("chunk_line", "1f;name=value ; quoted = \"a\\\"b\";alone");
  seeds.add("form",
            "multipart/form-data; boundary=\"cut\"\nbefore\r\n--cut\r\nContent-Disposition: form-data; name=\"mesh\"; "
            "filename=a.drc\r\nContent-Type: application/x-draco\r\n\r\nDRACO\r\n--cut\r\n"
            "Content-Disposition: form-data; name=params\r\n\r\n{}\r\n--cut--\r\nafter");
  const proto::MultipartWriter writer("cut");
  seeds.add("multipart", "\x02" + writer.content_type() + "\n" +
                             writer.part({{{"Content-Type", "application/x-draco"}, {"Papilio-Faces", "4"}}, "bytes"}) +
                             writer.part({{{"Content-Type", "application/json"}}, "{}"}) + writer.end());
  seeds.add("accept", "multipart/mixed;q=0.5, application/*, */*;q=0.1");
}

/// Writes seeds of targets that interpret arbitrary bytes.
void add_noise(Seeds& seeds) {
  std::mt19937 random(1);
  for (const char* target : {"refine_soup", "draco_round_trip"})
    for (int i = 0; i < 20; ++i) {
      std::string bytes(600, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random());
      seeds.add(target, bytes);
    }
}

}  // namespace
}  // namespace papilio::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  try {
    papilio::fuzz::Seeds seeds(argv[1]);
    papilio::fuzz::add_meshes(seeds);
    papilio::fuzz::add_mesh_files(seeds);
    papilio::fuzz::add_scenes(seeds);
    papilio::fuzz::add_packed_models(seeds);
    papilio::fuzz::add_parameters(seeds);
    papilio::fuzz::add_messages(seeds);
    papilio::fuzz::add_noise(seeds);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "fuzz_seeds: " << error.what() << '\n';
    return 1;
  }
}
