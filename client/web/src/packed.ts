// Packed models: each of their levels as a mesh that is open.

import { isPacked, openPacked, type PackedModel, withLevels } from 'papilio/detail';
import { dracoDecoder, geometryOf } from 'papilio/three';

import { encode, fetchDecoder } from './draco';
import { OpenMesh } from './mesh';
import type { Bytes } from './model';

export { isPacked };

/// One level of a packed model.
export interface PackedLevel {
  readonly model: PackedModel;
  /// The whole file.
  readonly file: Bytes;
  /// How many levels are shown; 0: the base.
  readonly level: number;
  /// Its surface for the server.
  encode(): Promise<Bytes>;
}

/// Levels with more faces are not shown until the user asks for them.
const mostFacesAtFirst = 300_000;

/// The model with all its levels, or with those that a browser shows well. Rejects with a Problem.
export async function openPackedMesh(name: string, file: Bytes): Promise<OpenMesh> {
  const model = await openPacked(file, { decodeDraco: async (draco) => dracoDecoder(await fetchDecoder())(draco) });
  try {
    const level = model.levels.filter(({ faces }) => faces <= mostFacesAtFirst).length;
    return await levelOf(name, { model, file }, level);
  } catch (error) {
    model.close();
    throw error;
  }
}

/// The model with its first levels. Rejects with a Problem.
export async function levelOf(
  name: string,
  { model, file }: Pick<PackedLevel, 'model' | 'file'>,
  level: number,
): Promise<OpenMesh> {
  const surface = await model.decode(level);
  const geometry = geometryOf(surface);
  const decoded = {
    geometry,
    scene: null,
    vertices: surface.positions.length / 3,
    faces: surface.triangles.length / 3,
    missing: [],
    dispose: () => geometry.dispose(),
  };
  const packed = { model, file, level, encode: () => encode(surface.positions, surface.triangles) };
  return new OpenMesh(name, { kind: 'packed', bytes: withLevels(file, level) }, decoded, packed);
}
