#pragma once

#include "mesh.h"
#include "view.h"

namespace papilio {

[[nodiscard]] Vec3d centre(const Box& box);

/// Returns the eye from which all of the box is in the picture of a viewer that looks at `view.target`: from +z, or
/// from -y where `view.up` points along z. Uses everything of `view` but the eye. Where the view defines no picture,
/// returns a point at which `Camera` names the reason.
[[nodiscard]] Vec3d framing_eye(const View& view, const Box& box);

}  // namespace papilio
