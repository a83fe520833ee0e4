#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "papilio/mesh.h"
#include "proto/parameters.h"

namespace papilio::soak {

/// Refinement and its expected answer.
struct Order {
  const std::string* mesh;  ///< Draco
  std::string query;
  proto::Parameters parameters;
  std::string answer;  ///< expected bytes, by `proto::Refinement` in this process
};

/// Data shared by all clients; constant once they run.
class World {
 public:
  /// `coarse`: Draco mesh to refine.
  World(int port, uint64_t max_body_bytes, std::string coarse, uint32_t seed);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] uint64_t max_body_bytes() const { return max_body_bytes_; }
  [[nodiscard]] const std::string& coarse() const { return coarse_; }
  [[nodiscard]] const std::vector<Order>& small() const { return small_; }    ///< milliseconds each
  [[nodiscard]] const std::vector<Order>& medium() const { return medium_; }  ///< a tenth of a second or so each
  /// Returns a unique mesh: an octahedron with jittered vertices.
  [[nodiscard]] static std::string own_mesh(std::mt19937& random);

 private:
  int port_;
  uint64_t max_body_bytes_;
  std::string coarse_, tiny_;
  std::vector<Order> small_, medium_;
};

}  // namespace papilio::soak
