#include <cmath>
#include <memory>
#include <numbers>

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// A camera orbits a mesh of 10,000 vertices in steps of ten degrees: each view refined from the stored mesh, compared
// with a cold request. The stored mesh has served one orbit of views offset by five degrees, or, for "first round",
// only the earlier views of the same orbit.

namespace papilio::bench {
namespace {

constexpr const char* mesh_name = "cgal/ChineseDragon-10kv.off";
constexpr uint64_t byte_budget = 256 << 20;
constexpr int steps = 36;

class Orbit {
 public:
  Orbit(proto::QueryFields criteria, bool whole, bool first_round)
      : criteria_(std::move(criteria)), whole_(whole), first_round_(first_round) {
    const TriangleMesh mesh = test::real_mesh(mesh_name);
    draco_ = proto::write_draco_exact(mesh);
    const Box box = bounding_box(mesh.positions);
    target_ = 0.5 * (to_double(box.min) + to_double(box.max));
    distance_ = 1.2 * box.diagonal();
  }

  /// Return the seconds of the next view's request or of its refinement: cold, or from the stored mesh.
  double turn_cold() {
    cold_step_ = cold_step_ % steps + 1;
    return time_of([&] { return proto::Refinement(draco_, at(cold_step_), {}).run(); });
  }
  double turn_stored() {
    if (stored_ == nullptr || (first_round_ && stored_step_ == steps)) store();
    stored_step_ = stored_step_ % steps + 1;
    return time_of([&] { return ask_stored(stored_step_); });
  }

 private:
  [[nodiscard]] proto::Parameters at(double step) const {
    const double angle = 2 * std::numbers::pi * step / steps;
    const Vec3d eye = target_ + distance_ * Vec3d{std::sin(angle), 0.3, std::cos(angle)};
    proto::QueryFields fields = criteria_;
    fields.emplace_back("view.eye", text(eye));
    fields.emplace_back("view.target", text(target_));
    return proto::parse_query(fields);
  }
  static std::string text(Vec3d p) {
    return std::to_string(p.x) + ',' + std::to_string(p.y) + ',' + std::to_string(p.z);
  }

  [[nodiscard]] proto::EncodedLevel ask_stored(double step) const {
    return proto::Refinement(stored_, at(step), {}).run();
  }
  /// Creates the stored mesh and serves its earlier views, untimed.
  void store() {
    stored_ = std::make_shared<const proto::SharedMesh>(draco_, proto::Limits{}, byte_budget);
    if (first_round_)
      (void)ask_stored(0);
    else
      for (int step = 0; step < steps; ++step) (void)ask_stored(step + 0.5);
  }

  [[nodiscard]] double time_of(const std::function<proto::EncodedLevel()>& request) const {
    proto::EncodedLevel level;
    const double all = seconds([&] { level = request(); });
    return whole_ ? all : level.statistics.times.refine / 1e3;
  }

  proto::QueryFields criteria_;
  bool whole_, first_round_;
  std::string draco_;
  Vec3d target_;
  double distance_ = 0;
  std::shared_ptr<const proto::SharedMesh> stored_;
  int cold_step_ = 0, stored_step_ = 0;
};

void add_orbit(const std::string& name, const proto::QueryFields& criteria, bool whole, bool first_round) {
  const auto orbit = std::make_shared<Orbit>(criteria, whole, first_round);
  std::string row = "view_change/" + name;
  if (!whole) row += "/refinement";
  if (first_round) row += "/first round";
  add({.name = row,
       .divisor = 1e6,
       .unit = "ms",
       .ours = [orbit] { return orbit->turn_stored(); },
       .peer = [orbit] { return orbit->turn_cold(); }});
}

}  // namespace

void add_view_change() {
  const proto::QueryFields verified{{"levels", "3"}, {"view.error_pixels", "0.5"}, {"view.edge_pixels", "0"}};
  proto::QueryFields by_error = verified;
  by_error.emplace_back("view.verify", "false");
  const proto::QueryFields by_flatness{{"levels", "3"}, {"flatness", "0.8,0.9,0.95"}, {"view.edge_pixels", "4"}};
  for (bool whole : {true, false})
    for (bool first_round : {false, true}) {
      add_orbit("error_pixels", by_error, whole, first_round);
      add_orbit("flatness", by_flatness, whole, first_round);
    }
  add_orbit("error_pixels verified", verified, false, false);
}

}  // namespace papilio::bench
