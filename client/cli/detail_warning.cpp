#include "client/cli/commands.h"
#include "proto/detail/packed_reader.h"

namespace papilio::client {

void warn_of_detail(const MeshBytes& file) {
  if (is_scene(file.format) && proto::detail::is_packed(file.bytes))
    print_warnings(
        {file.name +
         " is a packed model, and only its base is used. To use its detail, unpack it first: papilio unpack " +
         file.name + " -o fine.glb"});
}

}  // namespace papilio::client
