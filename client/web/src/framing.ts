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
  const [x, y, z] = center.toArray();
  let distance = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const [dx, dy, dz] = [positions[i] - x, positions[i + 1] - y, positions[i + 2] - z];
    const across = Math.max(
      Math.abs(dx * above.x + dy * above.y + dz * above.z) / high,
      Math.abs(dx * right.x + dy * right.y + dz * right.z) / wide,
    );
    distance = Math.max(distance, dx * towards.x + dy * towards.y + dz * towards.z + across);
  }
  const eye = towards.multiplyScalar(distance).add(center);
  return { eye: eye.toArray(), target: center.toArray() };
}
