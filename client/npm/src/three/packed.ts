// Packed models as geometries and scenes of three.js.

import { BufferAttribute, BufferGeometry, type InterleavedBufferAttribute, Mesh, type Object3D } from 'three';
import type { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';

import { Problem } from '../client.js';
import type { DecodedTriangles, NormalStyle } from '../detail/decoder.js';
import type { OpenOptions, PackedModel } from '../detail/packed_model.js';
import { smooth } from './parts.js';

/// Function of DRACOLoader that GLTFLoader calls, and that its types lack. `parse` would return colours as floats in
/// sRGB.
type AttributeDecoder = {
  decodeDracoFile(
    draco: ArrayBuffer,
    onLoad: (geometry: BufferGeometry) => void,
    attributes: undefined,
    types: Record<string, string>,
    colorSpace: undefined,
    onError: () => void,
  ): Promise<void>;
};
const types = { position: 'Float32Array', uv: 'Float32Array', color: 'Uint8Array', normal: 'Float32Array' };

/// Decodes the base of a packed model, for openPacked().
export function dracoDecoder(loader: DRACOLoader): OpenOptions['decodeDraco'] {
  return async (draco) => {
    const geometry = await new Promise<BufferGeometry>((resolve, reject) => {
      const refuse = () => reject(new Problem('mesh_not_draco', 'The base of this packed model is damaged.'));
      // The bytes are transferred to the decoder's worker.
      const { buffer } = draco.slice();
      void (loader as unknown as AttributeDecoder).decodeDracoFile(
        buffer,
        resolve,
        undefined,
        types,
        undefined,
        refuse,
      );
    });
    const { position, uv, color } = geometry.attributes as Record<string, BufferAttribute | undefined>;
    return {
      positions: new Float32Array(position?.array ?? []),
      triangles: new Uint32Array(geometry.index?.array ?? []),
      ...(uv?.itemSize === 2 && { texcoords: new Float32Array(uv.array) }),
      ...(color?.itemSize === 3 && { colours: coloursOf(color) }),
    };
  };
}

/// Returns the values without the padding that DRACOLoader puts behind each.
function coloursOf(color: BufferAttribute | InterleavedBufferAttribute): Uint8Array<ArrayBuffer> {
  const stride = 'data' in color ? color.data.stride : color.itemSize;
  return Uint8Array.from({ length: 3 * color.count }, (_, i) => color.array[Math.floor(i / 3) * stride + (i % 3)]!);
}

export function geometryOf({ positions, triangles, texcoords, colours, normals }: DecodedTriangles): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  if (texcoords) geometry.setAttribute('uv', new BufferAttribute(texcoords, 2));
  if (colours) geometry.setAttribute('color', new BufferAttribute(colours, 3, true));
  if (normals) geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

/// Returns the style of a packed model's normals in a scene: if the original has none, the one of `papilio unpack` for
/// scenes.
export function sceneNormals({ normals }: PackedModel): NormalStyle {
  return normals === 'absent' ? 'creased' : normals;
}

/// Shows a level of a packed model in the scene that GLTFLoader makes of its file: each mesh gets the faces below its
/// own, in the order of the meshes. Keeps materials, with smooth shading if there are normals. Returns the geometries;
/// the geometry of a single mesh is the level itself.
export function showLevel(scene: Object3D, level: BufferGeometry): BufferGeometry[] {
  const meshes: Mesh[] = [];
  scene.traverse((object) => object instanceof Mesh && meshes.push(object as Mesh));
  const corners = meshes.map(({ geometry }) => geometry.index?.count ?? geometry.attributes.position!.count);
  const growth = level.index!.count / corners.reduce((sum, count) => sum + count, 0);
  let begin = 0;
  return meshes.map((mesh, m) => {
    const end = begin + growth * corners[m]!;
    mesh.geometry = meshes.length === 1 ? level : partOf(level, begin, end);
    if (level.hasAttribute('normal')) mesh.material = smooth(mesh.material);
    begin = end;
    return mesh.geometry;
  });
}

/// Returns the faces of these corners, with only their points.
function partOf(level: BufferGeometry, begin: number, end: number): BufferGeometry {
  const corners = level.index!.array.slice(begin, end);
  const numbers = new Uint32Array(level.attributes.position!.count); // 0: not of the part
  const points = new Uint32Array(corners.length);
  let count = 0;
  for (const [i, point] of corners.entries()) {
    if (numbers[point] === 0) {
      points[count++] = point;
      numbers[point] = count;
    }
    corners[i] = numbers[point]! - 1;
  }
  const part = new BufferGeometry().setIndex(new BufferAttribute(corners, 1));
  for (const [name, { array, itemSize, normalized }] of Object.entries(level.attributes)) {
    const values = array.slice(0, count * itemSize);
    for (let i = 0; i < values.length; ++i)
      values[i] = array[points[Math.floor(i / itemSize)]! * itemSize + (i % itemSize)]!;
    part.setAttribute(name, new BufferAttribute(values, itemSize, normalized));
  }
  return part;
}
