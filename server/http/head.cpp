#include "server/http/head.h"

#include <algorithm>

#include "proto/text.h"
#include "proto/url.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Returns the target from its path on: the whole target, or the part after the authority of "http://host:port/path".
std::string_view without_origin(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!same_ignoring_case(target.substr(0, scheme.size()), scheme)) continue;
    const std::string_view rest = target.substr(scheme.size());
    const std::string_view authority = rest.substr(0, rest.find_first_of("/?"));
    if (authority.starts_with(':') || !is_authority(authority))
      throw Problem(Code::bad_request, "The host in the address is " + proto::quote(authority) +
                                           ", which is not valid. Send http://HOST:PORT/PATH, or the path alone.");
    return rest.substr(authority.size());
  }
  return target;
}

void parse_target(Head& head) {
  const std::string_view target = without_origin(head.target);
  const size_t mark = target.find('?');
  const std::string_view path = target.substr(0, mark);
  const bool is_absolute = target.size() < head.target.size();
  if (!path.starts_with('/') && path != "*" && !(is_absolute && path.empty()))
    throw Problem(Code::bad_request, "The address must be a path that begins with /.");
  head.path = path.empty() ? "/" : proto::require_decoded(path);
  if (std::ranges::any_of(head.path, is_control))
    throw Problem(Code::bad_request, "The path holds a control character.");
  if (mark != std::string_view::npos) head.query = proto::split_query(target.substr(mark + 1));
}

void parse_request_line(std::string_view line, Head& head) {
  const size_t first = line.find(' ');
  const size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  const bool is_visible = std::ranges::all_of(line, [](char c) { return c >= 0x20 && c < 0x7f; });
  if (second == std::string_view::npos || !is_visible || !is_token(line.substr(0, first)))
    throw Problem(Code::bad_request, "The first line is not an HTTP request line.");
  const std::string_view version = line.substr(second + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    throw Problem(Code::bad_request, "Unsupported HTTP version. Use HTTP/1.1 or HTTP/1.0.");
  head.minor_version = version.back() - '0';
  head.method = line.substr(0, first);
  head.target = line.substr(first + 1, second - first - 1);
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
    return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || marks.find(c) != std::string_view::npos;
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

bool is_authority(std::string_view text) {
  const auto all_of = [](std::string_view part, std::string_view marks) {
    return std::ranges::all_of(part, [&](char c) {
      return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || marks.find(c) != std::string_view::npos;
    });
  };
  const bool is_literal = text.starts_with('[');
  const size_t bracket = is_literal ? text.find(']') : 0;
  if (bracket == std::string_view::npos) return false;
  const size_t colon = text.find(':', bracket);
  const std::string_view port = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  const std::string_view host = text.substr(0, colon);
  if (text.empty() || !std::ranges::all_of(port, is_digit)) return false;
  if (!is_literal) return all_of(host, "-._~!$&'()*+,;=%");
  return bracket + 1 == host.size() && bracket > 1 && host.find_first_not_of("0123456789abcdefABCDEF:.", 1) == bracket;
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
