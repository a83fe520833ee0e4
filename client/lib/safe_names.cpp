#include "client/lib/safe_names.h"

#include <algorithm>

namespace papilio::client {
namespace {

constexpr size_t most_bytes = 100;

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }
bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

}  // namespace

std::string safe_file_name(std::string_view text) {
  std::string name(text.substr(0, most_bytes));
  // Characters of several bytes are not split.
  if (text.size() > name.size())
    while (!name.empty() && (static_cast<unsigned char>(text[name.size()]) & 0xC0) == 0x80) name.pop_back();
  for (char& c : name)
    if (!is_letter_or_digit(c) && !is_beyond_ascii(c) && c != '.' && c != '-' && c != '_') c = '_';
  if (name.empty()) return name;
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  if (name.back() == '.') name.back() = '_';
  return name;
}

std::string safe_material_name(std::string_view text) {
  std::string name(text);
  std::ranges::replace_if(name, is_control, '_');
  if (name.empty()) return name;
  if (name.front() == ' ') name.front() = '_';
  if (name.back() == ' ' || name.back() == '\\') name.back() = '_';  // a backslash continues the line
  return name;
}

bool UniqueNames::take(const std::string& name) {
  return taken_.insert(kind_ == Kind::file ? lower_case(name) : name).second;
}

std::string UniqueNames::add(const std::string& stem, const std::string& end) {
  std::string name = stem + end;
  if (take(name)) return name;
  uint64_t& number = latest_.try_emplace(name, 1).first->second;
  do {
    name = stem + "_" + std::to_string(++number) + end;
  } while (!take(name));
  return name;
}

}  // namespace papilio::client
