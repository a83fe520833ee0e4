#pragma once

#include <string>

#include "papilio/error.h"
#include "papilio/mesh.h"

namespace papilio {

/// Throws `Error` bad_surface unless every edge has two faces, wound alike, and every vertex one fan.
inline void require_closed(const Mesh& mesh) {
  size_t curves = 0;
  for (const EdgeKind kind : mesh.topology.kind) curves += kind != EdgeKind::smooth ? 1 : 0;
  if (curves > 0)
    throw Error(Fault::bad_surface, "The surface is not closed: " + std::to_string(curves) +
                                        " edges have not two faces that are wound alike.");
  if (!mesh.topology.pinched.empty())
    throw Error(Fault::bad_surface, "The surface touches itself at " + std::to_string(mesh.topology.pinched.size()) +
                                        " vertices. Part them.");
}

}  // namespace papilio
