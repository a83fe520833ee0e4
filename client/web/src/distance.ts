// How far a mesh is from the uniform result.

import { type BufferGeometry, Vector3 } from 'three';

/// How long the page may be busy at a time, in milliseconds.
const slice = 12;

/// [faces of `mesh`]: the largest distance of those vertices of `uniform` that are nearest to the face, in the mesh's
/// units. Rejects with an AbortError once the signal says so.
export async function distancesToUniform(
  mesh: BufferGeometry,
  uniform: BufferGeometry,
  signal: AbortSignal,
): Promise<Float32Array> {
  const { MeshBVH } = await import('three-mesh-bvh');
  const searched = mesh.clone(); // the tree reorders its triangles
  searched.deleteAttribute('normal');
  const tree = new MeshBVH(searched, { indirect: true });
  const distances = new Float32Array(mesh.index!.count / 3);
  const position = uniform.getAttribute('position');
  const point = new Vector3();
  const nearest = { point: new Vector3(), distance: 0, faceIndex: 0 };
  let until = performance.now() + slice;
  for (let v = 0; v < position.count; ++v) {
    tree.closestPointToPoint(point.fromBufferAttribute(position, v), nearest);
    distances[nearest.faceIndex] = Math.max(distances[nearest.faceIndex], nearest.distance);
    if (v % 64 === 0 && performance.now() > until) {
      await new Promise((resolve) => setTimeout(resolve));
      signal.throwIfAborted();
      until = performance.now() + slice;
    }
  }
  return distances;
}
