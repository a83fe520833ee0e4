#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace papilio::client {

/// Returns a text as part of a file's name on any system and of a line in OBJ files, where many readers end names at
/// blanks: of letters, digits, `.`, `-`, `_` and bytes beyond ASCII; all else becomes `_`. At most 100 bytes; "" stays
/// "".
[[nodiscard]] std::string safe_file_name(std::string_view text);

/// Returns a material's name as it can stand on a line of OBJ files: without control characters, and blanks inside
/// alone.
[[nodiscard]] std::string safe_material_name(std::string_view text);

/// Gives out names that differ, those of files in more than upper and lower case.
class UniqueNames {
 public:
  enum class Kind { file, material };
  explicit UniqueNames(Kind kind) : kind_(kind) {}

  /// Returns `stem + end`, with _2, _3, ... before the end if that was returned before.
  [[nodiscard]] std::string add(const std::string& stem, const std::string& end = "");

 private:
  [[nodiscard]] bool take(const std::string& name);

  Kind kind_;
  std::set<std::string> taken_;
  std::map<std::string, uint64_t> latest_;  ///< number of each name that was asked for again
};

}  // namespace papilio::client
