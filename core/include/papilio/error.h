#pragma once

#include <stdexcept>
#include <string>

namespace papilio {

/// Cause of an `Error`. Closed list: every exception that the core throws on purpose is an `Error` with one of these.
enum class Fault {
  index_out_of_range,  ///< a triangle names a vertex that does not exist
  not_finite,          ///< a coordinate is NaN or infinite
  no_faces,            ///< all faces are degenerate or repeated
  bad_option,          ///< an option is outside its documented range
  bad_surface,         ///< the surface is not of the kind that the operation requires
  result_too_large,    ///< a level would exceed the limit on faces or memory
  cancelled,           ///< the caller asked to stop
  out_of_memory,       ///< an allocation failed
};

/// Exception of the core: `what()` states in plain words what is wrong and what to do.
class Error : public std::runtime_error {
 public:
  /// `option` names the option at fault for `Fault::bad_option` (as in `Options`), else it is empty.
  Error(Fault fault, const std::string& what, std::string option = {})
      : std::runtime_error(what), fault_(fault), option_(std::move(option)) {}
  [[nodiscard]] Fault fault() const { return fault_; }
  [[nodiscard]] const std::string& option() const { return option_; }

 private:
  Fault fault_;
  std::string option_;
};

}  // namespace papilio
