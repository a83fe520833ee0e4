// Cameras of three.js for views that are kept as numbers.

import { type Camera, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three';

import type { Frozen } from './link';

/// How the picture is made, apart from where the camera is.
export interface Lens {
  fovY: number; // degrees
  isOrthographic: boolean;
  up: [number, number, number];
}

/// Ready to be looked through. `near`, `far`: in shares of the distance to the target.
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

/// Shows at every depth what perspective shows at the target.
export function orthographic(fovY: number, aspect: number, distance: number): OrthographicCamera {
  const height = distance * Math.tan((fovY * Math.PI) / 360);
  return new OrthographicCamera(-height * aspect, height * aspect, height, -height);
}
