// Bounds of geometries, by loops over plain arrays: three's own take longer than a frame on large meshes.

import { Box3, type BufferAttribute, type BufferGeometry, type InterleavedBufferAttribute, Sphere } from 'three';

/// Returns positions [vertices * 3], without a copy where they are stored so.
export function positionsOf(geometry: BufferGeometry): Float32Array {
  const position = geometry.getAttribute('position');
  if (isPlain(position)) return position.array as Float32Array;
  const positions = new Float32Array(3 * position.count);
  for (let v = 0, to = 0; v < position.count; ++v) {
    positions[to++] = position.getX(v);
    positions[to++] = position.getY(v);
    positions[to++] = position.getZ(v);
  }
  return positions;
}

/// Sets the geometry's bounding box, and as its bounding sphere the smallest one about the box's centre.
export function measureBounds(geometry: BufferGeometry): void {
  const positions = positionsOf(geometry);
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let axis = 0; axis < 3; ++axis) {
    let [least, most] = [Infinity, -Infinity];
    for (let i = axis; i < positions.length; i += 3) {
      const x = positions[i];
      if (x < least) least = x;
      if (x > most) most = x;
    }
    [low[axis], high[axis]] = [least, most];
  }
  geometry.boundingBox = new Box3();
  geometry.boundingBox.min.fromArray(low);
  geometry.boundingBox.max.fromArray(high);
  geometry.boundingSphere = new Sphere();
  const { center } = geometry.boundingSphere;
  geometry.boundingBox.getCenter(center);
  const { x, y, z } = center;
  let squared = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const distance = (positions[i] - x) ** 2 + (positions[i + 1] - y) ** 2 + (positions[i + 2] - z) ** 2;
    if (distance > squared) squared = distance;
  }
  geometry.boundingSphere.radius = Math.sqrt(squared);
}

function isPlain(position: BufferAttribute | InterleavedBufferAttribute): boolean {
  return (
    !('isInterleavedBufferAttribute' in position) &&
    position.array instanceof Float32Array &&
    position.itemSize === 3 &&
    !position.normalized
  );
}
