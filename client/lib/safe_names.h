#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace papilio::client {

/// Returns a text that is safe in file names on any system, and in lines of OBJ files, where many readers end names at
/// blanks. Keeps letters, digits, `.`, `-`, `_` and bytes beyond ASCII; replaces others by `_`. At most 100 bytes; ""
/// stays "".
[[nodiscard]] std::string safe_file_name(std::string_view text);

/// Returns a material's name that is safe in lines of OBJ files: without control characters, and without blanks at its
/// ends.
[[nodiscard]] std::string safe_material_name(std::string_view text);

/// Source of unique names; names of files differ in more than case.
class UniqueNames {
 public:
  enum class Kind { file, material };
  explicit UniqueNames(Kind kind) : kind_(kind) {}

  /// Returns `stem + end`, with _2, _3, ... before the end if that name was returned before.
  [[nodiscard]] std::string add(const std::string& stem, const std::string& end = "");

 private:
  [[nodiscard]] bool take(const std::string& name);

  Kind kind_;
  std::set<std::string> taken_;
  std::map<std::string, uint64_t> latest_;  ///< latest number of each repeated name
};

}  // namespace papilio::client
