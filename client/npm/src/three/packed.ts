// Packed models as geometries and scenes of three.js.

import { BufferAttribute, BufferGeometry, Mesh, type Object3D } from 'three';
import type { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';

import { Problem } from '../client.js';
import type { DecodedTriangles, NormalStyle } from '../detail/decoder.js';
import type { OpenOptions, PackedModel } from '../detail/packed_model.js';
import { smooth } from './parts.js';

/// Decodes the base of a packed model, for openPacked.
export function dracoDecoder(loader: DRACOLoader): OpenOptions['decodeDraco'] {
  return async (draco) => {
    const geometry = await new Promise<BufferGeometry>((resolve, reject) =>
      // The decoder's worker takes the bytes for good.
      loader.parse(draco.slice().buffer, resolve, () =>
        reject(new Problem('mesh_not_draco', 'The base of this packed model is damaged.')),
      ),
    );
    const [position, uv] = [geometry.attributes.position, geometry.attributes.uv] as (BufferAttribute | undefined)[];
    return {
      positions: new Float32Array(position?.array ?? []),
      triangles: new Uint32Array(geometry.index?.array ?? []),
      ...(uv?.itemSize === 2 && { texcoords: new Float32Array(uv.array) }),
    };
  };
}

export function geometryOf({ positions, triangles, texcoords, normals }: DecodedTriangles): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  if (texcoords) geometry.setAttribute('uv', new BufferAttribute(texcoords, 2));
  if (normals) geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

/// Normals of a packed model that is shown as a scene: where its original has none, those of `papilio unpack` for scenes.
export function sceneNormals({ normals }: PackedModel): NormalStyle {
  return normals === 'absent' ? 'creased' : normals;
}

/// Shows a level of a packed model in the scene that GLTFLoader makes of its file: each mesh gets the faces below its own,
/// which come in the order of the meshes. Materials stay, smooth where there are normals. Returns the geometries, which
/// share the level's arrays.
export function showLevel(scene: Object3D, level: BufferGeometry): BufferGeometry[] {
  const meshes: Mesh[] = [];
  scene.traverse((object) => object instanceof Mesh && meshes.push(object as Mesh));
  const corners = meshes.map(({ geometry }) => geometry.index?.count ?? geometry.attributes.position!.count);
  const index = level.index!.array;
  const growth = index.length / corners.reduce((sum, count) => sum + count, 0);
  let begin = 0;
  return meshes.map((mesh, m) => {
    const end = begin + growth * corners[m]!;
    mesh.geometry = meshes.length === 1 ? level : new BufferGeometry().copy(level);
    if (meshes.length > 1) mesh.geometry.setIndex(new BufferAttribute(index.subarray(begin, end), 1));
    if (level.hasAttribute('normal')) mesh.material = smooth(mesh.material);
    begin = end;
    return mesh.geometry;
  });
}
