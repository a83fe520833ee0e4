#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "papilio/mesh.h"

// Detail: a fine original as a coarse base and one residual for each new vertex of its subdivision. Each level predicts
// its new vertices by the Modified Butterfly scheme from decoded positions and moves them by their residuals.
// Sources: Khodakovsky, Schröder, Sweldens, "Progressive Geometry Compression", 2000; Guskov, Vidimče, Sweldens,
// Schröder, "Normal Meshes", 2000.

namespace papilio {

/// Most levels of detail.
inline constexpr int most_detail_levels = 10;

/// Coarse mesh that levels refine.
struct DetailBase {
  /// Manifold; edges with one face are boundaries. Attributes may be, in this order: texture coordinates, of two
  /// components; colours, of three, 0..255; the numbers of parts, of one component: those of materials, say, the same
  /// at the corners of each face. All may have seams.
  TriangleMesh triangles;
  std::vector<uint8_t> curves{};  ///< coded creases, and corners of creases and boundaries; empty: there are none

  friend bool operator==(const DetailBase&, const DetailBase&) = default;
};

/// How an original's own normals are split, and with them those that its levels are shaded by.
enum class NormalStyle : uint8_t {
  absent,   ///< the original has none
  smooth,   ///< nowhere: one normal a vertex
  creased,  ///< at creases of the base
  faceted,  ///< at most edges: the normals of the faces
};

/// Residuals of texture coordinates and colours on one level.
struct TexcoordStream {
  /// Quantization step, in the unit of texture coordinates; of colours 2048 times that; 0: there are no residuals.
  float step = 0;
  std::vector<uint8_t> bytes{};  ///< entropy-coded residuals
};

/// What is known of a piece before it is there, in the mesh's unit. The surface is that of the last level below the
/// piece's faces of the base.
struct PieceBounds {
  float largest_move = 0;   ///< upper bound of how far residuals move a vertex
  Vec3f centre{};           ///< of a sphere that holds the surface
  float radius = 0;         ///< of that
  Vec3f axis{};             ///< unit length: of a cone of the normals of the surface's faces
  float least_cosine = -1;  ///< lower bound of the cosine of their angles with it

  friend bool operator==(const PieceBounds&, const PieceBounds&) = default;
};

/// A part of a level that is coded by itself. Pieces take the faces of the base in the order of a space-filling curve,
/// about as many each, and have the edges below those.
struct DetailPiece {
  uint32_t bytes = 0;           ///< of its residuals, among those of its level
  uint32_t texcoord_bytes = 0;  ///< likewise, of those of texture coordinates
  bool is_missing = false;      ///< without bytes: its vertices, and those of pieces that need it, are the smooth ones
  PieceBounds bounds{};

  friend bool operator==(const DetailPiece&, const DetailPiece&) = default;
};

/// Most pieces of a level.
inline constexpr uint32_t most_detail_pieces = 65535;

/// Residuals of one level.
struct DetailStream {
  float step = 0;              ///< quantization step, in the mesh's unit; > 0
  std::vector<uint8_t> bytes;  ///< entropy-coded residuals: of each piece in the order of the edges that are split
  TexcoordStream texcoords{};  ///< where the base has texture coordinates or colours
  /// In the order of their bytes, at most as many as the base has faces; empty: all is one piece.
  std::vector<DetailPiece> pieces{};
};

/// What a decoder of the levels up to one has, compared with the original.
struct DetailReach {
  double rms = 0;      ///< root mean square distance, the larger of both directions; share of the original's diagonal
  double largest = 0;  ///< largest distance of either direction; share of the original's diagonal
};

/// Returns the mesh of the base and all streams: faces of the base times 4 to the power of the number of streams, with
/// the texture coordinates and colours of the base. Each face of the base is as many faces in a row, which are of its
/// part. `base` must be manifold. Any bytes are decoded to some mesh. The same bits on every processor, and of each
/// vertex whose piece can be decoded whatever other pieces are there (decodable_pieces()). Throws `Error`: bad_option
/// (no step, too many levels, other attributes, pieces that are not those of the bytes), not_finite, result_too_large
/// beyond `face_limit`, cancelled, and what build_mesh() throws. O(result).
[[nodiscard]] TriangleMesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels,
                                         uint64_t face_limit = face_count_limit,
                                         const std::function<bool()>& cancelled = {});

/// Returns the mesh that decode_detail() returns, with its edges. Its boundaries and creases come from the base's
/// curves. Throws as decode_detail().
[[nodiscard]] Mesh decode_detail_mesh(const DetailBase& base, std::span<const DetailStream> levels,
                                      uint64_t face_limit = face_count_limit,
                                      const std::function<bool()>& cancelled = {});

/// Returns [level][piece] whether decode_detail() decodes each piece: those that are there, if all of the level before
/// are decoded that lie at a vertex of the base at which the piece has a face, and the first one of its level and of
/// those before. Throws as decode_detail().
[[nodiscard]] std::vector<std::vector<uint8_t>> decodable_pieces(const DetailBase& base,
                                                                 std::span<const DetailStream> levels);

/// Texture coordinates of a point.
using Texcoord = std::array<float, 2>;
/// Colour of a point: red, green, blue, about 0..255.
using Colour = std::array<float, 3>;

/// New vertices of the uniform levels of a mesh (`Mesh::attach_detail`). Thread-safe.
class Detail {
 public:
  Detail() = default;
  Detail(const Detail&) = delete;
  Detail& operator=(const Detail&) = delete;
  virtual ~Detail() = default;

  /// Whether the mesh is the base, to the bit, with its numbers of vertices and faces.
  [[nodiscard]] virtual bool fits(const Mesh& mesh) const = 0;
  /// The connectivity of the base, with its curves.
  [[nodiscard]] virtual const Topology& base() const = 0;
  [[nodiscard]] virtual int level_count() const = 0;
  /// Returns the positions of the vertices on the edges of the mesh that `level` levels give, 0 <= level <
  /// level_count(), in the order of its edges. They stay there as long as the detail. Throws `Error`: not_finite,
  /// cancelled, out_of_memory.
  [[nodiscard]] virtual std::span<const Vec3f> new_vertices(int level,
                                                            const std::function<bool()>& cancelled = {}) const = 0;
  /// Returns the texture coordinates of the points on the half-edges of the mesh that `level` levels give, two numbers
  /// a half-edge: those of its edge's new vertex in its face. Empty where the detail has none. As long as
  /// new_vertices(), and throws as that.
  [[nodiscard]] virtual std::span<const Texcoord> new_texcoords(int level,
                                                                const std::function<bool()>& cancelled = {}) const {
    (void)level;
    (void)cancelled;
    return {};
  }
  /// Returns the colours of those points, as new_texcoords().
  [[nodiscard]] virtual std::span<const Colour> new_colours(int level,
                                                            const std::function<bool()>& cancelled = {}) const {
    (void)level;
    (void)cancelled;
    return {};
  }
  /// Upper bound of the distance from the new vertices to their edges. Throws as new_vertices().
  [[nodiscard]] virtual double largest_move(int level, const std::function<bool()>& cancelled = {}) const = 0;
  /// Bytes in memory now.
  [[nodiscard]] virtual uint64_t bytes() const = 0;
};

/// What decode_detail() takes.
struct DetailSource {
  DetailBase base;
  std::vector<DetailStream> levels;
};

/// Returns the levels that decode_detail() makes, decoded when they are first asked for. Throws `Error`: bad_option,
/// bad_surface, result_too_large (beyond `face_count_limit`), and what build_mesh() throws. O(base).
[[nodiscard]] std::shared_ptr<const Detail> stream_detail(DetailSource source);

/// Marks the creases and corners of an original, as encode_detail() does: edges that form clean curves and are hard,
/// where its normals are split, or sharp where the normals do not say otherwise. Takes the normals from it, an
/// attribute of three components (`Attribute::unit_length`), and returns their style. Faces, edges and vertices stay.
/// The mesh must have its edges. O(F log F).
NormalStyle mark_detail_curves(Mesh& mesh);

/// Whether normals of a style are computed on levels: those of a faceted original are its faces'.
[[nodiscard]] constexpr bool has_detail_normals(NormalStyle style) {
  return style == NormalStyle::smooth || style == NormalStyle::creased;
}
/// Adds normals in a style as the last attribute of a mesh: means of the faces' normals weighted by angles, at creases
/// one for each side, or one a vertex. Without effect unless has_detail_normals(). Smooth ones unmark the
/// creases. Returns whether any were added. The mesh must have its edges. O(H log H).
bool add_detail_normals(Mesh& mesh, NormalStyle style);

/// Base as its decoder has it.
struct CodedBase {
  TriangleMesh triangles;
  uint64_t bytes = 0;  ///< of its code
};
/// Codes and decodes a base: for the encoder, which needs what decoders will have. Vertices and faces may change their
/// order, positions move by less than half the distance between any two.
using BaseCoder = std::function<CodedBase(const TriangleMesh&)>;

struct DetailOptions {
  double rms = 1e-4;  ///< wanted RMS distance, a share of the original's bounding box's diagonal; 1e-6..0.1
  /// Of texture coordinates on the last level, whose largest error at vertices is 3/4 of it; > 0. On a subdivided duck
  /// the RMS error of the whole is then a texel of a texture of 2048 by 2048. That of colours is 2048 times as large.
  double texcoord_step = 1.0 / 512;
  uint64_t face_limit = 8'000'000;            ///< faces of the last level
  uint64_t piece_bytes = 16'384;              ///< of a piece of a level, about; > 0
  std::function<bool()> cancelled{};          ///< asked between steps; true stops with `Fault::cancelled`
  std::function<void(double)> on_progress{};  ///< share done, 0..1
};

struct EncodedDetail {
  DetailBase base;  ///< as decoded; decode_detail() takes it as it is
  std::vector<DetailStream> levels;
  std::vector<DetailReach> reach;  ///< [levels + 1] of the base alone, with the first level, and so on
  uint32_t folds = 0;              ///< faces of the last level turned against the original where they lie
  uint32_t parted = 0;             ///< vertices at which the original touches itself, which were parted
  uint64_t bytes = 0;              ///< of base, curves and streams
  uint64_t texcoord_bytes = 0;     ///< of the streams of texture coordinates
  NormalStyle normals{};           ///< of the original
};

/// Encodes an original without attributes, or with those that a base may have, whose seams become seams of the base,
/// and with normals, whose style alone is kept. Boundaries become curves of the base, and so do the creases of
/// mark_detail_curves(). Where the surface touches itself, or more than two faces share an edge, it is parted, by at
/// most a tenth of the wanted distance; slivers so small are removed. The number of base faces, of levels and the steps
/// are those, of the ones tried, that take the fewest bytes for the wanted distance; where it is not reached they come
/// nearest to it (`reach`). Throws `Error`: bad_option, bad_surface (cannot be parted, or its base cannot be coded),
/// cancelled, out_of_memory, and what build_mesh() throws.
[[nodiscard]] EncodedDetail encode_detail(const TriangleMesh& original, const DetailOptions& options,
                                          const BaseCoder& code_base);

struct SimplifyOptions {
  double rms = 1e-4;                  ///< RMS distance at most, a share of the diagonal as above; 1e-6..0.1
  double largest = 1;                 ///< largest distance at most, a share of the diagonal; > 0
  std::function<bool()> cancelled{};  ///< asked between steps; true stops with `Fault::cancelled`
};

/// Mesh without levels, as its decoder has it.
struct SimplifiedDetail {
  TriangleMesh triangles;
  DetailReach reach;
  uint64_t bytes = 0;     ///< of its code
  int position_bits = 0;  ///< of a coordinate
};
/// Codes and decodes a mesh with so many bits of a coordinate.
using MeshCoder = std::function<CodedBase(const TriangleMesh&, int)>;

/// Simplifies an original without its attributes to what its levels compete with: the fewest faces and bits, of those
/// tried, that leave the wanted distances, by quadrics with optimal placement. Nothing where none do. Throws `Error`:
/// bad_option, cancelled, out_of_memory, and what build_mesh() throws.
[[nodiscard]] std::optional<SimplifiedDetail> simplify_detail(const TriangleMesh& original,
                                                              const SimplifyOptions& options, const MeshCoder& code);

}  // namespace papilio
