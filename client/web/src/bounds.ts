// Bounds of geometries, by loops over plain arrays: three's own take longer than a frame on large meshes.

import {
  Box3,
  type BufferAttribute,
  type BufferGeometry,
  type InterleavedBufferAttribute,
  Sphere,
  Vector3,
} from 'three';

import { pause } from './pause';

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
  measureBox(geometry);
  measureSphere(geometry);
}

/// Measures the bounds as measureBounds does, in two tasks and before a third.
export async function measureBoundsInTasks(geometry: BufferGeometry): Promise<void> {
  await pause();
  measureBox(geometry);
  await pause();
  measureSphere(geometry);
  await pause();
}

function measureBox(geometry: BufferGeometry): void {
  const positions = positionsOf(geometry);
  let [lowX, lowY, lowZ] = [Infinity, Infinity, Infinity];
  let [highX, highY, highZ] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const x = positions[i];
    const y = positions[i + 1];
    const z = positions[i + 2];
    if (x < lowX) lowX = x;
    if (x > highX) highX = x;
    if (y < lowY) lowY = y;
    if (y > highY) highY = y;
    if (z < lowZ) lowZ = z;
    if (z > highZ) highZ = z;
  }
  geometry.boundingBox = new Box3(new Vector3(lowX, lowY, lowZ), new Vector3(highX, highY, highZ));
}

/// Sets the bounding sphere of a geometry with a bounding box.
function measureSphere(geometry: BufferGeometry): void {
  const positions = positionsOf(geometry);
  const center = geometry.boundingBox!.getCenter(new Vector3());
  const { x, y, z } = center;
  let squared = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const dx = positions[i] - x;
    const dy = positions[i + 1] - y;
    const dz = positions[i + 2] - z;
    const distance = dx * dx + dy * dy + dz * dz;
    if (distance > squared) squared = distance;
  }
  geometry.boundingSphere = new Sphere(center, Math.sqrt(squared));
}

function isPlain(position: BufferAttribute | InterleavedBufferAttribute): boolean {
  return (
    !('isInterleavedBufferAttribute' in position) &&
    position.array instanceof Float32Array &&
    position.itemSize === 3 &&
    !position.normalized
  );
}
