#include "server/http/head.h"

#include <algorithm>

#include "proto/url.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string percent_decoded(std::string_view text, bool plus_is_space) {
  if (auto decoded = proto::decode_url(text, plus_is_space)) return *std::move(decoded);
  throw Problem(Code::bad_request, "The address holds a % without two hexadecimal digits.");
}

Fields parse_query(std::string_view text) {
  Fields fields;
  while (!text.empty()) {
    const std::string_view field = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), field.size() + 1));
    if (field.empty()) continue;
    const size_t equals = field.find('=');
    const std::string_view value = equals == std::string_view::npos ? "" : field.substr(equals + 1);
    fields.emplace_back(percent_decoded(field.substr(0, equals), true), percent_decoded(value, true));
  }
  return fields;
}

/// "http://host:port/path" is a lawful way to ask for "/path".
std::string_view without_origin(std::string_view target) {
  constexpr std::string_view scheme = "http://";
  if (!same_ignoring_case(target.substr(0, scheme.size()), scheme)) return target;
  const size_t slash = target.find('/', scheme.size());
  return slash == std::string_view::npos ? "/" : target.substr(slash);
}

void parse_target(Head& head) {
  const std::string_view target = without_origin(head.target);
  if (!target.starts_with('/') && target != "*")
    throw Problem(Code::bad_request, "The address must be a path that begins with /.");
  const size_t mark = target.find('?');
  head.path = percent_decoded(target.substr(0, mark), false);
  if (std::ranges::any_of(head.path, is_control))
    throw Problem(Code::bad_request, "The path holds a control character.");
  if (mark != std::string_view::npos) head.query = parse_query(target.substr(mark + 1));
}

void parse_request_line(std::string_view line, Head& head) {
  const size_t first = line.find(' ');
  const size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  const bool is_visible = std::ranges::all_of(line, [](char c) { return c >= 0x20 && c < 0x7f; });
  if (second == std::string_view::npos || !is_visible || !is_token(line.substr(0, first)))
    throw Problem(Code::bad_request, "The first line is not an HTTP request line.");
  const std::string_view version = line.substr(second + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    throw Problem(Code::bad_request, "Only HTTP/1.1 and HTTP/1.0 are spoken here.");
  head.minor_version = version.back() - '0';
  head.method = line.substr(0, first);
  head.target = line.substr(first + 1, second - first - 1);
}

std::pair<std::string, std::string> parse_field(std::string_view line) {
  const size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
    throw Problem(Code::bad_request, "A header line is not of the form `Name: value`.");
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (std::ranges::any_of(value, [](char c) { return is_control(c) && c != '\t'; }))
    throw Problem(Code::bad_request, "A header field's value holds a control character.");
  return {std::string(line.substr(0, colon)), std::string(value)};
}

}  // namespace

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), lower);
  return small;
}

bool is_token(std::string_view text) {
  constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::ranges::all_of(text, [&](char c) {
    return (c >= '0' && c <= '9') || (lower(c) >= 'a' && lower(c) <= 'z') || marks.find(c) != std::string_view::npos;
  });
}

std::string Head::field(std::string_view name) const {
  std::string all;
  bool is_first = true;
  for (const auto& [known, value] : fields) {
    if (!same_ignoring_case(known, name)) continue;
    if (!is_first) all += ", ";
    all += value;
    is_first = false;
  }
  return all;
}

size_t Head::count(std::string_view name) const {
  return static_cast<size_t>(
      std::ranges::count_if(fields, [&](const auto& f) { return same_ignoring_case(f.first, name); }));
}

bool Head::lists(std::string_view name, std::string_view token) const {
  for (const auto& [field_name, value] : fields) {
    if (!same_ignoring_case(field_name, name)) continue;
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::string_view item = rest.substr(0, rest.find(','));
      if (same_ignoring_case(trimmed(item), token)) return true;
      rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    }
  }
  return false;
}

void parse_head(std::string_view text, Head& head) {
  constexpr std::string_view end_of_line = "\r\n";
  const auto next_line = [&] {
    const std::string_view line = text.substr(0, text.find(end_of_line));
    text.remove_prefix(std::min(text.size(), line.size() + end_of_line.size()));
    return line;
  };
  parse_request_line(next_line(), head);
  for (std::string_view line = next_line(); !line.empty(); line = next_line()) head.fields.push_back(parse_field(line));
  parse_target(head);
}

}  // namespace papilio::server
