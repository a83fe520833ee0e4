// Members of the JSON of a packed model, each checked.

import { Problem } from '../client.js';
import type { Json } from './container.js';

export type JsonObject = { [key: string]: Json | undefined };

/// Throws Problem for a damaged document. `where`: the place in it, such as `bufferViews[2]`.
export function refuse(where: string, what: string): never {
  throw new Problem('mesh_not_gltf', `The glTF document is damaged: ${where} ${what}.`);
}

/// Throws Problem for a scene that the format does not permit.
export function refuseScene(what: string): never {
  throw new Problem('mesh_unsupported', `The scene has ${what}, so it is no packed model. Make one with papilio pack.`);
}

export function objectOf(json: Json | undefined, where: string): JsonObject {
  if (json === null || typeof json !== 'object' || Array.isArray(json)) refuse(where, 'is not an object');
  return json;
}

/// Returns a top-level array; empty if there is none.
export function arrayOf(of: JsonObject, key: string): Json[] {
  const array = of[key] ?? [];
  if (!Array.isArray(array)) refuse(key, 'is not an array');
  return array;
}

/// Returns the only element of an array.
export function only(of: JsonObject, key: string, name: string): JsonObject {
  const array = arrayOf(of, key);
  if (array.length !== 1) refuseScene(`other than one ${name}`);
  return objectOf(array[0], `${key}[0]`);
}

export function element(of: JsonObject, key: string, index: number): JsonObject {
  const array = arrayOf(of, key);
  if (index >= array.length) refuse(`${key}[${index}]`, 'does not exist, and is referred to');
  return objectOf(array[index], `${key}[${index}]`);
}

export function whole(of: JsonObject, key: string, where: string, otherwise?: number): number {
  const value = of[key] ?? otherwise;
  if (typeof value !== 'number' || !Number.isSafeInteger(value) || value < 0)
    refuse(`${where}.${key}`, 'is no whole number');
  return value;
}

/// Returns a member that is an index; null if it is absent.
export function index(of: JsonObject, key: string, where: string): number | null {
  return of[key] === undefined ? null : whole(of, key, where);
}

export function extensionOf(of: JsonObject, name: string, where: string): JsonObject | null {
  if (of.extensions === undefined) return null;
  const found = objectOf(of.extensions, `${where}.extensions`)[name];
  return found === undefined ? null : objectOf(found, `${where}.extensions.${name}`);
}
