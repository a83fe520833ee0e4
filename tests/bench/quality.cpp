#include "tests/bench/report.h"
namespace papilio::bench {
void add_quality() {}
}  // namespace papilio::bench
