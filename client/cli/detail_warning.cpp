#include "client/cli/commands.h"
#include "client/lib/file_words.h"
#include "proto/detail/find_packed.h"
#include "proto/detail/packed_reader.h"

namespace papilio::client {

void warn_of_detail(const MeshBytes& file) {
  if (!is_scene(file.format) || !proto::detail::is_packed(file.bytes)) return;
  if (in_words_of_the_file(file.name, [&] { return proto::detail::find_packed(file.bytes, own_limits).has_value(); }))
    return;
  print_warnings({file.name + " has levels of detail in a scene that is no packed model. Only its base is used."});
}

}  // namespace papilio::client
