#pragma once

#include <stdexcept>
#include <string>

namespace papilio {

/// Why the core refuses or gives up. Closed list: everything the core throws on purpose is an `Error` with
/// one of these.
enum class Fault {
  index_out_of_range,  ///< a triangle names a vertex that does not exist
  not_finite,          ///< a coordinate is NaN or infinite
  no_faces,            ///< nothing is left once degenerate and repeated faces are dropped
  bad_option,          ///< an option outside its documented range
  bad_surface,         ///< the surface is not of the kind that the operation needs
  result_too_large,    ///< a level would pass the limit on faces
  cancelled,           ///< the caller asked to stop
  out_of_memory,       ///< an allocation failed
};

/// A refusal of the core: `what()` says in plain words what is wrong and what to do about it.
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
