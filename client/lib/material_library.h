#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/mesh_file/mtl.h"
#include "client/mesh_file/obj_file.h"
#include "proto/gltf/materials.h"

namespace papilio::client {

/// File beside another one, by its place in the folder.
struct FileBeside {
  std::filesystem::path inner;  ///< path relative to the folder
  bool is_there = false;        ///< whether it is a regular file
  bool is_inside = true;        ///< whether its name leads into the folder; else `inner` is only its last part
};

/// Finds a file by its name in a file in `folder / below`. / separates folders.
[[nodiscard]] FileBeside find_beside(const std::filesystem::path& folder, const std::filesystem::path& below,
                                     const std::string& name);

/// Reader of the material libraries of an OBJ file, and of the images of used materials.
class LibraryReader {
 public:
  /// Prepares to read for the file `obj`. `has_coordinates`: whether it has texture coordinates; without them, images
  /// are skipped.
  LibraryReader(std::filesystem::path obj, bool has_coordinates)
      : obj_(std::move(obj)), folder_(obj_.parent_path()), has_coordinates_(has_coordinates) {}

  /// Returns the materials in the order of `named.names`; none if no library can be read. Throws `FileError` for a
  /// damaged library, and for images of more than `kMaxFileBytes` together.
  [[nodiscard]] proto::gltf::Materials read(const ObjMaterials& named);
  /// Returns warnings of skipped files.
  [[nodiscard]] std::vector<std::string> warnings() && { return std::move(warnings_); }

 private:
  /// Material and the folder of its library, relative to the folder of the OBJ file.
  struct Defined {
    MtlMaterial material;
    std::filesystem::path library;
  };

  void read_libraries(const std::string& line);
  void read_library(const std::string& name);
  [[nodiscard]] proto::gltf::Material material_of(const Defined& defined);
  void add_images(const Defined& defined, proto::gltf::Material& material);
  [[nodiscard]] std::optional<uint32_t> image_of(const Defined& defined, MtlMap map);
  [[nodiscard]] std::optional<uint32_t> read_image(const FileBeside& found);
  void warn(const std::filesystem::path& file, const std::string& what);

  std::filesystem::path obj_, folder_;
  bool has_coordinates_;
  bool has_library_ = false;
  std::map<std::string, Defined> defined_;                           ///< materials by name
  std::map<std::filesystem::path, std::optional<uint32_t>> images_;  ///< images by path; nothing for skipped ones
  std::map<std::filesystem::path, bool> libraries_;                  ///< libraries by path: whether they were found
  uint64_t image_bytes_ = 0;
  proto::gltf::Materials out_;
  std::vector<std::string> warnings_;
};

/// Returns the media type of an image by its first bytes: "image/png" or "image/jpeg"; "" for others.
[[nodiscard]] std::string_view media_type_of(std::string_view bytes);

}  // namespace papilio::client
