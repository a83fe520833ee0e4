#include <cmath>
#include <memory>
#include <numbers>

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// A camera goes round a mesh of 10,000 vertices in steps of ten degrees: each view refined of the stored mesh, against
// the same request of its own. The stored mesh has served one round of views five degrees off, or, "first round", just
// the views before in the same round.

namespace papilio::bench {
namespace {

constexpr const char* mesh_name = "cgal/ChineseDragon-10kv.off";
constexpr uint64_t byte_budget = 256 << 20;
constexpr int steps = 36;

class Orbit {
 public:
  explicit Orbit(proto::QueryFields criteria) : criteria_(std::move(criteria)) {
    const TriangleMesh mesh = test::real_mesh(mesh_name);
    draco_ = proto::write_draco_exact(mesh);
    const Box box = bounding_box(mesh.positions);
    target_ = 0.5 * (to_double(box.min) + to_double(box.max));
    distance_ = 1.2 * box.diagonal();
  }

  [[nodiscard]] proto::Parameters at(double step) const {
    const double angle = 2 * std::numbers::pi * step / steps;
    const Vec3d eye = target_ + distance_ * Vec3d{std::sin(angle), 0.3, std::cos(angle)};
    proto::QueryFields fields = criteria_;
    fields.emplace_back("view.eye", text(eye));
    fields.emplace_back("view.target", text(target_));
    return proto::parse_query(fields);
  }
  [[nodiscard]] proto::EncodedLevel cold(int step) const { return proto::Refinement(draco_, at(step), {}).run(); }
  [[nodiscard]] proto::EncodedLevel stored(int step) const { return proto::Refinement(stored_, at(step), {}).run(); }
  void store() { stored_ = std::make_shared<const proto::PreparedMesh>(draco_, proto::Limits{}, byte_budget); }
  void serve_a_round() {
    store();
    for (int step = 0; step < steps; ++step) (void)proto::Refinement(stored_, at(step + 0.5), {}).run();
  }
  [[nodiscard]] bool is_stored() const { return stored_ != nullptr; }

 private:
  static std::string text(Vec3d p) {
    return std::to_string(p.x) + ',' + std::to_string(p.y) + ',' + std::to_string(p.z);
  }

  proto::QueryFields criteria_;
  std::string draco_;
  Vec3d target_;
  double distance_ = 0;
  std::shared_ptr<const proto::PreparedMesh> stored_;
};

/// Seconds of the whole request, or of the refinement in it.
double time_of(const std::function<proto::EncodedLevel()>& request, bool whole) {
  proto::EncodedLevel level;
  const double all = seconds([&] { level = request(); });
  return whole ? all : level.statistics.times.refine / 1e3;
}

void add_orbit(const std::string& name, const proto::QueryFields& criteria, bool whole, bool first_round) {
  const auto orbit = std::make_shared<Orbit>(criteria);
  const auto turn = [first_round, step = first_round ? 0 : -1]() mutable {
    step = (step + 1) % steps;
    return step;
  };
  add({.name = "view_change/" + name + (whole ? "" : "/refinement") + (first_round ? "/first round" : ""),
       .divisor = 1e6,
       .unit = "ms",
       .ours =
           [orbit, turn, whole, first_round]() mutable {
             int step = turn();
             if (!first_round && !orbit->is_stored()) orbit->serve_a_round();
             if (first_round && (step == 0 || !orbit->is_stored())) {
               orbit->store();
               (void)orbit->stored(0);
               step = step == 0 ? turn() : step;
             }
             return time_of([&] { return orbit->stored(step); }, whole);
           },
       .peer = [orbit, turn,
                whole]() mutable { return time_of([&, step = turn()] { return orbit->cold(step); }, whole); }});
}

}  // namespace

void add_view_change() {
  const proto::QueryFields by_error{{"levels", "3"}, {"view.error_pixels", "0.5"}, {"view.edge_pixels", "0"}};
  const proto::QueryFields by_flatness{{"levels", "3"}, {"flatness", "0.8,0.9,0.95"}, {"view.edge_pixels", "4"}};
  for (bool whole : {true, false})
    for (bool first_round : {false, true}) {
      add_orbit("error_pixels", by_error, whole, first_round);
      add_orbit("flatness", by_flatness, whole, first_round);
    }
}

}  // namespace papilio::bench
