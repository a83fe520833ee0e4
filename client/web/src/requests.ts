// Which parameters each of the compared meshes is asked for with.

import { type Frozen, type Mode, shortest } from './link';
import type { Values } from './parameters';

// What chooses where to refine, and so has no part in the uniform result; of these, `targets` make a choice by themselves.
const targets = ['tolerance', 'max_faces', 'flatness'];
const criteria = [...targets, 'growth', 'simplify_hidden'];

/// Pixels of a picture that shows the whole of a mesh.
const wholePicture = 1000;
/// Of the uniform result, where the user does not say how many levels.
const mostUniformFaces = 300_000;

/// `values`: what the user has set; `faces`: of the coarse mesh.
export function valuesFor(mode: Mode, values: Values, view: Frozen, faces: number): Values {
  const without = (left: string[]) =>
    new Map([...values].filter(([name]) => !left.includes(name) && !name.startsWith('view.')));
  if (mode === 'uniform') {
    const uniform = without(criteria);
    return uniform.has('levels') ? uniform : uniform.set('levels', String(levelsOf(values, faces)));
  }
  if (mode === 'adaptive') {
    // Without a target of its own it is as near as the picture asks for where all of the mesh is in it.
    const adaptive = without(['simplify_hidden']);
    const pixels = Number(values.get('view.error_pixels') ?? 0);
    if (pixels > 0 && !hasTarget(values)) adaptive.set('tolerance', shortest(pixels / wholePicture));
    return adaptive;
  }
  const all = forMoving(values);
  all.set('view.eye', view.eye.map(shortest).join(','));
  all.set('view.target', view.target.map(shortest).join(','));
  if (!all.has('view.viewport')) all.set('view.viewport', view.pixels.join(','));
  return all;
}

/// A picture that follows the camera does not wait for surfaces to be compared, unless the user says so.
export function forMoving(values: Values): Values {
  const all = new Map(values);
  return all.has('view.error_pixels') && !all.has('view.verify') ? all.set('view.verify', 'false') : all;
}

/// What the user should know of it; empty: nothing.
export function noteFor(mode: Mode, values: Values): string {
  if (mode === 'adaptive' && !hasTarget(values) && !values.has('view.error_pixels'))
    return 'The same as uniform: set tolerance, flatness or max_faces.';
  return '';
}

/// As many as the user says, or as the browser carries well; `faces`: of the coarse mesh.
export function levelsOf(values: Values, faces: number): number {
  const given = values.get('levels');
  if (given !== undefined) return Number(given);
  return Math.min(3, Math.max(1, Math.floor(Math.log(mostUniformFaces / Math.max(1, faces)) / Math.log(4))));
}

function hasTarget(values: Values): boolean {
  return targets.some((name) => values.has(name));
}
