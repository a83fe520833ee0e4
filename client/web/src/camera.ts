// Cameras of three.js from views in numbers.

import { type Camera, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three';

import type { Frozen } from './link';

/// Projection of the picture, without the camera's place.
export interface Lens {
  fovY: number; // degrees
  isOrthographic: boolean;
  up: [number, number, number];
}

/// Returns a camera ready for rendering. `near`, `far`: multiples of the distance to the target.
export function cameraOf({ eye, target, pixels }: Frozen, lens: Lens, near = 1 / 1000, far = 1000): Camera {
  const distance = new Vector3(...eye).distanceTo(new Vector3(...target));
  const aspect = pixels[0] / pixels[1];
  const camera = lens.isOrthographic
    ? orthographic(lens.fovY, aspect, distance)
    : new PerspectiveCamera(lens.fovY, aspect);
  camera.near = near * distance;
  camera.far = far * distance;
  camera.up.set(...lens.up);
  camera.position.set(...eye);
  camera.lookAt(new Vector3(...target));
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
  return camera;
}

/// Returns an orthographic frustum that shows at all depths what a perspective one shows at the target.
export function orthographic(fovY: number, aspect: number, distance: number): OrthographicCamera {
  const height = distance * Math.tan((fovY * Math.PI) / 360);
  return new OrthographicCamera(-height * aspect, height * aspect, height, -height);
}
