// Camera that has all of a mesh in the picture.

import { type BufferGeometry, type Sphere, Vector3 } from 'three';

import { positionsOf } from './bounds';
import type { Lens } from './camera';
import type { Camera } from './link';

/// Returns a camera slightly above the mesh, to the right of its front. `aspect`: width to height of the narrowest
/// picture. `share`: share of the picture's height, in its middle, for the mesh.
export function framed(
  geometry: BufferGeometry,
  { center }: Sphere,
  aspect: number,
  share: number,
  lens: Lens,
): Camera {
  const positions = positionsOf(geometry);
  const high = share * Math.tan((lens.fovY * Math.PI) / 360);
  const wide = 0.95 * aspect * Math.tan((lens.fovY * Math.PI) / 360);
  const up = new Vector3(...lens.up).normalize();
  const axes = [new Vector3(0, 0, 1), new Vector3(1, 0, 0)];
  const front = axes.find((axis) => Math.abs(axis.dot(up)) < 0.8)!; // z, if y is up
  const side = up.clone().cross(front).normalize();
  const towards = side.clone().cross(up).addScaledVector(side, 0.55).normalize().addScaledVector(up, 0.4).normalize();
  const right = up.clone().cross(towards).normalize();
  const above = towards.clone().cross(right);
  // Smallest distance that has all vertices in the picture.
  const { x, y, z } = center;
  const { x: aboveX, y: aboveY, z: aboveZ } = above;
  const { x: rightX, y: rightY, z: rightZ } = right;
  const { x: nearX, y: nearY, z: nearZ } = towards;
  let distance = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const dx = positions[i] - x;
    const dy = positions[i + 1] - y;
    const dz = positions[i + 2] - z;
    const upwards = Math.abs(dx * aboveX + dy * aboveY + dz * aboveZ) / high;
    const aside = Math.abs(dx * rightX + dy * rightY + dz * rightZ) / wide;
    const least = dx * nearX + dy * nearY + dz * nearZ + (upwards > aside ? upwards : aside);
    if (least > distance) distance = least;
  }
  const eye = towards.multiplyScalar(distance).add(center);
  return { eye: eye.toArray(), target: center.toArray() };
}
