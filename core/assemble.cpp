#include "assemble.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "attributes.h"
#include "four_children.h"
#include "split_in_four.h"
#include "transition.h"

namespace papilio {
namespace {

/// A level, and what becomes of its faces. Levels lie in an array: the one above is before, the one below behind.
struct AssembledLevel {
  static constexpr uint8_t hidden = 255;         ///< not in the result, nor its children
  static constexpr uint8_t divided = 254;        ///< its children are
  static constexpr uint8_t cut_in_four = 2 * 7;  ///< a pattern's number, as below

  const LevelChoice* choice;
  const HierarchyLevel* level;
  const Topology* mesh;
  uint32_t number;
  bool has_below;
  const uint32_t *twin, *edge;  ///< [H] of the mesh
  const uint8_t* is_split;      ///< [E]
  List<uint8_t> fate;           ///< [F] hidden, divided, or the number of its pattern
  Array<uint32_t> first;        ///< [F] the first half-edge of its faces in the result; written where these are there
  Array<uint32_t> new_vertex;   ///< [E] number in the result of the edge's vertex; written where split
  List<uint32_t> shown;         ///< the faces that are not hidden, in ascending order; with attributes only

  [[nodiscard]] bool is_shown(uint32_t f) const { return fate[f] != hidden; }
  [[nodiscard]] bool is_divided(uint32_t f) const { return fate[f] == divided; }
  /// The first child of a divided face.
  [[nodiscard]] uint32_t child(uint32_t f) const { return this[1].level->child[f]; }
};

/// Most are already: what was wanted, and behind it what that needs.
List<uint32_t> in_order(List<uint32_t> numbers) {
  const auto behind = std::ranges::is_sorted_until(numbers);
  std::sort(behind, numbers.end());
  std::inplace_merge(numbers.begin(), behind, numbers.end());
  return numbers;
}

class Assembler {
 public:
  Assembler(std::span<const LevelChoice> levels, double most_cosine, bool with_edges)
      : most_cosine_(most_cosine), with_edges_(with_edges), coarse_(levels[0].level->mesh) {
    const Topology& coarse = coarse_.topology;
    uint32_t vertices = coarse.vertex_count;
    for (const LevelChoice& choice : levels) vertices += static_cast<uint32_t>(choice.split_edges.size());
    out_.topology.vertex_count = vertices;
    const uint64_t faces = count_assembled(levels);
    out_.topology.origin.resize(3 * faces + 12);
    places_.reserve(faces);
    out_.positions.resize(vertices);
    std::ranges::copy(coarse_.positions, out_.positions.begin());
    vertex_count_ = coarse.vertex_count;
    levels_.reserve(levels.size());
    for (const LevelChoice& choice : levels) add_level(choice, levels_.size() + 1 < levels.size());
    for (uint32_t f = 0; f < coarse.face_count(); ++f)
      place(levels_[0], f, {coarse.origin[3 * f], coarse.origin[3 * f + 1], coarse.origin[3 * f + 2]});
  }

  Mesh run() {
    Topology& topology = out_.topology;
    topology.pinched = coarse_.topology.pinched;
    topology.darts = coarse_.topology.darts;
    topology.origin.resize(half_edge_count_);
    topology.twin.resize(size_t{half_edge_count_} + 12);
    if (with_edges_) {
      topology.edge.resize(half_edge_count_);
      topology.half_edge.reserve(half_edge_count_ / 2 + topology.vertex_count / 2);
      topology.kind.reserve(topology.half_edge.capacity());
    }
    for (const Place& place : places_)
      if (place.are_all_in_four)
        connect_sixteen(levels_[place.level], place.face);
      else
        connect(levels_[place.level], place.face);
    topology.twin.resize(half_edge_count_);
    if (!coarse_.attributes.empty()) make_points();
    return std::move(out_);
  }

 private:
  /// A face of a level that is in the result, whole or cut.
  struct Place {
    uint16_t level;
    bool are_all_in_four;  ///< it is the first of the four children of one face, and each of them is cut in four
    uint32_t face;
  };

  void add_level(const LevelChoice& choice, bool has_below) {
    const Topology& mesh = choice.level->mesh.topology;
    AssembledLevel& level = levels_.emplace_back();
    level.choice = &choice;
    level.level = choice.level.get();
    level.mesh = &mesh;
    level.number = static_cast<uint32_t>(levels_.size() - 1);
    level.has_below = has_below;
    level.twin = mesh.twin.data();
    level.edge = mesh.edge.data();
    level.is_split = choice.split.data();
    level.fate.assign(mesh.face_count(), AssembledLevel::hidden);
    level.first.resize(mesh.face_count());
    level.new_vertex.resize(mesh.edge_count());
    for (uint32_t e : in_order(choice.split_edges)) {
      out_.positions[vertex_count_] = level.level->trial.at(e);
      level.new_vertex[e] = vertex_count_++;
    }
  }

  /// What becomes of a face and of what lies below it, and where that lies in the result. `corner`: its corners there.
  void place(AssembledLevel& level, uint32_t f, const OfSides& corner) {
    if (!coarse_.attributes.empty()) level.shown.push_back(f);
    const unsigned mask = level.choice->split_mask(f);
    if (mask == 0) {
      level.fate[f] = 0;
      std::ranges::copy(corner, begin_faces(level, f, 1));
      return;
    }
    const uint32_t* edge = &level.edge[size_t{3} * f];
    const OfSides middle{level.new_vertex[edge[0]], level.new_vertex[edge[1]], level.new_vertex[edge[2]]};
    if (mask == 7) {
      // What has children as support only is cut into the same four.
      if (level.has_below && level.choice->red[f] != 0) {
        level.fate[f] = AssembledLevel::divided;
        AssembledLevel& below = (&level)[1];
        const uint32_t child = level.child(f);
        if (are_all_in_four(below, child)) {
          place_sixteen(below, child, corner, middle);
          return;
        }
        place(below, child, {corner[0], middle[0], middle[2]});
        place(below, child + 1, {middle[0], corner[1], middle[1]});
        place(below, child + 2, {middle[2], middle[1], corner[2]});
        place(below, child + 3, middle);
      } else {
        level.fate[f] = AssembledLevel::cut_in_four;
        put_corners_of_four(corner, middle, begin_faces(level, f, 4));
      }
      return;
    }
    level.fate[f] = choose_transition(*level.level, f, mask, most_cosine_);
    const SplitPattern& cut = transition_pattern(level.fate[f]);
    // Middles are there or not: the pattern knows.
    const std::array<uint32_t, 6> vertex{corner[0], corner[1], corner[2], middle[0], middle[1], middle[2]};
    uint32_t* out = begin_faces(level, f, cut.children);
    for (const auto& child : cut.corner)
      for (uint8_t local : child) *out++ = vertex[local];
  }

  /// Whether each of the four children of a face is cut in four: most are where much is refined, and all at once costs
  /// less. (Not where edges are numbered.)
  [[nodiscard]] bool are_all_in_four(const AssembledLevel& level, uint32_t child) const {
    if (level.has_below || with_edges_) return false;
    const uint32_t* edge = &level.edge[size_t{3} * child];
    uint8_t all = 1;
    for (uint32_t i = 0; i < 12; ++i) all &= level.is_split[edge[i]];
    return all != 0;
  }

  /// `corner` and `middle` of their parent.
  void place_sixteen(AssembledLevel& level, uint32_t child, const OfSides& corner, const OfSides& middle) {
    std::array<uint32_t, 12> corners;
    put_corners_of_four(corner, middle, corners.data());
    const uint32_t* edge = &level.edge[size_t{3} * child];
    places_.push_back({static_cast<uint16_t>(level.number), true, child});
    for (uint32_t c = 0; c < 4; ++c, edge += 3) {
      if (!coarse_.attributes.empty()) level.shown.push_back(child + c);
      level.fate[child + c] = AssembledLevel::cut_in_four;
      level.first[child + c] = half_edge_count_;
      put_corners_of_four({corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]},
                          {level.new_vertex[edge[0]], level.new_vertex[edge[1]], level.new_vertex[edge[2]]},
                          &out_.topology.origin[half_edge_count_]);
      half_edge_count_ += 12;
    }
  }

  /// What a face is, or is cut into, comes next in the result. Returns where the corners of these so many faces go;
  /// there is always room for four faces: how many there are nobody can guess, so that many are written, and what was
  /// too much is written over by the next.
  uint32_t* begin_faces(AssembledLevel& level, uint32_t f, uint32_t count) {
    uint32_t* out = &out_.topology.origin[half_edge_count_];
    level.first[f] = half_edge_count_;
    places_.push_back({static_cast<uint16_t>(level.number), false, f});
    half_edge_count_ += 3 * count;
    return out;
  }

  /// Finds the twins of the faces in the result that a face is or is cut into, and their edges.
  void connect(const AssembledLevel& level, uint32_t f) {
    if (level.fate[f] == 0) {
      connect_whole(level, f);
      return;
    }
    const SplitPattern& cut = transition_pattern(level.fate[f]);
    const uint32_t base = level.first[f];
    const std::array<uint32_t, 7> against = find_twins(level, f);
    uint32_t* twin = &out_.topology.twin[base];
    if (level.fate[f] == AssembledLevel::cut_in_four)
      put_twins_of_four(base, {against[0], against[2], against[4]}, {against[1], against[3], against[5]}, twin);
    else
      for (uint32_t c = 0; c < 12; ++c) twin[c] = against[cut.twin_from[c]] + cut.twin_step[c];  // as many as above
    if (!with_edges_) return;
    for (uint32_t c = 0; c < 3U * cut.children; ++c)
      number_edge(base + c,
                  cut.is_outside(c) ? level.mesh->kind[level.edge[3 * f + cut.edge[c] / 2]] : EdgeKind::smooth);
  }

  /// The same for the four children of a face that place_sixteen() has placed.
  void connect_sixteen(const AssembledLevel& level, uint32_t child) {
    const uint32_t base = level.first[child];
    // Against the halves of the twelve half-edges of the four; between the four it is known.
    std::array<Halves, 12> against{};
    for (const auto& [h, twin] : {std::array<uint32_t, 2>{1, 11}, {5, 9}, {6, 10}}) {
      against[h] = {base + second_half(twin), base + first_half(twin)};
      against[twin] = {base + second_half(h), base + first_half(h)};
    }
    for (const uint32_t h : {0, 2, 3, 4, 7, 8}) against[h] = find_twins_of_halves(level, 3 * child + h);
    for (uint32_t c = 0; c < 4; ++c) {
      const Halves* of_child = &against[size_t{3} * c];
      put_twins_of_four(base + 12 * c, {of_child[0].first, of_child[1].first, of_child[2].first},
                        {of_child[0].second, of_child[1].second, of_child[2].second},
                        &out_.topology.twin[base + 12 * c]);
    }
  }

  /// The same for a face that is not cut.
  void connect_whole(const AssembledLevel& level, uint32_t f) {
    const uint32_t base = level.first[f];
    for (uint32_t i = 0; i < 3; ++i) out_.topology.twin[base + i] = find_twin(level, 3 * f + i);
    if (!with_edges_) return;
    for (uint32_t i = 0; i < 3; ++i) number_edge(base + i, level.mesh->kind[level.edge[3 * f + i]]);
  }

  /// What runs in the result against a half-edge that is not split.
  [[nodiscard]] static uint32_t find_twin(const AssembledLevel& level, uint32_t h) {
    const uint32_t t = level.twin[h];
    if (t == none || level.fate[Topology::face(t)] >= AssembledLevel::divided) return twin_in_result(level, h, 0);
    return level.first[Topology::face(t)] + transition_pattern(level.fate[Topology::face(t)]).outer[2 * (t % 3)];
  }

  /// What runs in the result against the halves of a face's split sides, against the whole of the others:
  /// [2 * side + half]; and behind these the face's own first half-edge.
  [[nodiscard]] static std::array<uint32_t, 7> find_twins(const AssembledLevel& level, uint32_t f) {
    std::array<uint32_t, 7> twins{};
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t h = 3 * f + i;
      const uint32_t t = level.twin[h];
      const unsigned is_split = level.fate[f] >> (i + 1) & 1U;  // by the mask, twice the pattern's number
      if (t != none && level.fate[Topology::face(t)] < AssembledLevel::divided) {
        const auto& outer = transition_pattern(level.fate[Topology::face(t)]).outer;
        const uint32_t base = level.first[Topology::face(t)];
        twins[2 * i] = base + outer[2 * (t % 3) + is_split];
        twins[2 * i + 1] = base + outer[2 * (t % 3)];
      } else {
        twins[2 * i] = twin_in_result(level, h, 0);
        if (is_split != 0) twins[2 * i + 1] = twin_in_result(level, h, 1);
      }
    }
    twins[6] = level.first[f];
    return twins;
  }

  /// What runs in the result against the two halves of a half-edge that is split.
  struct Halves {
    uint32_t first, second;
  };
  [[nodiscard]] static Halves find_twins_of_halves(const AssembledLevel& level, uint32_t h) {
    const uint32_t t = level.twin[h];
    if (t == none || level.fate[Topology::face(t)] >= AssembledLevel::divided)
      return {twin_in_result(level, h, 0), twin_in_result(level, h, 1)};
    const uint8_t* outer = &transition_pattern(level.fate[Topology::face(t)]).outer[2 * (t % 3)];
    const uint32_t base = level.first[Topology::face(t)];
    return {base + outer[1], base + outer[0]};
  }

  /// In the order of the result: a half-edge whose twin was there before has its edge from it.
  void number_edge(uint32_t made, EdgeKind kind) {
    Topology& mesh = out_.topology;
    const uint32_t twin = mesh.twin[made];
    if (twin < made) {
      mesh.edge[made] = mesh.edge[twin];
      return;
    }
    mesh.edge[made] = mesh.edge_count();
    if (twin == none && kind == EdgeKind::shared) {
      const auto [known, is_new] = shared_.try_emplace(std::minmax(mesh.origin[made], mesh.tip(made)), mesh.edge[made]);
      mesh.edge[made] = known->second;
      if (!is_new) return;
    }
    mesh.half_edge.push_back(made);
    mesh.kind.push_back(kind);
  }

  /// What runs against the first or second half (or the whole) of half-edge h of an undivided face.
  [[nodiscard]] static uint32_t twin_in_result(const AssembledLevel& level, uint32_t h, uint32_t half) {
    const uint32_t t = level.twin[h];
    if (t != none && level.is_shown(Topology::face(t)))
      return half_edge_in_result(level, t, level.is_split[level.edge[h]] != 0 ? 1 - half : 0);
    const EdgeKind kind = level.mesh->kind[level.edge[h]];
    if (level.number == 0 || kind == EdgeKind::boundary || kind == EdgeKind::shared) return none;
    // It lies on the outside of its parent, and is a half of one of that one's.
    const uint32_t f = Topology::face(h);
    const uint8_t outer = split_pattern(7, false).edge[3 * (f % 4) + h % 3];
    const AssembledLevel& above = (&level)[-1];
    return half_edge_in_result(above, above.twin[3 * level.level->parent[f / 4] + outer / 2U], 1 - outer % 2U);
  }

  /// The half-edge of the result that is the first or second half (or the whole) of half-edge h of a shown face.
  [[nodiscard]] static uint32_t half_edge_in_result(const AssembledLevel& level, uint32_t h, uint32_t half) {
    const AssembledLevel* at = &level;
    while (at->is_divided(Topology::face(h))) {
      h = 3 * at->child(Topology::face(h)) + split_pattern(7, false).outer[2 * (h % 3) + half];
      half = 0;
      ++at;
    }
    const uint32_t f = Topology::face(h);
    return at->first[f] + transition_pattern(at->fate[f]).outer[2 * (h % 3) + half];
  }

  /// Top down: the points of each shown face's corners.
  void make_points() {
    out_.attributes = coarse_.attributes;
    Array<uint32_t> result(half_edge_count_);
    for (const AssembledLevel& level : levels_) {
      const List<uint32_t> made = split_points(*level.mesh, level.choice->split, level.shown, out_.attributes);
      const Array<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](uint32_t f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(level.has_below ? (&level)[1].mesh->half_edge_count() : 0, none);
      for (uint32_t f : level.shown) {
        const bool divided = level.is_divided(f);
        const SplitPattern& cut = divided ? split_pattern(7, false) : transition_pattern(level.fate[f]);
        uint32_t* out = divided ? &out_.attributes.point[3 * size_t{level.child(f)}] : &result[level.first[f]];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  double most_cosine_;
  bool with_edges_;
  const Mesh& coarse_;
  std::vector<AssembledLevel> levels_;
  List<Place> places_;                               ///< in the order of the result
  uint32_t half_edge_count_ = 0, vertex_count_ = 0;  ///< so far
  Mesh out_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared_;  ///< edge of the result between two vertices
};

}  // namespace

uint64_t count_assembled(std::span<const LevelChoice> levels) {
  // A split edge may only be one all of whose faces are in the result: each of them becomes one more.
  uint64_t faces = levels[0].region.faces.size();
  for (const LevelChoice& choice : levels) faces += choice.count_faces_of_split();
  return faces;
}

Mesh assemble(std::span<const LevelChoice> levels, double most_cosine, bool with_edges) {
  return Assembler(levels, most_cosine, with_edges).run();
}

}  // namespace papilio
