// Levels of packed models as open meshes.

import { isPacked, openPacked, type PackedModel, withLevels, withSurfaces } from 'papilio/detail';
import { dracoDecoder, geometryOf, sceneNormals, showLevel } from 'papilio/three';
import { Box3, type BufferAttribute, type BufferGeometry, type Object3D } from 'three';

import { encode, fetchDecoder, type Surface } from './draco';
import { OpenMesh } from './mesh';
import type { Bytes, Decoded } from './model';
import { decodeScene } from './scene';

export { isPacked };

/// Members shared by all levels of a packed model.
interface Opened {
  readonly model: PackedModel;
  /// Bytes of the complete file.
  readonly file: Bytes;
  /// Base as a scene with its materials and colours; null if the file has none.
  readonly base: Decoded | null;
}

/// Level of a packed model.
export interface PackedLevel extends Opened {
  /// Number of levels added to the base; 0: the base.
  readonly level: number;
  /// Encodes the surface for the server: as a scene if it has materials or colours.
  encode(): Promise<Bytes>;
}

/// Most faces of a level shown before the user selects one.
const mostFacesAtFirst = 300_000;

/// Opens a model at its last level, or at the last that browsers show smoothly. Rejects with a Problem.
export async function openPackedMesh(name: string, file: Bytes): Promise<OpenMesh> {
  const model = await openPacked(file, { decodeDraco: async (draco) => dracoDecoder(await fetchDecoder())(draco) });
  try {
    const base = model.hasMaterial || model.hasColours ? await decodeScene(file) : null;
    const level = model.levels.filter(({ faces }) => faces <= mostFacesAtFirst).length;
    return await levelOf(name, { model, file, base }, level);
  } catch (error) {
    model.close();
    throw error;
  }
}

/// Opens a model at a level. Rejects with a Problem.
export async function levelOf(name: string, { model, file, base }: Opened, level: number): Promise<OpenMesh> {
  const surface = await model.decode(level, base ? { normals: sceneNormals(model) } : {});
  const geometry = geometryOf(surface);
  const shown = base === null ? null : sceneWith(base, geometry);
  const decoded = {
    geometry,
    vertices: surface.positions.length / 3,
    faces: surface.triangles.length / 3,
    scene: shown?.scene ?? null,
    missing: base?.missing ?? [],
    dispose: () => [geometry, ...(shown?.geometries ?? [])].forEach((one) => one.dispose()),
  };
  const encodeLevel = () => (shown === null ? encode(surface) : encodeScene(file, shown.geometries));
  const packed = { model, file, base, level, encode: encodeLevel };
  return new OpenMesh(name, { kind: 'packed', bytes: withLevels(file, level) }, decoded, packed);
}

/// Returns a copy of the base's scene with the surfaces of a level, one for each primitive; it shares materials and
/// images.
function sceneWith(base: Decoded, level: BufferGeometry): { scene: Object3D; geometries: BufferGeometry[] } {
  const scene: Object3D = base.scene!.clone(true);
  return { scene, geometries: showLevel(scene, level) };
}

async function encodeScene(file: Bytes, geometries: readonly BufferGeometry[]): Promise<Bytes> {
  const boxes = geometries.map((one) =>
    new Box3().setFromBufferAttribute(one.getAttribute('position') as BufferAttribute),
  );
  const whole = boxes.reduce((all, box) => all.clone().union(box));
  const surfaces = [];
  for (const [g, geometry] of geometries.entries()) {
    const names = ['position', 'uv', 'color', 'normal'].filter((name) => geometry.hasAttribute(name));
    surfaces.push({
      draco: await encode(surfaceOf(geometry), whole),
      points: geometry.getAttribute('position').count,
      faces: geometry.index!.count / 3,
      attributes: Object.fromEntries(names.map((name, id) => [gltfNames[name], id])),
      min: boxes[g].min.toArray(),
      max: boxes[g].max.toArray(),
    });
  }
  return withSurfaces(file, surfaces);
}

const gltfNames: Record<string, string> = {
  position: 'POSITION',
  uv: 'TEXCOORD_0',
  color: 'COLOR_0',
  normal: 'NORMAL',
};

function surfaceOf(geometry: BufferGeometry): Surface {
  const { position, uv, color, normal } = geometry.attributes;
  return {
    positions: position.array as Float32Array,
    triangles: geometry.index!.array as Uint32Array,
    ...(uv && { texcoords: uv.array as Float32Array }),
    ...(color && { colours: color.array as Uint8Array }),
    ...(normal && { normals: normal.array as Float32Array }),
  };
}
