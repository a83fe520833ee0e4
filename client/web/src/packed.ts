// Packed models: each of their levels as a mesh that is open.

import { type DecodedTriangles, isPacked, openPacked, type PackedModel, withLevels, withSurface } from 'papilio/detail';
import { dracoDecoder, geometryOf, sceneNormals, showLevel } from 'papilio/three';
import { Box3, type BufferGeometry, type Object3D } from 'three';

import { encode, fetchDecoder } from './draco';
import { OpenMesh } from './mesh';
import type { Bytes, Decoded } from './model';
import { decodeScene } from './scene';

export { isPacked };

/// What all levels of a packed model have.
interface Opened {
  readonly model: PackedModel;
  /// The whole file.
  readonly file: Bytes;
  /// The base as a scene with its material; null where the file has none.
  readonly base: Decoded | null;
}

/// One level of a packed model.
export interface PackedLevel extends Opened {
  /// How many levels are shown; 0: the base.
  readonly level: number;
  /// Its surface for the server: with a material a scene.
  encode(): Promise<Bytes>;
}

/// Levels with more faces are not shown until the user asks for them.
const mostFacesAtFirst = 300_000;

/// The model with all its levels, or with those that a browser shows well. Rejects with a Problem.
export async function openPackedMesh(name: string, file: Bytes): Promise<OpenMesh> {
  const model = await openPacked(file, { decodeDraco: async (draco) => dracoDecoder(await fetchDecoder())(draco) });
  try {
    const base = model.hasMaterial ? await decodeScene(file) : null;
    const level = model.levels.filter(({ faces }) => faces <= mostFacesAtFirst).length;
    return await levelOf(name, { model, file, base }, level);
  } catch (error) {
    model.close();
    throw error;
  }
}

/// The model with its first levels. Rejects with a Problem.
export async function levelOf(name: string, { model, file, base }: Opened, level: number): Promise<OpenMesh> {
  const surface = await model.decode(level, base ? { normals: sceneNormals(model) } : {});
  const geometry = geometryOf(surface);
  const decoded = {
    geometry,
    vertices: surface.positions.length / 3,
    faces: surface.triangles.length / 3,
    ...(base === null ? { scene: null, missing: [], dispose: () => geometry.dispose() } : sceneWith(base, geometry)),
  };
  const encodeLevel = () => (base === null ? encode(surface) : encodeScene(file, surface, geometry));
  const packed = { model, file, base, level, encode: encodeLevel };
  return new OpenMesh(name, { kind: 'packed', bytes: withLevels(file, level) }, decoded, packed);
}

/// A copy of the base's scene with another surface; materials and images are the base's.
function sceneWith(base: Decoded, level: BufferGeometry): Pick<Decoded, 'scene' | 'missing' | 'dispose'> {
  const scene: Object3D = base.scene!.clone(true);
  const geometries = showLevel(scene, level);
  const dispose = () => [level, ...geometries].forEach((geometry) => geometry.dispose());
  return { scene, missing: base.missing, dispose };
}

async function encodeScene(file: Bytes, surface: DecodedTriangles, geometry: BufferGeometry): Promise<Bytes> {
  const draco = await encode(surface);
  const { min, max } = new Box3().setFromBufferAttribute(geometry.getAttribute('position') as never);
  const names = ['POSITION', ...(surface.texcoords ? ['TEXCOORD_0'] : []), ...(surface.normals ? ['NORMAL'] : [])];
  return withSurface(file, {
    draco,
    points: surface.positions.length / 3,
    faces: surface.triangles.length / 3,
    attributes: Object.fromEntries(names.map((name, id) => [name, id])),
    min: min.toArray(),
    max: max.toArray(),
  });
}
