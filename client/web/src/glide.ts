// The camera moves to another place, in a moment that the eye can follow.

import { Vector3 } from 'three';

import type { Camera } from './link';

const duration = 250; // milliseconds

/// Calls `move` for each frame from `from` to `to`; at once to the end where the user wants no motion. Returns what stops
/// it.
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
