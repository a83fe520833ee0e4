#include "client/cli/flag_names.h"

#include <algorithm>

#include "proto/name_suggestion.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

constexpr std::string_view dashes = "--";

std::string folded(std::string_view name) {
  std::string out(name);
  std::ranges::replace_if(
      out, [](char c) { return c == '_' || c == '.'; }, '-');
  return out;
}

bool is_long_flag(std::string_view argument) { return argument.starts_with(dashes) && argument != dashes; }

/// Returns a flag's name, without dashes and value.
std::string_view name_in(std::string_view argument) {
  argument.remove_prefix(dashes.size());
  return argument.substr(0, argument.find('='));
}

}  // namespace

std::string known_flag(const std::string& argument, const std::vector<std::string>& names) {
  if (!is_long_flag(argument)) return argument;
  const std::string_view name = name_in(argument);
  const auto known = std::ranges::find(names, folded(name), folded);
  if (known == names.end()) return argument;
  return std::string(dashes) + *known + argument.substr(dashes.size() + name.size());
}

std::string unexpected_argument(const std::string& argument, const std::string& command,
                                const std::vector<std::string>& names) {
  const std::string help = " " + command + " --help lists what it takes.";
  if (!is_long_flag(argument)) return proto::quote(argument) + " is not expected after " + command + "." + help;
  const std::string_view name = name_in(argument);
  const std::vector<std::string_view> known(names.begin(), names.end());
  const auto meant = proto::suggest_name(name, known);
  return command + " has no flag --" + proto::shorten(name) + "." +
         (meant ? " Did you mean --" + std::string(*meant) + "?" : help);
}

}  // namespace papilio::client
