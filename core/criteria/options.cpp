#include "papilio/options.h"

#include "criteria/camera.h"
#include "papilio/error.h"

namespace papilio {
namespace {

void require_option(bool good, const char* option, const char* what) {
  if (!good) throw Error(Fault::bad_option, what, option);
}

}  // namespace

void check_options(const Options& options) {
  require_option(options.levels >= 0 && options.levels <= 10, "levels", "The number of levels must lie in 0..10.");
  for (double t : options.flatness)
    require_option(t >= -1 && t <= 1, "flatness", "Each flatness threshold must lie in -1..1.");
  require_option(options.w >= -0.0625 && options.w <= 0.125, "w", "w must lie in -0.0625..0.125.");
  require_option(options.crease_angle >= 0 && options.crease_angle <= 180, "crease_angle",
                 "The crease angle must lie in 0..180 degrees.");
  require_option(options.tolerance >= 0 && options.tolerance <= 1, "tolerance", "The tolerance must lie in 0..1.");
  if (options.view) (void)Camera(*options.view);
  require_option(!options.simplify_hidden || options.view.has_value(), "simplify_hidden",
                 "simplify_hidden requires a view. Set the view parameters, or omit simplify_hidden.");
}

}  // namespace papilio
