#pragma once

#include "client/cli/commands.h"
#include "proto/refinement.h"

namespace papilio::client {

/// Refines one mesh here, with so many threads, or at the server: both go the same way from the same stream, so the
/// bytes are the same. Throws what the work throws, and `FileError` where the mesh is at fault.
[[nodiscard]] proto::EncodedLevel refine_mesh(const MeshPlace& input, const RefineFlags& flags, unsigned threads);

/// Refines every mesh in the folder `flags.input` into the folder `flags.output`, and says which files failed and which
/// were skipped.
void refine_folder(const RefineFlags& flags);

}  // namespace papilio::client
