#pragma once

#include "core/criteria/view_culling.h"
#include "papilio/mesh.h"

namespace papilio::bench {

/// Substitute for the paper's Spock, with its counts: 1048 vertices, 2092 faces, Euler characteristic 2. It is the
/// mannequin's head with horns from CGAL's example data (mannequin-devil.off, 25,888 faces), simplified; its only hole,
/// the neck, is closed by a fan.
[[nodiscard]] TriangleMesh head();

/// View of the whole head from the front that fills the height of a picture of 640 by 480, usual at the paper's time.
[[nodiscard]] View front_view(const TriangleMesh& head);

}  // namespace papilio::bench
