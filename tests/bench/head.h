#pragma once

#include "core/criteria/view_culling.h"
#include "papilio/mesh.h"

namespace papilio::bench {

/// In place of the paper's Spock, with its counts: 1048 vertices, 2092 faces, Euler characteristic 2. A real one, the
/// mannequin's head with horns from CGAL's example data (mannequin-devil.off, 25,888 faces), simplified. There is no
/// closed head among the real meshes; of this one the open neck, its one hole, is closed by a fan.
[[nodiscard]] TriangleMesh head();

/// The head from the front, in a picture of 640 by 480, which was usual at the paper's time; all of the head is in the
/// picture and fills its height.
[[nodiscard]] View front_view(const TriangleMesh& head);

}  // namespace papilio::bench
