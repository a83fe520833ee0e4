#include "papilio/algorithm_version.h"

#include <meshoptimizer.h>

namespace papilio {

int simplifier_version() { return MESHOPTIMIZER_VERSION; }

}  // namespace papilio
