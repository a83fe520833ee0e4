// Animation of the camera to another place.

import { Vector3 } from 'three';

import type { Camera } from './link';

const duration = 250; // milliseconds

/// Calls `move` for each frame between `from` and `to`; only for `to` if the user prefers no motion. Returns a function
/// that stops the animation.
export function glide(from: Camera, to: Camera, move: (camera: Camera) => void): () => void {
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
    move(to);
    return () => {};
  }
  const began = performance.now();
  const between = (a: [number, number, number], b: [number, number, number], share: number) =>
    new Vector3(...a).lerp(new Vector3(...b), share).toArray();
  let frame = 0;
  const step = () => {
    const time = Math.min(1, (performance.now() - began) / duration);
    const share = time * time * (3 - 2 * time);
    move({ eye: between(from.eye, to.eye, share), target: between(from.target, to.target, share) });
    if (time < 1) frame = requestAnimationFrame(step);
  };
  frame = requestAnimationFrame(step);
  return () => cancelAnimationFrame(frame);
}
