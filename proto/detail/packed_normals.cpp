#include "proto/detail/packed_normals.h"

#include <algorithm>
#include <array>
#include <utility>

namespace papilio::proto::detail {
namespace {

constexpr std::array<std::pair<NormalStyle, std::string_view>, 4> style_names{{{NormalStyle::absent, ""},
                                                                               {NormalStyle::smooth, "smooth"},
                                                                               {NormalStyle::creased, "creased"},
                                                                               {NormalStyle::faceted, "faceted"}}};

}  // namespace

std::string_view name_of(NormalStyle style) {
  return std::ranges::find(style_names, style, &std::pair<NormalStyle, std::string_view>::first)->second;
}

std::optional<NormalStyle> normal_style_named(std::string_view name) {
  for (const auto& [style, known] : style_names)
    if (!known.empty() && known == name) return style;
  return std::nullopt;
}

std::optional<Attribute> normals_to_pack(const FormattedMesh& mesh) {
  for (size_t a = 0; a < mesh.format.attributes.size(); ++a) {
    if (mesh.format.attributes[a].kind != AttributeKind::normal || mesh.attributes[a].components != 3) continue;
    Attribute normals = mesh.attributes[a];
    normals.unit_length = true;
    return normals;
  }
  return std::nullopt;
}

}  // namespace papilio::proto::detail
