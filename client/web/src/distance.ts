// Distance of a mesh from the uniform result, measured in a worker: the search tree of a large mesh takes longer than a
// frame.

import type { BufferGeometry } from 'three';

import { positionsOf } from './bounds';
import type { FromDistanceMeasurer, ToDistanceMeasurer } from './distance_worker';

/// Returns [faces of `mesh`] the largest distance of the vertices of `uniform` that are nearest to the face, in mesh
/// units. Rejects with an AbortError once the signal is aborted.
export async function distancesToUniform(
  mesh: BufferGeometry,
  uniform: BufferGeometry,
  signal: AbortSignal,
): Promise<Float32Array> {
  signal.throwIfAborted();
  const worker = new Worker(new URL('./distance_worker.ts', import.meta.url), {
    type: 'module',
    name: 'papilio-distance',
  });
  try {
    return await new Promise<Float32Array>((resolve, reject) => {
      signal.addEventListener('abort', () => reject(signal.reason as Error), { once: true });
      worker.onmessage = ({ data }: MessageEvent<FromDistanceMeasurer>) => resolve(data);
      worker.onerror = ({ message }) =>
        reject(new Error(`The distance cannot be measured: ${message || 'its script could not be loaded'}.`));
      const triangles = mesh.index!.array;
      const message: ToDistanceMeasurer = {
        positions: positionsOf(mesh),
        triangles: triangles instanceof Uint32Array ? triangles : Uint32Array.from(triangles),
        points: positionsOf(uniform),
      };
      worker.postMessage(message);
    });
  } finally {
    worker.terminate();
  }
}
