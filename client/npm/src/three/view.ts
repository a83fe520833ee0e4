// What a camera sees of an object, as parameters of a refinement.

import { type Camera, Matrix4, type Object3D, Vector3 } from 'three';

import type { Parameters } from '../parameters.js';

/// In the object's own coordinates, which should not be scaled differently along different axes. `pixels`: of the picture,
/// width and height. Null where the object cannot be seen, being scaled to nothing. The matrices of both must be up to
/// date.
export function viewOf(object: Object3D, camera: Camera, pixels: readonly [number, number]): Parameters | null {
  const { matrixWorld } = object;
  if (matrixWorld.determinant() === 0) return null;
  const toObject = new Matrix4().copy(matrixWorld).invert().multiply(camera.matrixWorld);
  const eye = new Vector3().setFromMatrixPosition(toObject);
  const forward = new Vector3().setFromMatrixColumn(toObject, 2).negate();
  const up = new Vector3().setFromMatrixColumn(toObject, 1);
  const shrink = forward.length(); // a unit of the world, in the object's
  forward.normalize();
  const high = 1 / camera.projectionMatrix.elements[5]!;
  // Perspective divides by depth.
  const isPerspective = camera.projectionMatrix.elements[11] !== 0;
  const fov = isPerspective ? (360 / Math.PI) * Math.atan(high) : 45;
  // An orthographic picture is as high as a perspective one is at the target.
  const distance = isPerspective ? shrink : (high * shrink) / Math.tan((fov * Math.PI) / 360);
  const target = eye.clone().addScaledVector(forward, distance);
  const near = 'near' in camera ? Math.max(0, Number(camera.near)) * shrink : 0;
  return {
    eye: numbers(eye),
    target: numbers(target),
    up: numbers(up.normalize()),
    fov_y: number(fov),
    viewport: pixels.map((n) => Math.max(1, Math.round(n))),
    ...(isPerspective ? { near: number(near) } : { projection: 'orthographic' }),
  } as unknown as Parameters;
}

/// Seven digits are more than a screen shows.
const number = (n: number) => Number(n.toPrecision(7));
const numbers = (v: Vector3) => v.toArray().map(number);
