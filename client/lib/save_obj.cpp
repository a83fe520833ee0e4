#include "client/lib/save_obj.h"

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "client/lib/material_library.h"
#include "client/lib/safe_names.h"
#include "client/mesh_file/mtl.h"
#include "client/mesh_file/obj_file.h"

namespace papilio::client {
namespace {

namespace fs = std::filesystem;

using proto::gltf::Image;
using proto::gltf::ImageUse;
using proto::gltf::Material;
using proto::gltf::Materials;

constexpr std::array<std::pair<std::string_view, const char*>, 7> extensions{{{"image/png", ".png"},
                                                                              {"image/jpeg", ".jpg"},
                                                                              {"image/webp", ".webp"},
                                                                              {"image/ktx2", ".ktx2"},
                                                                              {"image/avif", ".avif"},
                                                                              {"image/bmp", ".bmp"},
                                                                              {"image/gif", ".gif"}}};

std::string extension_of(const Image& image) {
  std::string_view type = media_type_of(image.bytes);
  if (type.empty()) type = image.media_type;
  for (const auto& [known, extension] : extensions)
    if (known == type) return extension;
  return ".image";
}

/// Returns an image's name without its extension.
std::string stem_of(const Image& image) {
  const fs::path name = image.name;
  for (const auto& [type, extension] : extensions)
    if (name.extension() == extension || name.extension() == ".jpeg") return name.stem().string();
  return image.name;
}

/// Returns the file names of images beside NAME.obj; "" for an image without bytes, and one that no material has a
/// keyword for.
std::vector<std::string> image_names(const std::string& stem, const Materials& materials) {
  const std::vector<Image>& images = materials.images;
  std::vector<bool> is_used(images.size());
  for (const Material& material : materials.materials)
    for (const std::optional<uint32_t>& image : material.images)
      if (image && *image < images.size()) is_used[*image] = true;
  std::vector<std::string> names;
  UniqueNames unique(UniqueNames::Kind::file);
  size_t number = 0;  // of the images that materials have
  for (size_t i = 0; i < images.size(); ++i) {
    std::string own = safe_file_name(stem_of(images[i]));
    if (own.empty()) own = std::to_string(number);
    if (is_used[i]) ++number;
    const bool has_stem = own.starts_with(stem + "_");  // its name is from an OBJ file written before
    names.push_back(images[i].bytes.empty() || !is_used[i]
                        ? ""
                        : unique.add(has_stem ? own : stem + "_" + own, extension_of(images[i])));
  }
  return names;
}

/// Returns the names of the materials in the files.
std::vector<std::string> material_names(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  UniqueNames unique(UniqueNames::Kind::material);
  for (size_t i = 0; i < materials.size(); ++i) {
    const std::string own = safe_material_name(materials[i].name);
    names.push_back(unique.add(own.empty() ? "material_" + std::to_string(i) : own));
  }
  return names;
}

MtlMaterial mtl_of(const Material& material, const std::string& name, const std::vector<std::string>& images) {
  MtlMaterial out{.name = name};
  const auto& color = material.base_color;
  out.diffuse = {color[0], color[1], color[2]};
  out.opacity = material.is_blended ? color[3] : 1;
  if (material.emissive != Material{}.emissive) out.emissive = material.emissive;
  out.roughness = material.roughness;
  out.metallic = material.metallic;
  const auto set = [&](MtlMap map, ImageUse use) {
    const auto& image = material.image(use);
    if (image && *image < images.size()) out.map(map) = images[*image];
  };
  set(MtlMap::diffuse, ImageUse::base_color);
  set(MtlMap::emissive, ImageUse::emissive);
  set(MtlMap::normal, ImageUse::normal);
  set(MtlMap::roughness, ImageUse::metallic_roughness);
  set(MtlMap::metallic, ImageUse::metallic_roughness);
  if (material.is_blended) set(MtlMap::opacity, ImageUse::base_color);
  return out;
}

/// Group of files: new ones are removed again unless all are written. Existing files keep their latest content.
class FilesTogether {
 public:
  ~FilesTogether() {
    std::error_code ignored;
    for (const fs::path& path : new_) fs::remove(path, ignored);
  }
  FilesTogether() = default;
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;

  void write(const fs::path& path, std::string_view bytes) {
    std::error_code ignored;
    const bool is_new = !fs::exists(fs::symlink_status(path, ignored));
    write_atomically(path, bytes);
    if (is_new) new_.push_back(path);
  }
  void keep() { new_.clear(); }

 private:
  std::vector<fs::path> new_;
};

}  // namespace

void save_obj(const MeshPlace& place, const proto::gltf::MaterialMesh& model) {
  const std::string name = place.path.string();
  const Materials& materials = model.materials;
  if (materials.empty() || place.is_standard())
    return save_bytes(place, encode_triangles(name, Format::obj, model.mesh, model.mesh.format));
  const std::string stem = safe_file_name(place.path.stem().string());
  const std::vector<std::string> images = image_names(stem, materials);
  const ObjMaterials named{
      .libraries = {stem + ".mtl"}, .names = material_names(materials.materials), .of_triangle = materials.of_triangle};
  std::vector<MtlMaterial> library;
  for (size_t m = 0; m < named.names.size(); ++m)
    library.push_back(mtl_of(materials.materials[m], named.names[m], images));
  const std::string obj = encode_obj(name, model.mesh, model.mesh.format, named);
  const fs::path folder = place.path.parent_path();
  FilesTogether files;
  for (size_t i = 0; i < images.size(); ++i)
    if (!images[i].empty()) files.write(folder / images[i], materials.images[i].bytes);
  files.write(folder / named.libraries[0], format_mtl(library));
  files.write(place.path, obj);
  files.keep();
}

}  // namespace papilio::client
