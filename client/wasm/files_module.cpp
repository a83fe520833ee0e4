// Readers of triangle files (client/mesh_file) as a separate WebAssembly module, papilio-files.wasm, which pages fetch
// with the first such file. Callers write the bytes into its memory, and read the triangles from it.

#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "client/c/papilio.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/sound_mesh.h"
#include "client/wasm/runtime.h"

using papilio::client::ObjFile;
using papilio::client::ParseError;
using papilio::proto::FormattedMesh;

namespace {

/// Format in the caller's numbers.
enum class Format : uint32_t { obj, ply, off, stl };

ObjFile parse(Format format, std::string_view bytes) {
  switch (format) {
    case Format::obj:
      return papilio::client::parse_obj_file(bytes);
    case Format::ply:
      return {papilio::client::parse_ply(bytes)};
    case Format::off:
      return {{papilio::client::parse_off(bytes), {}}};
    default:
      return {{papilio::client::parse_stl(bytes), {}}};
  }
}

/// Attribute in the layout that the caller reads.
struct Values {
  uint32_t kind;  ///< papilio::proto::AttributeKind; a generic one holds smoothing groups
  uint32_t components;
  const float* values;  ///< [points * components]; colours from 0 to 1
};

/// Names in the layout that the caller reads, each ended by 0.
struct Names {
  uint32_t count;
  const char* text;
};

/// File in the layout that the caller reads.
struct File {
  uint32_t point_count;
  uint32_t face_count;
  const papilio::Vec3f* positions;
  const papilio::Triangle* triangles;
  uint32_t attribute_count;
  const Values* attributes;
  Names libraries;
  Names materials;
  const uint32_t* material_of_face;  ///< [faces] null without materials

  ObjFile file;
  std::vector<std::vector<float>> values;
  std::vector<Values> rows;
  std::string library_text, material_text;
};

Names join(const std::vector<std::string>& names, std::string& text) {
  for (const std::string& name : names) text.append(name).push_back('\0');
  return {static_cast<uint32_t>(names.size()), text.data()};
}

/// Replaces the values of all attributes by floats.
void set_attributes(File& made) {
  FormattedMesh& mesh = made.file.mesh;
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const papilio::proto::AttributeFormat& format = mesh.format.attributes[a];
    const double unit = papilio::proto::unit_value(format);
    std::vector<float>& values = made.values.emplace_back();
    values.reserve(mesh.attributes[a].values.size());
    for (const double value : std::exchange(mesh.attributes[a].values, {}))
      values.push_back(static_cast<float>(value / unit));
    made.rows.push_back({static_cast<uint32_t>(format.kind), mesh.attributes[a].components, values.data()});
  }
  made.attribute_count = static_cast<uint32_t>(made.rows.size());
  made.attributes = made.rows.data();
}

}  // namespace

extern "C" {

/// Reads a file's bytes, and frees them. Throws unless it holds sound triangles.
PAPILIO_EXPORTED(file_read) File* module_file_read(uint32_t format, char* bytes, uint32_t length) {
  auto* made = new File{.file = parse(static_cast<Format>(format), {bytes, length})};
  ::operator delete(bytes);
  const FormattedMesh& mesh = made->file.mesh;
  if (const auto fault = papilio::client::find_fault(mesh)) throw ParseError(*fault);
  made->point_count = static_cast<uint32_t>(mesh.positions.size());
  made->face_count = static_cast<uint32_t>(mesh.triangles.size());
  made->positions = mesh.positions.data();
  made->triangles = mesh.triangles.data();
  set_attributes(*made);
  const papilio::client::ObjMaterials& materials = made->file.materials;
  made->libraries = join(materials.libraries, made->library_text);
  made->materials = join(materials.names, made->material_text);
  made->material_of_face = materials.of_triangle.empty() ? nullptr : materials.of_triangle.data();
  return made;
}

}  // extern "C"

// Called by `throw`.
extern "C" [[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void* (* /*destructor*/)(void*)) {
  if (*type == typeid(ParseError)) caller_fault(PAPILIO_UNUSABLE_MESH, static_cast<ParseError*>(thrown)->what(), "");
  if (*type == typeid(std::bad_alloc) || *type == typeid(std::length_error))
    caller_fault(PAPILIO_OUT_OF_MEMORY, "There is not enough memory for this file.", "");
  caller_fault(PAPILIO_INTERNAL, type->name(), "");
}
