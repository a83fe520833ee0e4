#include "tests/soak/world.h"

#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/soak/queries.h"
#include "tests/support/shapes.h"

namespace papilio::soak {
namespace {

constexpr int small_orders = 60;
constexpr int medium_orders = 8;

Order make_order(const std::string& mesh, const std::string& query) {
  Order order{&mesh, query, proto::parse_query(fields_of(query)), {}};
  order.answer = proto::Refinement(mesh, order.parameters, {}).run().bytes;
  return order;
}

}  // namespace

World::World(int port, uint64_t max_body_bytes, std::string coarse, uint32_t seed)
    : port_(port), max_body_bytes_(max_body_bytes), coarse_(std::move(coarse)) {
  std::mt19937 random(seed);
  tiny_ = proto::write_draco_exact(test::torus(8, 6));
  for (int i = 0; i < small_orders; ++i)
    small_.push_back(make_order(i % 2 == 0 ? coarse_ : tiny_, random_query(random, 2)));
  for (int i = 0; i < medium_orders; ++i)
    medium_.push_back(make_order(coarse_, "levels=4&output.speed=" + std::to_string(i + 2)));
}

std::string World::own_mesh(std::mt19937& random) {
  TriangleMesh mesh = test::octahedron();
  std::uniform_real_distribution<float> move(-0.1F, 0.1F);
  for (Vec3f& p : mesh.positions) p += Vec3f{move(random), move(random), move(random)};
  return proto::write_draco_exact(mesh);
}

}  // namespace papilio::soak
