#include "hierarchy/assemble.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hierarchy/transition.h"
#include "mesh/attributes.h"
#include "mesh/connect.h"
#include "mesh/four_children.h"
#include "split/split_in_four.h"

namespace papilio {
namespace {

/// Level, and the results of its faces.
struct AssembledLevel {
  const LevelChoice* choice;
  const Topology* mesh;
  AssembledLevel* below = nullptr;  ///< the next level; null: this is the last
  const uint32_t* edge;             ///< [H] of the mesh
  Buffer<uint32_t> new_vertex;      ///< [E] number of the edge's vertex in the result; set if split

  /// Faces that are in the result, or whose children are, in ascending order, and the pieces of each.
  /// Only with attributes.
  struct FacePieces {
    uint32_t first;           ///< first half-edge in the result of the face's pieces
    const SplitPattern* cut;  ///< pattern of the pieces; null: its children are in the result
  };
  Buffer<uint32_t> shown;
  Buffer<FacePieces> pieces;

  [[nodiscard]] bool is_divided(FaceId f) const { return below != nullptr && choice->red[f] != 0; }
  /// Returns the first child of a divided face.
  [[nodiscard]] uint32_t child(FaceId f) const { return below->choice->level->first_child_of(f); }
};

/// Traversal of the levels' faces that writes the result. Each edge of the result has a number, its slot, which
/// both its faces can compute, whatever their levels. The first face stores its half-edge in the slot; the second
/// finds its twin there.
class Assembler {
 public:
  explicit Assembler(std::span<const LevelChoice> levels) : coarse_(levels[0].level->mesh) {
    const Topology& coarse = coarse_.topology;
    uint32_t vertices = coarse.vertex_count;
    size_t divided = 0;  // upper bound of the number of divided faces
    for (const LevelChoice& choice : levels) {
      vertices += static_cast<uint32_t>(choice.split_edges.size());
      if (&choice != levels.data()) divided += choice.region.faces.size() / 4;
    }
    Topology& topology = out_.topology;
    topology.vertex_count = vertices;
    topology.pinched = coarse.pinched;
    topology.darts = coarse.darts;
    topology.shape = coarse.shape;
    const uint32_t half_edges = 3 * static_cast<uint32_t>(count_assembled(levels));
    topology.origin.resize_for_overwrite(half_edges);
    topology.twin.resize_for_overwrite(size_t{half_edges} + 1);
    sentinel_ = half_edges;
    origin_ = topology.origin.data();
    twin_ = topology.twin.data();
    add_vertices(levels);
    // Two slots for each vertex, as if each were on a split edge; then those of the coarse edges, and three for each
    // divided face.
    first_coarse_ = 2 * vertices;
    next_inner_ = first_coarse_ + coarse.edge_count();
    slots_.assign(next_inner_ + 3 * divided, sentinel_);
  }

  Mesh run(bool with_edges, std::span<const Displacements> displaced) {
    const Topology& coarse = coarse_.topology;
    for (FaceId f = 0; f < coarse.face_count(); ++f) {
      const uint32_t* edge = &coarse.edge[size_t{3} * f];
      const OfSides side{first_coarse_ + edge[0], first_coarse_ + edge[1], first_coarse_ + edge[2]};
      place(levels_[0], f, &coarse.origin[size_t{3} * f], side.data());
    }
    out_.topology.origin.resize_for_overwrite(half_edge_count_);
    out_.topology.twin.resize_for_overwrite(half_edge_count_);
    for (const OnCurve& on : on_curves_)
      if (on.kind != EdgeKind::crease) out_.topology.twin[on.half_edge] = none;
    if (with_edges) number_edges();
    if (!coarse_.attributes.empty()) make_points(displaced);
    return std::move(out_);
  }

 private:
  /// Half-edge of the result that lies on a curve.
  struct OnCurve {
    uint32_t half_edge;
    EdgeKind kind;
  };

  void add_vertices(std::span<const LevelChoice> levels) {
    out_.positions.resize_for_overwrite(out_.topology.vertex_count);
    std::ranges::copy(coarse_.positions, out_.positions.begin());
    uint32_t vertex = coarse_.topology.vertex_count;
    levels_.reserve(levels.size());
    has_curves_or_points_ = !levels[0].level->features.curve_half_edges.empty() || !coarse_.attributes.empty();
    for (const LevelChoice& choice : levels) {
      const Topology& mesh = choice.level->mesh.topology;
      AssembledLevel& level = levels_.emplace_back();
      level.choice = &choice;
      level.mesh = &mesh;
      if (levels_.size() > 1) levels_[levels_.size() - 2].below = &level;  // reserved: its address is stable
      level.edge = mesh.edge.data();
      level.new_vertex.resize_for_overwrite(mesh.edge_count());
      for (EdgeId e : marked(choice.split)) {
        out_.positions[vertex] = choice.level->trial.at(e);
        level.new_vertex[e] = vertex++;
      }
    }
  }

  /// Writes the result of a face and of the faces below it. `corner` [3]: its corners in the result; `side` [3]: slots
  /// of its sides, used if not split. (Inlined separately for each child: this improves branch prediction.)
  [[gnu::always_inline]] void place(AssembledLevel& level, FaceId f, const uint32_t* corner, const uint32_t* side) {
    const unsigned mask = level.choice->split_mask(f);
    if (mask == 0)
      place_whole(level, f, corner, side);
    else if (mask != 7)
      cut_in_part(level, f, mask, corner, side);
    else if (level.is_divided(f))
      place_children(level, f, corner);
    else  // with children as support only: cut into the same four
      cut_in_four(level, f, corner);
  }

  void place_whole(AssembledLevel& level, FaceId f, const uint32_t* corner, const uint32_t* side) {
    const uint32_t made = half_edge_count_;
    put(origin_ + made, corner[0], corner[1], corner[2]);
    put(twin_ + made, meet(side[0], made), meet(side[1], made + 1), meet(side[2], made + 2));
    end_face(level, f, split_pattern(0, false));
  }

  [[gnu::noinline]] void place_children(AssembledLevel& level, FaceId f, const uint32_t* corner) {
    if (!coarse_.attributes.empty()) remember(level, f, nullptr);
    const OfSides middle = middles(level, f);
    AssembledLevel& below = *level.below;
    const uint32_t child = level.child(f);
    std::array<uint32_t, 12> corners;
    put_corners_of_four({corner[0], corner[1], corner[2]}, middle, corners.data());
    const Halves half = halves(corner, middle);
    std::array<uint32_t, 12> sides;
    put_edges_of_four(half.first, half.second, next_inner_, sides.data());
    next_inner_ += 3;
    place(below, child, corners.data(), sides.data());
    place(below, child + 1, &corners[3], &sides[3]);
    place(below, child + 2, &corners[6], &sides[6]);
    place(below, child + 3, &corners[9], &sides[9]);
  }

  void cut_in_four(AssembledLevel& level, FaceId f, const uint32_t* corner) {
    const uint32_t made = half_edge_count_;
    const OfSides middle = middles(level, f);
    const Halves half = halves(corner, middle);
    put_corners_of_four({corner[0], corner[1], corner[2]}, middle, origin_ + made);
    const OfSides against_first{meet(half.first[0], made), meet(half.first[1], made + 4),
                                meet(half.first[2], made + 8)};
    const OfSides against_second{meet(half.second[0], made + 3), meet(half.second[1], made + 7),
                                 meet(half.second[2], made + 2)};
    put_twins_of_four(made, against_first, against_second, twin_ + made);
    end_face(level, f, split_pattern(7, false));
  }

  /// Face with one or two split sides, from the first of them, which runs from corner a to b.
  struct CutFace {
    CutFace(const AssembledLevel& level, FaceId f, unsigned mask, const uint32_t* corners, const uint32_t* sides) {
      const uint8_t* number = &turned[first_target[mask]];
      a = corners[number[0]];
      b = corners[number[1]];
      c = corners[number[2]];
      side_bc = sides[number[1]];
      side_ca = sides[number[2]];
      on_ab = level.new_vertex[level.edge[3 * f + number[0]]];
      edge_bc = level.edge[3 * f + number[1]];
    }
    uint32_t a, b, c;
    uint32_t side_bc, side_ca;  ///< slots
    uint32_t on_ab;             ///< new vertex of side ab
    uint32_t edge_bc;           ///< edge bc of the level
  };

  /// Cuts a face with one or two split sides.
  void cut_in_part(AssembledLevel& level, FaceId f, unsigned mask, const uint32_t* corner, const uint32_t* side) {
    const bool second_diagonal = takes_second_diagonal(*level.choice, f, mask);
    const CutFace face(level, f, mask, corner, side);
    if (has_two_targets(mask))
      cut_in_three(level, face, second_diagonal);
    else
      cut_in_two(face);
    end_face(level, f, split_pattern(mask, second_diagonal));
  }

  /// Cuts a face in two. The pieces are those of split_pattern.cpp, in their order.
  void cut_in_two(const CutFace& face) {
    const auto& [a, b, c, side_bc, side_ca, on_ab, edge_bc] = face;
    const uint32_t made = half_edge_count_;
    const uint32_t first = first_half(on_ab, a, b);
    put(origin_ + made, a, on_ab, c, on_ab, b, c);
    put(twin_ + made, meet(first, made), made + 5, meet(side_ca, made + 2),  //
        meet(first ^ 1, made + 3), meet(side_bc, made + 4), made + 1);
  }

  /// Cuts a face in three pieces, in the order of split_pattern.cpp. Branch-free: the diagonal is unpredictable.
  void cut_in_three(const AssembledLevel& level, const CutFace& face, bool second_diagonal) {
    const auto& [a, b, c, side_bc, side_ca, on_ab, edge_bc] = face;
    const uint32_t made = half_edge_count_;
    const uint32_t on_bc = level.new_vertex[edge_bc];
    const uint32_t first_of_ab = first_half(on_ab, a, b);
    const uint32_t first_of_bc = first_half(on_bc, b, c);
    const uint32_t all = second_diagonal ? ~0U : 0U;
    const auto choose = [all](uint32_t first, uint32_t second) { return (second & all) | (first & ~all); };
    put(origin_ + made, on_ab, b, on_bc, a, on_ab, choose(on_bc, c), choose(a, on_ab), on_bc, c);
    const uint32_t against_ca = meet(side_ca, made + choose(8, 5));
    put(twin_ + made, meet(first_of_ab ^ 1, made), meet(first_of_bc, made + 1), made + choose(4, 6),  //
        meet(first_of_ab, made + 3), made + choose(2, 8), choose(made + 6, against_ca),               //
        made + choose(5, 2), meet(first_of_bc ^ 1, made + 7), choose(against_ca, made + 4));
  }

  /// Returns the new vertices of a face's sides; undefined for unsplit sides.
  [[nodiscard]] static OfSides middles(const AssembledLevel& level, FaceId f) {
    const uint32_t* edge = &level.edge[size_t{3} * f];
    return {level.new_vertex[edge[0]], level.new_vertex[edge[1]], level.new_vertex[edge[2]]};
  }

  /// Slots of the halves of split sides.
  struct Halves {
    OfSides first, second;
  };
  /// Returns the slot of the half at `from` of a side with this new vertex; the other half is slot ^ 1. The half at the
  /// lower vertex comes first, so both faces at a side agree.
  [[nodiscard]] static uint32_t first_half(uint32_t middle, uint32_t from, uint32_t to) {
    return 2 * middle + (from > to ? 1 : 0);
  }
  [[nodiscard]] static Halves halves(const uint32_t* corner, const OfSides& middle) {
    const OfSides first{first_half(middle[0], corner[0], corner[1]), first_half(middle[1], corner[1], corner[2]),
                        first_half(middle[2], corner[2], corner[0])};
    return {first, {first[0] ^ 1, first[1] ^ 1, first[2] ^ 1}};
  }

  /// Stores a half-edge in a slot, and makes it the twin of the previous value. Returns that value: its
  /// twin, or `sentinel_`.
  uint32_t meet(uint32_t slot, uint32_t half_edge) {
    const uint32_t other = slots_[slot];
    slots_[slot] = half_edge;
    twin_[other] = half_edge;
    return other;
  }

  /// Ends a face that was cut by this pattern.
  void end_face(AssembledLevel& level, FaceId f, const SplitPattern& cut) {
    if (has_curves_or_points_) [[unlikely]]
      remember_more(level, f, cut);
    half_edge_count_ += 3U * cut.children;
  }

  void remember_more(AssembledLevel& level, FaceId f, const SplitPattern& cut) {
    if (!coarse_.attributes.empty()) remember(level, f, &cut);
    find_curves(level, f, cut);
  }
  void remember(AssembledLevel& level, FaceId f, const SplitPattern* cut) const {
    level.shown.push_back(f);
    level.pieces.push_back({half_edge_count_, cut});
  }

  void find_curves(const AssembledLevel& level, FaceId f, const SplitPattern& cut) {
    for (uint32_t c = 0; c < 3U * cut.children; ++c) {
      if (!cut.is_outside(c)) continue;
      const EdgeKind kind = level.mesh->kind[level.edge[3 * f + cut.edge[c] / 2]];
      if (kind != EdgeKind::smooth) on_curves_.push_back({half_edge_count_ + c, kind});
    }
  }

  void number_edges() {
    Topology& mesh = out_.topology;
    std::vector<uint32_t> darts = std::move(mesh.darts);
    papilio::number_edges(mesh);
    mesh.darts = std::move(darts);
    for (const OnCurve& on : on_curves_)
      if (on.kind == EdgeKind::crease) mesh.kind[mesh.edge[on.half_edge]] = EdgeKind::crease;
  }

  /// Computes the points of each shown face's corners, top down.
  void make_points(std::span<const Displacements> displaced) {
    out_.attributes = coarse_.attributes;
    auto result = Buffer<uint32_t>::for_overwrite(half_edge_count_);
    const Displacements nothing;
    for (size_t k = 0; k < levels_.size(); ++k) {
      const AssembledLevel& level = levels_[k];
      const Buffer<uint32_t> made = split_points(*level.mesh, level.choice->split, IndexRange(level.shown),
                                                 out_.attributes, displaced.empty() ? nothing : displaced[k]);
      const Buffer<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](FaceId f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(level.below != nullptr ? level.below->mesh->half_edge_count() : 0, none);
      for (size_t i = 0; i < level.shown.size(); ++i) {
        const FaceId f = level.shown[i];
        const auto& [first, cut_in_result] = level.pieces[i];
        const bool divided = cut_in_result == nullptr;
        const SplitPattern& cut = divided ? split_pattern(7, false) : *cut_in_result;
        uint32_t* out = divided ? &out_.attributes.point[3 * size_t{level.child(f)}] : &result[first];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  const Mesh& coarse_;
  std::vector<AssembledLevel> levels_;
  bool has_curves_or_points_ = false;
  uint32_t half_edge_count_ = 0;  ///< number of half-edges written
  uint32_t *origin_, *twin_;      ///< arrays of the result
  Buffer<uint32_t> slots_;        ///< half-edges of the result, or `sentinel_`
  uint32_t first_coarse_, next_inner_;
  uint32_t sentinel_;  ///< half-edge after the last of the result
  Buffer<OnCurve> on_curves_;
  Mesh out_;
};

}  // namespace

uint64_t count_assembled(std::span<const LevelChoice> levels) {
  // All faces at a split edge are in the result: each adds one face.
  uint64_t faces = levels[0].region.faces.size();
  for (const LevelChoice& choice : levels) faces += choice.count_faces_of_split();
  return faces;
}

Mesh assemble(std::span<const LevelChoice> levels, bool with_edges, std::span<const Displacements> displaced) {
  return Assembler(levels).run(with_edges, displaced);
}

}  // namespace papilio
