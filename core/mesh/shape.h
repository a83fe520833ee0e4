#pragma once

#include "papilio/mesh.h"
#include "papilio/options.h"
#include "papilio/result.h"

namespace papilio {

/// Marks the creases, darts and `Topology::shape` of a coarse mesh, and returns their counts. The mesh must have edges,
/// none of them a crease. Levels inherit the marks. A mesh with detail gets none. O(F log F).
///
/// `Options::crease_angle` below 180 replaces all other creases. Otherwise creases come from smoothing groups
/// (smoothing_groups.h) and from the shape. Without tension, or with `Shape::plain`, the shape adds none.
///
/// A component is a set of faces connected by edges. `Shape::automatic` makes it mechanical in one of three cases,
/// counting edges between two faces:
/// - at least a quarter of its edges are flat (under half a degree), and at least half are flat or sharp (over 31
///   degrees);
/// - every edge is flat or sharp, and one is flat, as in a pyramid of six faces;
/// - at least a tenth of its edges are sharp, and at least a quarter of its area lies in flats of four faces or more.
///
/// Flats are the regions that flat edges connect; their width is area over perimeter. Creases of a mechanical component
/// are:
/// - sharp edges;
/// - edges of 3 degrees or more between two flats, if one has at least two faces and 1.5 times the other's width.
///
/// A lid is a region of an organic component, as the flat end of an arm, connected by edges under 7 degrees. At least
/// nine tenths of its outline's length are sharp, and at least twelve edges. `Shape::automatic` makes these creases.
///
/// Corners of a mechanical component or of a lid are vertices at which a curve turns by more than 31 degrees, or at
/// which other than two curve edges meet. An edge is also flat if the apex of its smaller face lies within
/// `ShapeMarks::flat_distance` of the larger face's plane, as angles of slivers are meaningless.
///
/// Positions on a grid (grid_step.h) are rounded, which bends flats. Edges whose apex lies within one and a half steps
/// of the plane are flat if the face is high enough for that to mean little. Other such edges are not counted, and a
/// component of which they are the most is not mechanical. In a mechanical mesh `ShapeMarks::flat_distance` is one and
/// a half steps; for creases it is half of that.
ShapeReport mark_shape(Mesh& mesh, const Options& options);

}  // namespace papilio
