// Worker that finds edges; edges.ts starts it.

import { edgesOf } from './mesh_edges';

/// Arguments of edgesOf.
export interface ToEdgeFinder {
  corners: ArrayLike<number>;
  vertices: number;
}
/// Answer to a message, in the order of the messages.
export type FromEdgeFinder = Uint32Array<ArrayBuffer>;

self.onmessage = ({ data: { corners, vertices } }: MessageEvent<ToEdgeFinder>) => {
  const ends: FromEdgeFinder = edgesOf(corners, vertices);
  self.postMessage(ends, { transfer: [ends.buffer] });
};
