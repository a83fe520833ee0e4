#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/mesh_file.h"
#include "client/mesh_file/text_scanner.h"

namespace papilio::client {
namespace {

bool has_obj_vertex(std::string_view text) {
  TextScanner scanner(text, {.hash_comments = true, .backslash_continues = true});
  for (bool more = scanner.to_word(); more; more = scanner.next_line())
    if (scanner.word() == "v") return true;
  return false;
}

/// Returns whether the text starts like OFF: with the keyword, or with the counts of vertices and faces.
bool looks_like_off(std::string_view text) {
  TextScanner scanner(text, {.hash_comments = true});
  const std::string_view first = scanner.word_anywhere();
  int64_t count = 0;
  return first.ends_with("OFF") || (parse_number(first, count) && parse_number(scanner.word(), count));
}

std::optional<Format> recognised(std::string_view bytes) {
  if (bytes.starts_with("DRACO")) return Format::drc;
  if (bytes.starts_with("glTF")) return Format::glb;
  if (looks_like_stl(bytes)) return Format::stl;
  const std::string_view text = skip_byte_order_mark(bytes);
  const std::string_view first = TextScanner(text, {}).word_anywhere();
  if (first.starts_with('{')) return Format::gltf;
  if (first == "ply" && TextScanner(text, {}).word() == "ply") return Format::ply;
  if (text.find('\0') != std::string_view::npos) return std::nullopt;
  if (looks_like_off(text)) return Format::off;
  return has_obj_vertex(text) ? std::optional(Format::obj) : std::nullopt;
}

}  // namespace

Format format_of_content(const std::string& name, std::string_view bytes) {
  try {
    if (const std::optional<Format> format = recognised(bytes)) return *format;
  } catch (const ParseError& error) {
    throw FileError(name, error.what());
  }
  throw FileError(name,
                  "is of no format that its content shows; name one of drc, obj, ply, off, stl, glb, gltf with --from");
}

}  // namespace papilio::client
