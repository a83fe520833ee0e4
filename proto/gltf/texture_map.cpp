#include "proto/gltf/texture_map.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "papilio/trigonometry.h"
#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
namespace {

/// Returns sine and cosine of an angle in radians, bit-identical on every processor.
SineCosine sine_and_cosine(double angle) {
  constexpr double steps = 1ULL << 40;  // steps per turn
  const double turns = angle / (2 * std::numbers::pi);
  const double part = turns - std::floor(turns);
  if (!(part >= 0 && part < 1)) return {0, 1};  // not a number
  return sine_and_cosine_of_turn(static_cast<uint64_t>(part * steps), static_cast<uint64_t>(steps));
}

/// Sets the axes from scale and rotation. Source: KHR_texture_transform, as in three.js.
void set_axes(TextureMap& map) {
  const SineCosine at = map.rotation == 0 ? SineCosine{0, 1} : sine_and_cosine(map.rotation);
  map.u_axis = {map.scale[0] * at.cosine, -map.scale[0] * at.sine};
  map.v_axis = {map.scale[1] * at.sine, map.scale[1] * at.cosine};
}

/// Returns the map that gives the results of `map` on coordinates transformed by `done`; nothing if it is sheared or
/// not finite.
std::optional<TextureMap> map_after(const TextureMap& map, const TextureMap& done) {
  const std::array<double, 2> scale{map.scale[0] / done.scale[0], map.scale[1] / done.scale[1]};
  constexpr double rounding = 1e-12;
  if (done.rotation != 0 && !(std::abs(scale[0] - scale[1]) <= rounding * std::abs(scale[0]))) return std::nullopt;
  TextureMap made{.scale = scale, .rotation = map.rotation - done.rotation};
  set_axes(made);
  const auto [u, v] = made.point(done.offset[0], done.offset[1]);
  made.offset = {map.offset[0] - u, map.offset[1] - v};
  for (const double number : {scale[0], scale[1], made.offset[0], made.offset[1], made.rotation})
    if (!std::isfinite(number)) return std::nullopt;
  return made;
}

}  // namespace

TextureMap read_texture_map(const Json& info, const std::string& where) {
  TextureMap map;
  map.set = static_cast<uint32_t>(whole_number(info, "texCoord", where, 0));
  const Json* extension = find_extension(info, texture_transform_extension, where);
  if (extension == nullptr) return map;
  map.set = static_cast<uint32_t>(whole_number(*extension, "texCoord", where, map.set));
  read_numbers(*extension, "scale", map.scale, where);
  read_numbers(*extension, "offset", map.offset, where);
  map.rotation = number_member(*extension, "rotation", 0, where);
  set_axes(map);
  return map;
}

bool rewrite_texture_map(Json& info, const TextureMap& map, const TextureMap& done) {
  if (done == TextureMap{}) return true;
  const std::optional<TextureMap> made = map == done ? TextureMap{} : map_after(map, done);
  if (!made) return false;
  const Json* old = find_extension(info, texture_transform_extension, "a texture");
  Json transform = old == nullptr ? Json::object() : *old;
  for (const char* key : {"texCoord", "offset", "rotation", "scale"}) transform.erase(key);
  if (made->offset != TextureMap{}.offset) transform["offset"] = made->offset;
  if (made->rotation != 0) transform["rotation"] = made->rotation;
  if (made->scale != TextureMap{}.scale) transform["scale"] = made->scale;
  info.erase("texCoord");
  if (transform.empty())
    erase_extension(info, texture_transform_extension);
  else
    info["extensions"][texture_transform_extension] = std::move(transform);
  return true;
}

}  // namespace papilio::proto::gltf
