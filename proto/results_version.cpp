#include "proto/results_version.h"

#include "papilio/algorithm_version.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

std::string results_version() {
  return "algorithm " + std::to_string(algorithm_version) + ", encoding " + std::to_string(encoding_version) +
         ", meshoptimizer " + std::to_string(simplifier_version()) + ", draco " + std::string(draco_version());
}

}  // namespace papilio::proto
