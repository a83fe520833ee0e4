// Worker that measures distances; distance.ts starts it.

import { largestDistances } from './nearest_faces';

/// Arguments of largestDistances.
export interface ToDistanceMeasurer {
  positions: Float32Array;
  triangles: Uint32Array;
  points: Float32Array;
}
/// Answer to a message.
export type FromDistanceMeasurer = Float32Array<ArrayBuffer>;

self.onmessage = ({ data: { positions, triangles, points } }: MessageEvent<ToDistanceMeasurer>) => {
  const distances: FromDistanceMeasurer = largestDistances(positions, triangles, points);
  self.postMessage(distances, { transfer: [distances.buffer] });
};
