// Where to look from so that all of a mesh is in the picture.

import { type BufferGeometry, type Sphere, Vector3 } from 'three';

import type { Lens } from './camera';
import type { Camera } from './link';

/// From slightly above, to the right of the front. `aspect`: of the narrowest picture, width to height.
export function framed(geometry: BufferGeometry, { center }: Sphere, aspect: number, lens: Lens): Camera {
  const position = geometry.getAttribute('position');
  const high = 0.9 * Math.tan((lens.fovY * Math.PI) / 360); // the caption takes the rest
  const wide = 0.95 * aspect * Math.tan((lens.fovY * Math.PI) / 360);
  const up = new Vector3(...lens.up).normalize();
  const axes = [new Vector3(0, 0, 1), new Vector3(1, 0, 0)];
  const front = axes.find((axis) => Math.abs(axis.dot(up)) < 0.8)!; // with y up, z
  const side = up.clone().cross(front).normalize();
  const towards = side.clone().cross(up).addScaledVector(side, 0.55).normalize().addScaledVector(up, 0.4).normalize();
  const right = up.clone().cross(towards).normalize();
  const above = towards.clone().cross(right);
  // From where the last vertex comes into the picture.
  let distance = 0;
  const point = new Vector3();
  for (let v = 0; v < position.count; ++v) {
    point.fromBufferAttribute(position, v).sub(center);
    const across = Math.max(Math.abs(point.dot(above)) / high, Math.abs(point.dot(right)) / wide);
    distance = Math.max(distance, point.dot(towards) + across);
  }
  const eye = towards.multiplyScalar(distance).add(center);
  return { eye: eye.toArray(), target: center.toArray() };
}
