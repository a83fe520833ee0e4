// Distances of points from the faces that are nearest to them.

import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';

/// Returns [faces] the largest distance of the points [points * 3] that are nearest to the face, in mesh units; 0 for
/// faces that are nearest to none. `positions` [vertices * 3], `triangles` [faces * 3].
export function largestDistances(
  positions: Float32Array,
  triangles: Uint32Array,
  points: Float32Array,
): Float32Array<ArrayBuffer> {
  const searched = new BufferGeometry();
  searched.setAttribute('position', new BufferAttribute(positions, 3));
  searched.setIndex(new BufferAttribute(triangles, 1));
  const tree = new MeshBVH(searched, { indirect: true }); // keeps the order of triangles
  const distances = new Float32Array(triangles.length / 3);
  const point = new Vector3();
  const nearest = { point: new Vector3(), distance: 0, faceIndex: 0 };
  for (let i = 0; i + 2 < points.length; i += 3) {
    tree.closestPointToPoint(point.set(points[i], points[i + 1], points[i + 2]), nearest);
    distances[nearest.faceIndex] = Math.max(distances[nearest.faceIndex], nearest.distance);
  }
  return distances;
}
