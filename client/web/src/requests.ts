// Parameters for each of the compared meshes.

import { type Frozen, type Mode, shortest } from './link';
import type { Values } from './parameters';

// Parameters that select where to refine, and are not sent for the uniform result; `targets` select on their own.
const targets = ['tolerance', 'max_faces', 'flatness'];
const criteria = [...targets, 'growth', 'simplify_hidden'];

/// Pixels of a picture that shows a whole mesh.
const wholePicture = 1000;
/// Limit of faces of the uniform result if the user has not set the levels.
const mostUniformFaces = 300_000;

/// Returns the parameters for a mode. `values`: parameters set by the user; `faces`: faces of the coarse mesh;
/// `isPassing`: see forView().
export function valuesFor(mode: Mode, values: Values, view: Frozen, faces: number, isPassing = false): Values {
  const without = (left: string[]) =>
    new Map([...values].filter(([name]) => !left.includes(name) && !name.startsWith('view.')));
  if (mode === 'uniform') {
    const uniform = without(criteria);
    return uniform.has('levels') ? uniform : uniform.set('levels', String(levelsOf(values, faces)));
  }
  if (mode === 'adaptive') {
    // Without a target: the accuracy for a picture that shows the whole mesh.
    const adaptive = without(['simplify_hidden']);
    const pixels = Number(values.get('view.error_pixels') ?? 0);
    if (pixels > 0 && !hasTarget(values)) adaptive.set('tolerance', shortest(pixels / wholePicture));
    return adaptive;
  }
  const all = forView(values, isPassing);
  all.set('view.eye', view.eye.map(shortest).join(','));
  all.set('view.target', view.target.map(shortest).join(','));
  if (!all.has('view.viewport')) all.set('view.viewport', view.pixels.join(','));
  return all;
}

/// Returns the parameters of the picture that follows the camera. With an accuracy in pixels, the tolerance is left to
/// the adaptive result: edges below it would stay whole however near the camera comes. With `isPassing`, the camera or
/// the detail moves on, and surfaces are not verified unless the user requests it.
export function forView(values: Values, isPassing: boolean): Values {
  const all = new Map(values);
  if (!(Number(all.get('view.error_pixels') ?? 0) > 0)) return all;
  all.delete('tolerance');
  return isPassing && !all.has('view.verify') ? all.set('view.verify', 'false') : all;
}

/// Returns a note for the user; may be empty.
export function noteFor(mode: Mode, values: Values): string {
  if (mode === 'adaptive' && !hasTarget(values) && !values.has('view.error_pixels'))
    return 'The same as uniform: set tolerance, flatness or max_faces.';
  return '';
}

/// Returns the levels set by the user, or as many as a browser shows smoothly; `faces`: faces of the coarse mesh.
export function levelsOf(values: Values, faces: number): number {
  const given = values.get('levels');
  if (given !== undefined) return Number(given);
  return Math.min(3, Math.max(1, Math.floor(Math.log(mostUniformFaces / Math.max(1, faces)) / Math.log(4))));
}

function hasTarget(values: Values): boolean {
  return targets.some((name) => values.has(name));
}
