// Decoder of packed models (papilio/detail.h) as a separate WebAssembly module, papilio-detail.wasm, which pages fetch
// with the first packed model. Callers write arrays into its memory, and read results from it.

#include <algorithm>
#include <cmath>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "client/c/papilio.h"
#include "client/wasm/runtime.h"
#include "papilio/detail.h"
#include "papilio/error.h"

using papilio::Attribute;
using papilio::DetailBase;
using papilio::DetailStream;
using papilio::Error;
using papilio::Fault;
using papilio::TriangleMesh;

namespace {

/// Base in the layout that the caller writes.
struct Base {
  uint32_t point_count;
  const papilio::Vec3f* positions;
  uint32_t face_count;
  const papilio::Triangle* triangles;
  uint32_t curve_bytes;
  const uint8_t* curves;
  const float* texcoords;  ///< [points * 2] or null
  const uint8_t* colours;  ///< [points * 3] or null
  const uint32_t* parts;   ///< [points] part numbers; null for one part
};

/// Appends values of the points unless they are null.
template <typename Value>
void append_attribute(TriangleMesh& mesh, uint32_t components, const Value* values) {
  if (values == nullptr) return;
  mesh.attributes.push_back(
      {.components = components, .values = {values, values + mesh.positions.size() * components}});
}

/// Rounds colours to bytes.
std::vector<uint8_t> bytes_of(const Attribute& colours) {
  constexpr double most_of_byte = 255;
  std::vector<uint8_t> bytes;
  bytes.reserve(colours.values.size());
  for (const double value : colours.values)
    bytes.push_back(static_cast<uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, most_of_byte)));
  return bytes;
}

/// Sizes of a piece of a level in the layout that the caller writes.
struct Piece {
  uint32_t bytes;
  uint32_t texcoord_bytes;  ///< length of texture coordinates and colours

  static constexpr uint32_t missing = 0xFFFFFFFF;  ///< value of `bytes` of a missing piece
};

/// Residuals of one level in the layout that the caller writes.
struct Level {
  float step;
  float texcoord_step;
  uint32_t length;
  const uint8_t* bytes;  ///< [length] residuals of each piece, each followed by its texture coordinates and colours
  uint32_t piece_count;
  const Piece* pieces;  ///< [piece_count]

  [[nodiscard]] DetailStream stream() const {
    DetailStream made{.step = step, .bytes = {}, .texcoords = {.step = texcoord_step}};
    const uint8_t* at = bytes;
    const auto take = [&](uint32_t count, std::vector<uint8_t>& to) {
      if (count > static_cast<size_t>(bytes + length - at))
        throw Error(Fault::bad_option, "The pieces of a level of detail have other bytes than the level.", "pieces");
      to.insert(to.end(), at, at + count);
      at += count;
    };
    for (uint32_t p = 0; p < piece_count; ++p) {
      papilio::DetailPiece& piece = made.pieces.emplace_back();
      piece.is_missing = pieces[p].bytes == Piece::missing;
      if (piece.is_missing) continue;
      take(piece.bytes = pieces[p].bytes, made.bytes);
      take(piece.texcoord_bytes = pieces[p].texcoord_bytes, made.texcoords.bytes);
    }
    return made;
  }
};

/// Triangles in the layout that the caller reads.
struct Decoded {
  uint32_t point_count;
  uint32_t face_count;
  const papilio::Vec3f* positions;
  const papilio::Triangle* triangles;
  const float* texcoords;  ///< [points * 2] or null
  const uint8_t* colours;  ///< [points * 3] or null
  const float* normals;    ///< [points * 3] or null
  TriangleMesh mesh;
  std::vector<float> texcoord_values;
  std::vector<uint8_t> colour_values;
  std::vector<float> normal_values;
};

}  // namespace

extern "C" {

/// Copies a base.
PAPILIO_EXPORTED(base_create) DetailBase* module_base_create(const Base* from) {
  auto* base = new DetailBase();
  TriangleMesh& mesh = base->triangles;
  mesh.positions.assign(from->positions, from->positions + from->point_count);
  mesh.triangles.assign(from->triangles, from->triangles + from->face_count);
  base->curves.assign(from->curves, from->curves + from->curve_bytes);
  append_attribute(mesh, 2, from->texcoords);
  append_attribute(mesh, 3, from->colours);
  append_attribute(mesh, 1, from->parts);
  return base;
}
PAPILIO_EXPORTED(base_free) void module_base_free(DetailBase* base) { delete base; }

/// Counts the edges of a base. Throws unless it is manifold.
PAPILIO_EXPORTED(base_edges) uint32_t module_base_edges(const DetailBase* base) {
  papilio::BuildReport found;
  const papilio::Mesh mesh = papilio::build_mesh(base->triangles, &found);
  const uint32_t changed = found.isolated_points + found.degenerate_faces + found.repeated_faces;
  if (changed + found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices > 0)
    throw Error(Fault::bad_surface, "The base is not a manifold surface. Pack the original again.");
  return mesh.topology.edge_count();
}

/// Decodes levels, with normals in a style (`NormalStyle`).
PAPILIO_EXPORTED(decode)
Decoded* module_decode(const DetailBase* base, uint32_t level_count, const Level* levels, uint32_t face_limit,
                       uint32_t normals) {
  std::vector<DetailStream> streams;
  streams.reserve(level_count);
  for (uint32_t l = 0; l < level_count; ++l) streams.push_back(levels[l].stream());
  papilio::Mesh mesh = papilio::decode_detail(*base, streams, face_limit);
  papilio::add_detail_normals(mesh, static_cast<papilio::NormalStyle>(normals));
  auto* made = new Decoded{.mesh = std::move(mesh).triangles()};
  made->point_count = static_cast<uint32_t>(made->mesh.positions.size());
  made->face_count = static_cast<uint32_t>(made->mesh.triangles.size());
  made->positions = made->mesh.positions.data();
  made->triangles = made->mesh.triangles.data();
  for (Attribute& attribute : made->mesh.attributes) {
    if (attribute.components == 3 && !attribute.unit_length) {
      made->colour_values = bytes_of(attribute);
      made->colours = made->colour_values.data();
      attribute.values = {};
      continue;
    }
    std::vector<float>& values = attribute.unit_length ? made->normal_values : made->texcoord_values;
    values.assign(attribute.values.begin(), attribute.values.end());
    (attribute.unit_length ? made->normals : made->texcoords) = values.data();
    attribute.values = {};
  }
  return made;
}
PAPILIO_EXPORTED(decoded_free) void module_decoded_free(Decoded* decoded) { delete decoded; }

}  // extern "C"

namespace {

papilio_fault fault_of(Fault fault) {
  switch (fault) {
    case Fault::result_too_large:
      return PAPILIO_TOO_LARGE;
    case Fault::out_of_memory:
      return PAPILIO_OUT_OF_MEMORY;
    default:
      return PAPILIO_UNUSABLE_MESH;
  }
}

}  // namespace

// Called by `throw`.
extern "C" [[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void* (* /*destructor*/)(void*)) {
  if (*type == typeid(Error)) {
    const Error& error = *static_cast<Error*>(thrown);
    caller_fault(fault_of(error.fault()), error.what(), "");
  }
  if (*type == typeid(std::bad_alloc) || *type == typeid(std::length_error))
    caller_fault(PAPILIO_OUT_OF_MEMORY, "There is not enough memory for this result. Ask for fewer levels.", "");
  caller_fault(PAPILIO_INTERNAL, type->name(), "");
}
