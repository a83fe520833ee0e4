#include "server/http/form.h"

#include <algorithm>
#include <optional>

#include "server/http/head.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

constexpr size_t most_parts = 64;
constexpr size_t longest_part_head = 8 << 10;
constexpr size_t longest_boundary = 70;
constexpr std::string_view end_of_line = "\r\n";

Problem damaged(const std::string& how) { return {Code::bad_request, "The form is damaged: " + how + "."}; }

/// Consumes a token or a quoted string at the begin of `text`.
std::string take_value(std::string_view& text) {
  std::string value;
  if (!text.starts_with('"')) {
    value = trimmed(text.substr(0, text.find(';')));
    text.remove_prefix(std::min(text.size(), text.find(';')));
    return value;
  }
  size_t at = 1;
  for (; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\' && at + 1 < text.size() && (text[at + 1] == '"' || text[at + 1] == '\\')) ++at;
    value += text[at];
  }
  text.remove_prefix(std::min(text.size(), at + 1));
  return value;
}

/// Returns a parameter of a value such as `form-data; name="mesh"; filename=a`.
std::optional<std::string> parameter(std::string_view text, std::string_view wanted) {
  text.remove_prefix(std::min(text.size(), text.find(';')));
  while (!text.empty()) {
    text.remove_prefix(1);
    const size_t equals = text.find_first_of("=;");
    const std::string_view name = trimmed(text.substr(0, equals));
    text.remove_prefix(std::min(text.size(), equals));
    if (!text.starts_with('=')) continue;
    text = text.substr(1);
    text = text.substr(std::min(text.size(), text.find_first_not_of(" \t")));
    std::string value = take_value(text);
    if (same_ignoring_case(name, wanted)) return value;
    text.remove_prefix(std::min(text.size(), text.find(';')));
  }
  return std::nullopt;
}

std::string boundary_of(std::string_view content_type) {
  std::string boundary = parameter(content_type, "boundary").value_or("");
  const bool lawful = std::ranges::all_of(boundary, [](char c) {
    return c == ' ' || std::string_view("(),/:=?").find(c) != std::string_view::npos ||
           is_token(std::string_view(&c, 1));
  });
  if (boundary.empty() || boundary.size() > longest_boundary || boundary.ends_with(' ') || !lawful)
    throw damaged("its Content-Type has no lawful boundary");
  return boundary;
}

/// Consumes the part's header fields and their empty line at the begin of `text`.
FormPart take_part_head(std::string_view& text) {
  FormPart part;
  size_t taken = 0;
  for (;;) {
    const size_t end = text.find(end_of_line);
    if (end == std::string_view::npos || (taken += end) > longest_part_head)
      throw damaged("a part's head does not end");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + end_of_line.size());
    if (line.empty()) break;
    const size_t colon = std::min(line.size(), line.find(':'));
    const std::string_view value = trimmed(line.substr(std::min(line.size(), colon + 1)));
    if (same_ignoring_case(line.substr(0, colon), "Content-Type")) part.content_type = value;
    if (same_ignoring_case(line.substr(0, colon), "Content-Disposition"))
      part.name = parameter(value, "name").value_or("");
  }
  if (part.name.empty()) throw damaged("a part has no name");
  return part;
}

/// Consumes the rest of a boundary's line at the begin of `text`. Returns false at the closing boundary.
bool take_boundary_end(std::string_view& text) {
  if (text.starts_with("--")) return false;
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t")));
  if (!text.starts_with(end_of_line)) throw damaged("a boundary's line holds more than the boundary");
  text.remove_prefix(end_of_line.size());
  return true;
}

}  // namespace

std::vector<FormPart> parse_form(std::string_view content_type, std::string_view body) {
  const std::string delimiter = "\r\n--" + boundary_of(content_type);
  const std::string_view opening = std::string_view(delimiter).substr(end_of_line.size());
  if (body.starts_with(opening)) {
    body.remove_prefix(opening.size());
  } else {
    const size_t preamble = body.find(delimiter);
    if (preamble == std::string_view::npos) throw damaged("its boundary does not occur in the body");
    body.remove_prefix(preamble + delimiter.size());
  }
  std::vector<FormPart> parts;
  while (take_boundary_end(body)) {
    if (parts.size() == most_parts) throw damaged("it has more than " + std::to_string(most_parts) + " parts");
    parts.push_back(take_part_head(body));
    const size_t end = body.find(delimiter);
    if (end == std::string_view::npos) throw damaged("its closing boundary is missing");
    parts.back().bytes = body.substr(0, end);
    body.remove_prefix(end + delimiter.size());
  }
  return parts;
}

}  // namespace papilio::server
