// View of a camera on an object, as parameters of a refinement.

import { type Camera, Matrix4, type Object3D, Vector3 } from 'three';

import type { Parameters } from '../parameters.js';

/// Returns the view in the object's coordinates, whose scale should be uniform; null if the object is scaled to
/// nothing. `pixels`: width and height of the picture. The matrices of both must be up to date.
export function viewOf(object: Object3D, camera: Camera, pixels: readonly [number, number]): Parameters | null {
  const { matrixWorld } = object;
  if (matrixWorld.determinant() === 0) return null;
  const toObject = new Matrix4().copy(matrixWorld).invert().multiply(camera.matrixWorld);
  const eye = new Vector3().setFromMatrixPosition(toObject);
  const forward = new Vector3().setFromMatrixColumn(toObject, 2).negate();
  const up = new Vector3().setFromMatrixColumn(toObject, 1);
  const shrink = forward.length(); // length of a world unit in the object's coordinates
  forward.normalize();
  const high = 1 / camera.projectionMatrix.elements[5]!;
  // Perspective divides by depth.
  const isPerspective = camera.projectionMatrix.elements[11] !== 0;
  const fov = isPerspective ? (360 / Math.PI) * Math.atan(high) : 45;
  // The height of an orthographic picture equals the perspective one's at the target.
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

/// Rounds to seven digits, more than a screen shows.
const number = (n: number) => Number(n.toPrecision(7));
const numbers = (v: Vector3) => v.toArray().map(number);
