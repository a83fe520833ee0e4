#include "detail/linear_stencils.h"

#include <map>

#include "mesh/fan.h"
#include "rules/stencil.h"

namespace papilio {
namespace {

class Builder {
 public:
  explicit Builder(const Topology& level) : level_(level), valence_(level.vertex_count, 0) {
    for (const uint32_t v : level.origin) ++valence_[v];
  }

  LinearStencils build() {
    made_.first.reserve(size_t{level_.edge_count()} + 1);
    made_.first.push_back(0);
    for (const uint32_t h : level_.half_edge) {
      add_edge(h);
      made_.first.push_back(static_cast<uint32_t>(made_.vertex.size()));
    }
    return std::move(made_);
  }

 private:
  void add(uint32_t vertex, double weight) {
    made_.vertex.push_back(vertex);
    made_.weight.push_back(static_cast<float>(weight));
  }

  void add_edge(uint32_t h) {
    const uint32_t t = level_.twin[h];
    const bool a = valence_[level_.origin[h]] == stencil::regular_valence;
    const bool b = valence_[level_.origin[t]] == stencil::regular_valence;
    if (a && b) return add_regular(h, t);
    const double share = a || b ? 1 : 0.5;
    if (!a) add_interior(h, share);
    if (!b) add_interior(t, share);
  }

  void add_regular(uint32_t h, uint32_t t) {
    const stencil::Regular<double> row;
    add(level_.origin[h], row.end);
    add(level_.origin[t], row.end);
    for (const uint32_t side : {h, t}) {
      add(level_.apex(side), row.apex);
      add(level_.apex(level_.twin[Topology::next(side)]), row.wing);
      add(level_.apex(level_.twin[Topology::previous(side)]), row.wing);
    }
  }

  void add_interior(uint32_t h, double share) {
    collect_fan(level_, h, fan_);
    const stencil::Interior& row = interior(fan_.valence());
    add(fan_.centre, share * row.centre);
    for (uint32_t j = 0; j < fan_.valence(); ++j) add(fan_.ring[j], share * row.ring[j]);
  }

  const stencil::Interior& interior(uint32_t valence) {
    auto [found, is_new] = interiors_.try_emplace(valence);
    if (is_new) found->second = stencil::interior(valence);
    return found->second;
  }

  const Topology& level_;
  std::vector<uint32_t> valence_;
  std::map<uint32_t, stencil::Interior> interiors_;
  Fan fan_;
  LinearStencils made_;
};

}  // namespace

LinearStencils linear_stencils(const Topology& level) { return Builder(level).build(); }

}  // namespace papilio
