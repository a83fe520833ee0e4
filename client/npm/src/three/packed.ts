// Packed models as geometries of three.js.

import { BufferAttribute, BufferGeometry } from 'three';
import type { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';

import { Problem } from '../client.js';
import type { DecodedTriangles } from '../detail/decoder.js';
import { type OpenOptions, openPacked } from '../detail/packed_model.js';

/// Decodes the base of a packed model, for openPacked.
export function dracoDecoder(loader: DRACOLoader): OpenOptions['decodeDraco'] {
  return async (draco) => {
    const geometry = await new Promise<BufferGeometry>((resolve, reject) =>
      // The decoder's worker takes the bytes for good.
      loader.parse(draco.slice().buffer, resolve, () =>
        reject(new Problem('mesh_not_draco', 'The base of this packed model is damaged.')),
      ),
    );
    const position = geometry.attributes.position as BufferAttribute | undefined;
    return {
      positions: new Float32Array(position?.array ?? []),
      triangles: new Uint32Array(geometry.index?.array ?? []),
    };
  };
}

/// Without normals.
export function geometryOf({ positions, triangles }: DecodedTriangles): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

/// The surface with all its levels.
export async function decodePacked(file: Uint8Array<ArrayBuffer>, options: OpenOptions): Promise<BufferGeometry> {
  const model = await openPacked(file, options);
  try {
    return geometryOf(await model.decode(model.levels.length));
  } finally {
    model.close();
  }
}
