#include "client/lib/read_beside.h"

#include "client/mesh_file/mesh_file.h"
#include "proto/text.h"
#include "proto/url.h"

namespace papilio::client {

std::string read_beside(const std::filesystem::path& document, const std::string& uri) {
  const std::filesystem::path name = proto::decode_url(uri).value_or(uri);
  const bool has_scheme = uri.find(':') != std::string::npos;
  if (has_scheme || name.is_absolute() || *name.lexically_normal().begin() == "..")
    throw FileError(document, "names " + proto::quote(uri) + ", which is not in its folder; put it there");
  return read_bytes(document.parent_path() / name, kMaxFileBytes);
}

}  // namespace papilio::client
