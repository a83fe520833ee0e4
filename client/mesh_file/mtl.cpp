#include "client/mesh_file/mtl.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/mesh_file/byte_order_mark.h"
#include "client/mesh_file/formats.h"
#include "client/mesh_file/obj_file.h"
#include "client/mesh_file/text_scanner.h"
#include "client/mesh_file/text_writer.h"

namespace papilio::client {
namespace {

struct MapKeyword {
  std::string_view keyword;  ///< keyword as written; read in any case
  MtlMap map;
  std::string_view options{};  ///< options as written
};
constexpr std::array<MapKeyword, 9> map_keywords{{{"map_Kd", MtlMap::diffuse},
                                                  {"map_Ke", MtlMap::emissive},
                                                  {"norm", MtlMap::normal},
                                                  {"map_Bump", MtlMap::bump},
                                                  {"bump", MtlMap::bump},
                                                  {"map_Pr", MtlMap::roughness, "-imfchan g "},
                                                  {"map_Pm", MtlMap::metallic, "-imfchan b "},
                                                  {"map_d", MtlMap::opacity},
                                                  {"map_opacity", MtlMap::opacity}}};

/// Options of maps, with the upper bound of their arguments.
constexpr std::array<std::pair<std::string_view, int>, 13> map_options{{{"-blendu", 1},
                                                                        {"-blendv", 1},
                                                                        {"-bm", 1},
                                                                        {"-boost", 1},
                                                                        {"-cc", 1},
                                                                        {"-clamp", 1},
                                                                        {"-imfchan", 1},
                                                                        {"-mm", 2},
                                                                        {"-o", 3},
                                                                        {"-s", 3},
                                                                        {"-t", 3},
                                                                        {"-texres", 1},
                                                                        {"-type", 1}}};

bool is_alike(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

constexpr std::string_view mtl_blanks = " \t\r\v\f";

/// Consumes the first word of `rest`, and the blanks after it.
std::string_view take_word(std::string_view& rest) {
  const std::string_view word = rest.substr(0, rest.find_first_of(mtl_blanks));
  rest.remove_prefix(word.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(mtl_blanks), rest.size()));
  return word;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(mtl_blanks), text.size()));
  return text.substr(0, text.find_last_not_of(mtl_blanks) + 1);
}

/// Consumes the arguments of an option in `rest`. Options of three numbers may have fewer; the last word is a file's
/// name.
void skip_arguments(std::string_view& rest, int most) {
  for (int i = 0; i < most; ++i) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    double number = 0;
    if (after.empty() || (i > 0 && !parse_number(word, number))) return;
    rest = after;
  }
}

/// Returns the file's name after the keyword of a map.
std::string file_name(std::string_view rest) {
  while (rest.starts_with('-')) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    const auto* option =
        std::ranges::find_if(map_options, [&](const auto& known) { return is_alike(known.first, word); });
    if (option == map_options.end() || after.empty()) break;
    skip_arguments(after, option->second);
    rest = after;
  }
  if (rest.size() > 2 && rest.starts_with('"') && rest.ends_with('"')) rest = trimmed(rest.substr(1, rest.size() - 2));
  std::string name(rest);
  std::ranges::replace(name, '\\', '/');
  return name;
}

/// Returns the number of a word, clamped to 0..`most`.
double factor_of(const TextScanner& scanner, std::string_view word, double most) {
  double number = 0;
  if (!parse_number(word, number) || !std::isfinite(number))
    scanner.fail("expected a finite number, found " + quoted(word));
  return std::clamp(number, 0.0, most);
}

double parse_factor(TextScanner& scanner, double most) { return factor_of(scanner, scanner.word(), most); }

/// Reads a colour: three numbers, or one for all. Nothing for the forms `spectral FILE` and `xyz X Y Z`.
std::optional<std::array<double, 3>> parse_color(TextScanner& scanner, double most) {
  std::array<double, 3> color{};
  for (size_t i = 0; i < color.size(); ++i) {
    const std::string_view word = scanner.word();
    if (i == 0 && (is_alike(word, "spectral") || is_alike(word, "xyz"))) return std::nullopt;
    color[i] = i > 0 && word.empty() ? color[0] : factor_of(scanner, word, most);
  }
  return color;
}

constexpr double unbounded = 1e30;

/// Reads one line of a material. `has_opacity`: whether `d` has set the opacity, which overrides `Tr`.
void parse_line(TextScanner& scanner, std::string_view keyword, MtlMaterial& material, bool& has_opacity) {
  if (is_alike(keyword, "Kd")) {
    if (const auto color = parse_color(scanner, 1)) material.diffuse = color;
  } else if (is_alike(keyword, "Ke")) {
    if (const auto color = parse_color(scanner, unbounded)) material.emissive = color;
  } else if (keyword == "d") {
    TextScanner ahead = scanner;
    if (ahead.word() == "-halo") scanner = ahead;
    material.opacity = parse_factor(scanner, 1);
    has_opacity = true;
  } else if (keyword == "Tr") {
    const double transparency = parse_factor(scanner, 1);
    if (!has_opacity) material.opacity = 1 - transparency;
  } else if (keyword == "Ns") {
    material.shininess = parse_factor(scanner, unbounded);
  } else if (keyword == "Pr") {
    material.roughness = parse_factor(scanner, 1);
  } else if (keyword == "Pm") {
    material.metallic = parse_factor(scanner, 1);
  } else {
    const auto* map =
        std::ranges::find_if(map_keywords, [&](const MapKeyword& known) { return is_alike(known.keyword, keyword); });
    if (map != map_keywords.end()) material.map(map->map) = file_name(scanner.rest_of_line());
  }
}

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view bytes) {
  bytes = skip_byte_order_mark(bytes);
  if (bytes.find('\0') != std::string_view::npos) throw ParseError("is not a text, as material libraries are");
  TextScanner scanner(bytes, {.hash_comments = true, .backslash_continues = true});
  std::vector<MtlMaterial> materials;
  bool has_opacity = false;
  for (bool more = scanner.to_word(); more; more = scanner.next_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "newmtl") {
      if (materials.size() == most_materials) scanner.fail("there are more than 65536 materials");
      materials.push_back({.name = std::string(scanner.rest_of_line())});
      has_opacity = false;
    } else if (!materials.empty()) {
      parse_line(scanner, keyword, materials.back(), has_opacity);
    }
  }
  return materials;
}

std::string format_mtl(const std::vector<MtlMaterial>& materials) {
  std::string text = "# " + std::to_string(materials.size()) + (materials.size() == 1 ? " material\n" : " materials\n");
  const auto append_value = [&](std::string_view keyword, const std::optional<double>& value) {
    if (value) append_line(text, keyword, {*value});
  };
  const auto append_color = [&](std::string_view keyword, const std::optional<std::array<double, 3>>& color) {
    if (color) append_line(text, keyword, {(*color)[0], (*color)[1], (*color)[2]});
  };
  for (const MtlMaterial& material : materials) {
    text += "\nnewmtl " + material.name + '\n';
    append_color("Kd", material.diffuse);
    append_value("d", material.opacity);
    append_color("Ke", material.emissive);
    append_value("Ns", material.shininess);
    append_value("Pr", material.roughness);
    append_value("Pm", material.metallic);
    std::array<bool, mtl_map_count> is_written{};
    for (const MapKeyword& map : map_keywords) {
      const std::string& name = material.map(map.map);
      if (name.empty() || std::exchange(is_written.at(static_cast<size_t>(map.map)), true)) continue;
      text.append(map.keyword).append(" ").append(map.options).append(name) += '\n';
    }
  }
  return text;
}

}  // namespace papilio::client
