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

/// Upper bound of the levels of detail.
inline constexpr int most_detail_levels = 10;

/// Coarse mesh that levels refine.
struct DetailBase {
  /// Manifold triangles; edges with one face are boundaries. Optional attributes, in this order: texture coordinates
  /// (2 components); colours (3 components, 0..255); part numbers (1 component, equal at all corners of a face), for
  /// example of materials. All may have seams.
  TriangleMesh triangles;
  std::vector<uint8_t> curves{};  ///< coded creases, and corners of creases and boundaries; empty if there are none

  friend bool operator==(const DetailBase&, const DetailBase&) = default;
};

/// Places where the normals of an original, and so of its levels, are split.
enum class NormalStyle : uint8_t {
  absent,   ///< original without normals
  smooth,   ///< nowhere: one normal a vertex
  creased,  ///< creases of the base
  faceted,  ///< most edges: normals of faces
};

/// Residuals of texture coordinates and colours on one level.
struct TexcoordStream {
  /// Quantization step, in the unit of texture coordinates; for colours, 2048 times this value. 0: no residuals.
  float step = 0;
  std::vector<uint8_t> bytes{};  ///< entropy-coded residuals
};

/// Bounds of a piece, known before its bytes, in the mesh's unit. They hold for the last level's surface below the
/// piece's faces of the base.
struct PieceBounds {
  float largest_move = 0;   ///< upper bound of the distance by which residuals move a vertex
  Vec3f centre{};           ///< centre of a sphere that contains the surface
  float radius = 0;         ///< radius of the sphere
  Vec3f axis{};             ///< axis of a cone that contains the normals of the surface's faces; unit length
  float least_cosine = -1;  ///< lower bound of the cosine between a normal and the axis

  friend bool operator==(const PieceBounds&, const PieceBounds&) = default;
};

/// Independently coded part of a level. Pieces divide the faces of the base, in the order of a space-filling curve,
/// into runs of about equal length. A piece has the level's edges below its faces.
struct DetailPiece {
  uint32_t bytes = 0;           ///< length of its residuals in `DetailStream::bytes`
  uint32_t texcoord_bytes = 0;  ///< length of its residuals in `TexcoordStream::bytes`
  /// Whether its bytes are absent. Then its vertices, and those of pieces that depend on it, are predicted only.
  bool is_missing = false;
  PieceBounds bounds{};

  friend bool operator==(const DetailPiece&, const DetailPiece&) = default;
};

/// Upper bound of the pieces of a level.
inline constexpr uint32_t most_detail_pieces = 65535;

/// Residuals of one level.
struct DetailStream {
  float step = 0;              ///< quantization step, in the mesh's unit; > 0
  std::vector<uint8_t> bytes;  ///< entropy-coded residuals, piece by piece, each in the order of the split edges
  TexcoordStream texcoords{};  ///< residuals of texture coordinates and colours, if the base has any
  /// Pieces in the order of their bytes, at most as many as the base has faces; empty: one piece.
  std::vector<DetailPiece> pieces{};
};

/// Distances between the original and the levels decoded so far, as shares of the original's diagonal.
struct DetailReach {
  double rms = 0;      ///< root mean square distance, the larger of both directions
  double largest = 0;  ///< largest distance of either direction
};

/// Decodes base and streams to a mesh with edges and with the attributes of the base, whose curves are its boundaries
/// and creases. `base` must be manifold. Each face of the base becomes 4^n consecutive faces of its part, where n is
/// the number of streams. Any bytes are decoded to some mesh.
///
/// A piece is decoded if three conditions hold: its bytes are present; the first piece of its level and of each level
/// before is decoded; and so is each piece of the level before with a face at a vertex of one of the piece's faces of
/// the base. Its vertices do not depend on which other pieces are present.
///
/// The result is bit-identical on every processor. Throws `Error`: bad_option (no step, too many levels, other
/// attributes, pieces that do not match the bytes), not_finite, result_too_large (beyond `face_limit`), cancelled, and
/// errors of build_mesh(). O(result).
[[nodiscard]] Mesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels,
                                 uint64_t face_limit = face_count_limit, const std::function<bool()>& cancelled = {});

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

  /// Returns whether the mesh is the base, to the bit, with vertices and faces in the base's order.
  [[nodiscard]] virtual bool fits(const Mesh& mesh) const = 0;
  /// Returns the connectivity of the base, with its curves.
  [[nodiscard]] virtual const Topology& base() const = 0;
  [[nodiscard]] virtual int level_count() const = 0;
  /// Returns the positions of the new vertices on the edges of the mesh after `level` levels, in the order of its
  /// edges; 0 <= level < level_count(). The span is valid for the lifetime of the detail. Throws `Error`: not_finite,
  /// cancelled, out_of_memory.
  [[nodiscard]] virtual std::span<const Vec3f> new_vertices(int level,
                                                            const std::function<bool()>& cancelled = {}) const = 0;
  /// Returns [H] the texture coordinates of the new vertex on each half-edge of the mesh after `level` levels, in the
  /// half-edge's face. Empty if the detail has none. Lifetime and errors as of new_vertices().
  [[nodiscard]] virtual std::span<const Texcoord> new_texcoords(int level,
                                                                const std::function<bool()>& cancelled = {}) const {
    (void)level;
    (void)cancelled;
    return {};
  }
  /// Returns [H] the colour of the new vertex on each half-edge, as new_texcoords().
  [[nodiscard]] virtual std::span<const Colour> new_colours(int level,
                                                            const std::function<bool()>& cancelled = {}) const {
    (void)level;
    (void)cancelled;
    return {};
  }
  /// Returns an upper bound of the distance from the new vertices to their edges. Throws as new_vertices().
  [[nodiscard]] virtual double largest_move(int level, const std::function<bool()>& cancelled = {}) const = 0;
  /// Returns the bytes in memory now.
  [[nodiscard]] virtual uint64_t bytes() const = 0;
};

/// Arguments of decode_detail().
struct DetailSource {
  DetailBase base;
  std::vector<DetailStream> levels;
};

/// Returns the levels of decode_detail(), each decoded on first use. Throws `Error`: bad_option, bad_surface,
/// result_too_large (beyond `face_count_limit`), and errors of build_mesh(). O(base).
[[nodiscard]] std::shared_ptr<const Detail> stream_detail(DetailSource source);

/// Marks the creases and corners of an original, as encode_detail() does. Creases are clean curves of edges at which
/// normals are split, or of sharp edges where normals do not contradict. Removes the normals, an attribute with 3
/// components (`Attribute::unit_length`), and returns their style. Keeps faces, edges and vertices. The mesh must have
/// edges. O(F log F).
NormalStyle mark_detail_curves(Mesh& mesh);

/// Returns whether levels have vertex normals in a style. A faceted original is shaded by face normals.
[[nodiscard]] constexpr bool has_detail_normals(NormalStyle style) {
  return style == NormalStyle::smooth || style == NormalStyle::creased;
}
/// Adds normals in a style as the last attribute: angle-weighted means of face normals, one a vertex, or one for each
/// side of a crease. `smooth` unmarks the creases. Does nothing unless has_detail_normals(). Returns whether normals
/// were added. The mesh must have edges. O(H log H).
bool add_detail_normals(Mesh& mesh, NormalStyle style);

/// Decoded base.
struct CodedBase {
  TriangleMesh triangles;
  uint64_t bytes = 0;     ///< length of its code
  Buffer<Vec3f> moved{};  ///< [points of the base that was coded] places to which they moved; empty if none did
};
/// Function that codes and decodes a base, so that the encoder predicts from the decoder's values. Vertices and faces
/// may be reordered; vertices stay distinct. `normals` [V] are the original's at vertices that may slide along its
/// surface, and zero at others; empty if none may.
using BaseCoder = std::function<CodedBase(const TriangleMesh&, std::span<const Vec3d> normals)>;

struct DetailOptions {
  double rms = 1e-4;  ///< target RMS distance, a share of the original's bounding box's diagonal; 1e-6..0.1
  /// Quantization step of texture coordinates on the last level; > 0. The largest error at vertices is 3/4 of it. On a
  /// subdivided duck, the RMS error is then one texel of a 2048 x 2048 texture. The step of colours is 2048 times this.
  double texcoord_step = 1.0 / 512;
  uint64_t face_limit = 8'000'000;            ///< upper bound of the faces of the last level
  uint64_t piece_bytes = 16'384;              ///< approximate length of a piece of a level; > 0
  std::function<bool()> cancelled{};          ///< polled between steps; true stops with `Fault::cancelled`
  std::function<void(double)> on_progress{};  ///< share done, 0..1
};

struct EncodedDetail {
  DetailBase base;  ///< decoded base, ready for decode_detail()
  std::vector<DetailStream> levels;
  std::vector<DetailReach> reach;  ///< [levels + 1] distances of the base alone, with the first level, and so on
  uint32_t folds = 0;              ///< faces of the last level that face against the original
  double folded_area = 0;          ///< their area, a share of the last level's
  uint32_t parted = 0;             ///< vertices at which the original touches itself, which were separated
  uint64_t bytes = 0;              ///< length of base, curves and streams
  uint64_t texcoord_bytes = 0;     ///< length of the streams of texture coordinates
  NormalStyle normals{};           ///< style of the original's normals
};

/// Encodes an original. Its attributes may be those of `DetailBase::triangles`, whose seams become seams of the base,
/// and normals, of which only the style is kept. Boundaries and the creases of mark_detail_curves() become curves of
/// the base.
///
/// Where the surface touches itself, or more than two faces share an edge, it is separated, by at most a tenth of the
/// target distance. Slivers smaller than that are removed. Several numbers of base faces, numbers of levels and steps
/// are tried; the result takes the fewest bytes at the target distance. If none reaches it, the result is the nearest
/// (`reach`). Points of the original farther than eight target distances get vertices where that turns no face over, so
/// few are left. Without attributes, levels that are not needed for the distance are left out.
///
/// Throws `Error`: bad_option, bad_surface (it cannot be separated, or its base cannot be coded), cancelled,
/// out_of_memory, and errors of build_mesh().
[[nodiscard]] EncodedDetail encode_detail(const TriangleMesh& original, const DetailOptions& options,
                                          const BaseCoder& code_base);

struct SimplifyOptions {
  double rms = 1e-4;                  ///< upper bound of the RMS distance, a share of the diagonal; 1e-6..0.1
  double largest = 1;                 ///< upper bound of the largest distance, a share of the diagonal; > 0
  std::function<bool()> cancelled{};  ///< polled between steps; true stops with `Fault::cancelled`
};

/// Grid of positions: `origin` + whole numbers times `step`.
struct PositionGrid {
  Vec3f origin{};
  float step = 0;  ///< > 0
  int bits = 0;    ///< bits of a coordinate; those of few points may lie beyond 0..2^bits - 1

  friend bool operator==(const PositionGrid&, const PositionGrid&) = default;
};

/// Decoded mesh without levels.
struct SimplifiedDetail {
  TriangleMesh triangles;
  DetailReach reach;
  uint64_t bytes = 0;  ///< length of its code
  PositionGrid grid;   ///< grid of its positions
};
/// Function that codes and decodes a mesh whose positions are on a grid.
using MeshCoder = std::function<CodedBase(const TriangleMesh&, const PositionGrid&)>;

/// Simplifies an original, without its attributes, as the alternative to levels: by quadrics with optimal placement,
/// whose vertices are then moved, onto a grid, to where the squared distance is least. Returns the candidate with the
/// fewest bytes within both bounds; nothing if none is. Throws `Error`: bad_option, cancelled, out_of_memory, and
/// errors of build_mesh().
[[nodiscard]] std::optional<SimplifiedDetail> simplify_detail(const TriangleMesh& original,
                                                              const SimplifyOptions& options, const MeshCoder& code);

}  // namespace papilio
