// State of the page in the fragment of its address; and the commands that request the meshes on screen.

import { type Encoded, extensionOf, mediaTypes } from './model';
import type { Values } from './parameters';

export const modes = ['coarse', 'uniform', 'adaptive', 'view'] as const;
export type Mode = (typeof modes)[number];

export const looks = ['shaded', 'wireframe', 'level', 'distance'] as const;
export type Look = (typeof looks)[number];

/// Arrangement: one picture with a wipe between two meshes, or a panel for each mesh.
export const arrangements = ['wipe', 'panels'] as const;
export type Arrangement = (typeof arrangements)[number];

/// Place of refinement for the view: this browser, or the server.
export const places = ['here', 'server'] as const;
export type Place = (typeof places)[number];

export const grounds = ['page', 'light', 'dark', 'studio'] as const;
/// Background of the mesh.
export type Ground = (typeof grounds)[number];

type Triple = [number, number, number];

export interface Camera {
  eye: Triple;
  target: Triple;
}

/// Fixed view: a camera, and the size of its picture in pixels.
export interface Frozen extends Camera {
  pixels: [number, number];
}

export interface State {
  /// Name of a sample, or id of a stored mesh; empty: a mesh that only this page has.
  mesh: string;
  /// Visible modes; with a wipe, the first and the last.
  modes: Mode[];
  arrangement: Arrangement;
  look: Look;
  where: Place;
  ground: Ground;
  /// Camera; null: the initial one of the mesh.
  camera: Camera | null;
  /// View of the refinement; null: the camera's.
  frozen: Frozen | null;
  values: Values;
}

const isId = (text: string) => /^[0-9a-f]{64}$/.test(text);

/// Returns whether a name is the id of a stored mesh, not a sample.
export const isStored = (mesh: string): boolean => isId(mesh);

export function toHash(state: State): string {
  const fields: [string, string][] = [];
  if (state.mesh) fields.push(['mesh', state.mesh]);
  fields.push(['show', state.modes.join(',')], ['as', state.arrangement], ['look', state.look]);
  fields.push(['where', state.where], ['ground', state.ground]);
  if (state.camera) fields.push(['camera', cameraText(state.camera)]);
  if (state.frozen) fields.push(['frozen', [cameraText(state.frozen), ...state.frozen.pixels].join(',')]);
  fields.push(...state.values);
  return fields.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll('%2C', ',')}`).join('&');
}

/// Returns the state in a fragment, with `defaults` for the rest. Ignores invalid fields. With a field `show`, the
/// default parameters are not used.
export function fromHash(hash: string, defaults: State): State {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const state: State = { ...defaults, values: new Map(defaults.values) };
  if (fields.size === 0) return state;
  const shown = (fields.get('show') ?? '').split(',');
  const known = modes.filter((mode) => shown.includes(mode));
  if (known.length > 0) state.modes = known;
  state.mesh = fields.get('mesh') ?? defaults.mesh;
  const chosen = <T extends string>(name: string, from: readonly T[], otherwise: T) =>
    from.find((one) => one === fields.get(name)) ?? otherwise;
  state.look = chosen('look', looks, defaults.look);
  // Links of earlier versions lack these fields, whose values were fixed.
  const isEarlier = fields.has('show');
  state.arrangement = chosen('as', arrangements, isEarlier ? 'panels' : defaults.arrangement);
  state.where = chosen('where', places, isEarlier ? 'server' : defaults.where);
  state.ground = chosen('ground', grounds, 'page');
  state.camera = cameraOf(numbersOf(fields.get('camera'), 6));
  const frozen = numbersOf(fields.get('frozen'), 8);
  const kept = cameraOf(frozen);
  state.frozen = kept && { ...kept, pixels: frozen!.slice(6) as [number, number] };
  if (fields.has('show')) {
    const own = new Set(['mesh', 'show', 'as', 'look', 'where', 'ground', 'camera', 'frozen']);
    state.values = new Map([...fields].filter(([name]) => !own.has(name)));
  }
  return state;
}

function cameraText({ eye, target }: Camera): string {
  return [...eye, ...target].map(shortest).join(',');
}

/// Returns the numbers in a text; null unless there are `count`.
function numbersOf(text: string | null, count: number): number[] | null {
  const numbers = (text ?? '').split(',').map(Number);
  return text !== null && numbers.length === count && numbers.every(Number.isFinite) ? numbers : null;
}

function cameraOf(numbers: number[] | null): Camera | null {
  return numbers && { eye: numbers.slice(0, 3) as Triple, target: numbers.slice(3, 6) as Triple };
}

/// Returns a number with six digits, more than a screen shows.
export function shortest(number: number): string {
  return String(Number(number.toPrecision(6)));
}

/// Returns the command that fetches the same bytes. `query`: null for the mesh as it is. `id`: null if the server could
/// not store the mesh; then `file` is its name on the user's disk.
export function curlOf(
  base: string,
  query: string | null,
  mesh: { id: string | null; file: string; kind: Encoded['kind'] },
  withKey: boolean,
): string {
  const curl = `curl -sS --fail-with-body${withKey ? ' -H "Authorization: Bearer $PAPILIO_KEY"' : ''}`;
  if (query === null)
    return mesh.id === null ? '' : `${curl} -o coarse${extensionOf[mesh.kind]} '${base}v1/meshes/${mesh.id}'`;
  const out = `${curl} -o refined${extensionOf[mesh.kind]}`;
  if (mesh.id !== null) return `${out} '${base}v1/meshes/${mesh.id}/refined?${query}'`;
  const body = `-H 'Content-Type: ${mediaTypes[mesh.kind]}' --data-binary @${quoted(mesh.file)}`;
  return `${out} ${body} '${base}v1/refine?${query}'`;
}

function quoted(word: string): string {
  return /^[\w./-]+$/.test(word) ? word : `'${word.replaceAll("'", `'\\''`)}'`;
}
