// Which parameters each of the compared meshes is asked for with.

import { type Frozen, type Mode, shortest } from './link';
import type { Values } from './parameters';

// What chooses where to refine, and so has no part in the uniform result; of these, `targets` make a choice by themselves.
const targets = ['tolerance', 'max_faces', 'flatness'];
const criteria = [...targets, 'growth', 'simplify_hidden'];

/// `values`: what the user has set.
export function valuesFor(mode: Mode, values: Values, view: Frozen): Values {
  const without = (left: string[]) =>
    new Map([...values].filter(([name]) => !left.includes(name) && !name.startsWith('view.')));
  if (mode === 'uniform') return without(criteria);
  if (mode === 'adaptive') return without(['simplify_hidden']);
  const all = new Map(values);
  all.set('view.eye', view.eye.map(shortest).join(','));
  all.set('view.target', view.target.map(shortest).join(','));
  if (!all.has('view.viewport')) all.set('view.viewport', view.pixels.join(','));
  return all;
}

/// What the user should know of it; empty: nothing.
export function noteFor(mode: Mode, values: Values): string {
  if (mode === 'adaptive' && !targets.some((name) => values.has(name)))
    return 'The same as uniform: set tolerance, flatness or max_faces.';
  return '';
}

export function levelsOf(values: Values): number {
  return Number(values.get('levels') ?? 2);
}
