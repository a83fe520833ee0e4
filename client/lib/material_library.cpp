#include "client/lib/material_library.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <system_error>

#include "client/mesh_file/formats.h"
#include "client/mesh_file/mesh_file.h"
#include "proto/text.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

using proto::gltf::ImageUse;
using proto::gltf::Material;
using proto::gltf::Materials;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Returns the names after `mtllib`, which are separated by blanks.
std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string with_slashes(std::string name) {
  if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  std::ranges::replace(name, '\\', '/');
  return name;
}

/// Returns the roughness of the microfacet model whose highlight is as wide as that of a Phong exponent. Source:
/// Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces" (2007).
double roughness_of(double exponent) { return std::sqrt(2 / (exponent + 2)); }

}  // namespace

FileBeside find_beside(const fs::path& folder, const fs::path& below, const std::string& name) {
  const auto is_inside = [](const fs::path& inner) {
    return !inner.empty() && !inner.is_absolute() && *inner.begin() != "..";
  };
  const fs::path last = fs::path(name).filename();
  const fs::path named = (below / name).lexically_normal();
  FileBeside found{.inner = named, .is_inside = is_inside(named)};
  if (!found.is_inside) found.inner = last;
  for (const fs::path& inner : {named, fs::path(name).lexically_normal(), (below / last).lexically_normal(), last}) {
    if (!is_inside(inner) || !is_file(folder / inner)) continue;
    found.inner = inner;
    found.is_there = true;
    break;
  }
  return found;
}

std::string_view media_type_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  return "";
}

Materials LibraryReader::read(const ObjMaterials& named) {
  for (const std::string& line : named.libraries) read_libraries(line);
  if (!has_library_) return {};
  size_t unknown = 0;
  std::string first;
  for (const std::string& name : named.names) {
    const auto defined = defined_.find(name);
    if (defined == defined_.end() && unknown++ == 0) first = name;
    out_.materials.push_back(material_of(defined == defined_.end() ? Defined{{.name = name}, {}} : defined->second));
  }
  if (unknown > 0)
    warn(obj_, "has " + std::to_string(unknown) + (unknown == 1 ? " material" : " materials") +
                   " that no library defines, " + (unknown == 1 ? "" : "the first ") + proto::quote(first) +
                   "; white takes the place");
  out_.of_triangle = named.of_triangle;
  return std::move(out_);
}

void LibraryReader::read_libraries(const std::string& line) {
  const std::vector<std::string> words = words_of(line);
  const bool is_one = find_beside(folder_, {}, with_slashes(line)).is_there;
  const bool are_several = !is_one && std::ranges::any_of(words, [&](const std::string& word) {
    return find_beside(folder_, {}, with_slashes(word)).is_there;
  });
  if (!are_several) return read_library(with_slashes(line));
  for (const std::string& word : words) read_library(with_slashes(word));
}

void LibraryReader::read_library(const std::string& name) {
  const FileBeside found = find_beside(folder_, {}, name);
  if (!libraries_.emplace(found.inner, found.is_there).second) return;
  if (!found.is_there)
    return warn(obj_, "names the material library " + proto::quote(name) +
                          (found.is_inside ? ", which is not there; it is left out"
                                           : ", which is not in its folder; put it there. It is left out"));
  const fs::path path = folder_ / found.inner;
  try {
    for (MtlMaterial& material : parse_mtl(read_bytes(path, kMaxFileBytes))) {
      const std::string key = material.name;
      defined_.try_emplace(key, Defined{std::move(material), found.inner});
      if (defined_.size() > most_materials)
        throw ParseError("and the libraries before it have more than 65536 materials");
    }
    has_library_ = true;
  } catch (const ParseError& error) {
    throw FileError(path, std::string(error.what()) + "; export the materials again, or move this file away");
  }
}

Material LibraryReader::material_of(const Defined& defined) {
  const MtlMaterial& given = defined.material;
  Material material{.name = given.name};
  const auto diffuse = given.diffuse.value_or(std::array<double, 3>{1, 1, 1});
  std::ranges::copy(diffuse, material.base_color.begin());
  material.base_color[3] = given.opacity.value_or(1);
  const bool glows = !given.map(MtlMap::emissive).empty();
  material.emissive = given.emissive.value_or(glows ? std::array<double, 3>{1, 1, 1} : std::array<double, 3>{});
  const bool has_channels =
      !given.map(MtlMap::roughness).empty() && given.map(MtlMap::roughness) == given.map(MtlMap::metallic);
  material.metallic = given.metallic.value_or(has_channels ? 1 : 0);
  material.roughness = given.roughness.value_or(has_channels ? 1 : roughness_of(given.shininess.value_or(0)));
  material.is_blended = material.base_color[3] < 1 || !given.map(MtlMap::opacity).empty();
  if (has_coordinates_) add_images(defined, material);
  return material;
}

void LibraryReader::add_images(const Defined& defined, Material& material) {
  const MtlMaterial& given = defined.material;
  const auto warn_of = [&](const std::string& what) {
    warn(folder_ / defined.library, "material " + proto::quote(given.name) + ": " + what);
  };
  material.image(ImageUse::base_color) = image_of(defined, MtlMap::diffuse);
  material.image(ImageUse::emissive) = image_of(defined, MtlMap::emissive);
  material.image(ImageUse::normal) = image_of(defined, MtlMap::normal);
  if (given.map(MtlMap::roughness) == given.map(MtlMap::metallic))
    material.image(ImageUse::metallic_roughness) = image_of(defined, MtlMap::roughness);
  else
    warn_of("map_Pr and map_Pm are left out, as glTF has both in one image");
  if (!given.map(MtlMap::bump).empty())
    warn_of("the bump map " + proto::quote(given.map(MtlMap::bump)) +
            " is left out; name a normal map after the keyword norm");
  const std::string& opacity = given.map(MtlMap::opacity);
  if (!opacity.empty() && opacity != given.map(MtlMap::diffuse))
    warn_of("map_d is left out, as glTF has opacity in the image of map_Kd");
}

std::optional<uint32_t> LibraryReader::image_of(const Defined& defined, MtlMap map) {
  const std::string& name = defined.material.map(map);
  if (name.empty()) return std::nullopt;
  const FileBeside found = find_beside(folder_, defined.library.parent_path(), name);
  const auto [known, is_new] = images_.try_emplace(found.inner);
  if (!is_new) return known->second;
  if (!found.is_there)
    warn(folder_ / defined.library,
         "names the image " + proto::quote(name) +
             (found.is_inside ? ", which is not there; it is left out"
                              : ", which is not in its folder; put it there. It is left out"));
  else
    known->second = read_image(found);
  return known->second;
}

std::optional<uint32_t> LibraryReader::read_image(const FileBeside& found) {
  const fs::path path = folder_ / found.inner;
  std::error_code ignored;
  image_bytes_ += fs::file_size(path, ignored);
  if (image_bytes_ > kMaxFileBytes)
    throw FileError(path, "and the images before it have more than " + std::to_string(kMaxFileBytes) +
                              " bytes, the most that is read; make them smaller");
  std::string bytes = read_bytes(path, kMaxFileBytes);
  const std::string_view type = media_type_of(bytes);
  if (type.empty()) {
    warn(path, "is neither a PNG nor a JPEG image, which glTF has; it is left out. Convert it to PNG");
    return std::nullopt;
  }
  out_.images.push_back(
      {.name = found.inner.stem().string(), .media_type = std::string(type), .bytes = std::move(bytes)});
  return static_cast<uint32_t>(out_.images.size() - 1);
}

void LibraryReader::warn(const fs::path& file, const std::string& what) {
  warnings_.push_back(file.string() + ": " + what);
}

}  // namespace papilio::client
