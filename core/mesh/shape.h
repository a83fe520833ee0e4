#pragma once

#include "papilio/mesh.h"
#include "papilio/options.h"
#include "papilio/result.h"

namespace papilio {

/// Marks what of a coarse mesh is to stay as it is, and says what was found: its creases, darts and `Topology::shape`.
/// The mesh must have its edges, none of them a crease. Levels inherit the marks, as they inherit creases.
///
/// `Options::crease_angle` below 180, given by hand, replaces all other creases. Without it, creases are those of
/// smoothing groups (smoothing_groups.h) and those of the shape.
///
/// Without tension or by `Shape::plain` no creases of the shape are marked. Else a component, faces
/// connected by edges, is mechanical where the option says so or, by itself, where of its edges between two faces at
/// least a quarter lie flat (under half a degree) and at least half are either flat or sharp (over 31 degrees). Of a
/// mechanical component creases are, unless an angle is given,
/// - all sharp edges;
/// - the outlines of broad flats: of the regions that flat edges join, width is area by perimeter; an edge of 3 degrees
///   and more is a crease where one of its regions has two faces or more and 1.5 times the other's width.
/// Its corners are the vertices on curves where the curve turns by more than 31 degrees, or where other than two curve
/// edges meet. An edge is flat, too, where the apex of its smaller face lies within `ShapeMarks::flat_distance` of the
/// larger one's plane: the angles of slivers mean nothing. Nothing is marked of a mesh with detail. O(F log F).
ShapeReport mark_shape(Mesh& mesh, const Options& options);

}  // namespace papilio
