// The table of a packed model's streams (proto/detail.md), without texture coordinates.

import { refuse, refuseScene } from './document.js';

/// Distances to the original, the larger of both directions, as shares of the diagonal of its bounding box.
export interface Reach {
  /// Root mean square.
  rms: number;
  largest: number;
}

export interface LevelRow extends Reach {
  /// Quantization step of the residuals.
  step: number;
  /// Of the residuals.
  bytes: number;
}

export interface LevelTable extends Reach {
  /// Of the base.
  edges: number;
  curveBytes: number;
  /// Coarse first.
  rows: LevelRow[];
}

/// Bytes from which sizeOfTable knows.
export const leastTableBytes = 18;
const rowBytes = 16;
const mostLevels = 10;
const mostCoordinate = 1e18;

/// Bytes of a table, by its first ones. Throws Problem where it has too many levels.
export function sizeOfTable(bytes: Uint8Array): number {
  const [levels, flags] = [bytes[0]!, bytes[1]!];
  if (levels > mostLevels) refuse('the table of levels', `has ${levels} of them; at most ${mostLevels} are allowed`);
  if (flags === 1) refuseScene('levels of texture coordinates');
  if (flags !== 0) refuse('the table of levels', 'has unknown flags');
  return leastTableBytes + levels * rowBytes;
}

/// Of all its bytes. Throws Problem: mesh_not_gltf (a step or distance out of its range).
export function readTable(bytes: Uint8Array): LevelTable {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const reachAt = (at: number, where: string): Reach => {
    const [rms, largest] = [view.getFloat32(at, true), view.getFloat32(at + 4, true)];
    for (const distance of [rms, largest])
      if (!(distance >= 0 && distance < Infinity)) refuse(where, 'has a distance that is negative or not finite');
    return { rms, largest };
  };
  const rows = Array.from({ length: bytes[0]! }, (_, l) => {
    const [at, where] = [leastTableBytes + l * rowBytes, `the row of level ${l + 1}`];
    const step = view.getFloat32(at, true);
    if (!(step > 0 && step <= mostCoordinate)) refuse(where, 'has a step that is not above 0 and at most 1e18');
    return { step, ...reachAt(at + 4, where), bytes: view.getUint32(at + 12, true) };
  });
  const [edges, curveBytes] = [view.getUint32(2, true), view.getUint32(6, true)];
  return { edges, curveBytes, ...reachAt(10, "the base's row"), rows };
}

export function writeTable({ edges, curveBytes, rms, largest, rows }: LevelTable): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(leastTableBytes + rows.length * rowBytes);
  const view = new DataView(bytes.buffer);
  bytes[0] = rows.length;
  view.setUint32(2, edges, true);
  view.setUint32(6, curveBytes, true);
  const put = (at: number, reach: Reach) => {
    view.setFloat32(at, reach.rms, true);
    view.setFloat32(at + 4, reach.largest, true);
  };
  put(10, { rms, largest });
  for (const [l, row] of rows.entries()) {
    const at = leastTableBytes + l * rowBytes;
    view.setFloat32(at, row.step, true);
    put(at + 4, row);
    view.setUint32(at + 12, row.bytes, true);
  }
  return bytes;
}
