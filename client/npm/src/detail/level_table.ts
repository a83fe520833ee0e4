// The table of a packed model's streams (proto/detail.md), without texture coordinates.

import { refuse, refuseScene } from './document.js';

/// Distances to the original, the larger of both directions, as shares of the diagonal of its bounding box.
export interface Reach {
  /// Root mean square.
  rms: number;
  largest: number;
}

/// A part of a level that is coded by itself: the residuals below some neighbouring faces of the base. What it says of the
/// surface is said of that of the last level below those faces.
export interface Piece {
  /// Of its residuals.
  bytes: number;
  /// Upper bound of how far its residuals move a vertex.
  largestMove: number;
  /// A sphere that holds the surface.
  centre: [number, number, number];
  radius: number;
  /// A cone of the surface's normals: their cosine with the axis is no less.
  axis: [number, number, number];
  leastCosine: number;
}

export interface LevelRow extends Reach {
  /// Quantization step of the residuals.
  step: number;
  /// Of the residuals.
  bytes: number;
  /// In the order of their bytes. Empty: the level is one.
  pieces: readonly Piece[];
}

export interface LevelTable extends Reach {
  /// Of the base.
  edges: number;
  curveBytes: number;
  /// Coarse first.
  rows: LevelRow[];
}

/// Bytes from which sizeOfRows knows.
export const leastTableBytes = 18;
const rowBytes = 16;
const pieceCountBytes = 4;
const pieceBytes = 40;
const mostLevels = 10;
const mostPieces = 65535;
const mostCoordinate = 1e18;
const mostFloat = 2 ** 128;

/// Bytes of a row, by the flags of the table.
function bytesOfRow(flags: number): number {
  if (flags % 2 === 1) refuseScene('levels of texture coordinates');
  if (flags > 3) refuse('the table of levels', 'has unknown flags');
  return rowBytes + (flags === 2 ? pieceCountBytes : 0);
}
const nameOf = (level: number) => `the row of level ${level + 1}`;

/// Bytes of a table up to the end of its levels' rows, by its first ones. Throws Problem where it has too many levels.
export function sizeOfRows(bytes: Uint8Array): number {
  const [levels, flags] = [bytes[0]!, bytes[1]!];
  if (levels > mostLevels) refuse('the table of levels', `has ${levels} of them; at most ${mostLevels} are allowed`);
  return leastTableBytes + levels * bytesOfRow(flags);
}

/// Pieces of each level, by the bytes up to the end of the rows; 0 where it is not parted.
function pieceCounts(bytes: Uint8Array): number[] {
  const size = bytesOfRow(bytes[1]!);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  return Array.from({ length: bytes[0]! }, (_, l) => {
    if (size === rowBytes) return 0;
    const count = view.getUint32(leastTableBytes + l * size + rowBytes, true);
    if (count < 1 || count > mostPieces) refuse(nameOf(l), `has ${count} pieces; 1 to ${mostPieces} are allowed`);
    return count > 1 ? count : 0;
  });
}

/// Bytes of a table, by those up to the end of its rows. Throws Problem where a level has no or too many pieces.
export function sizeOfTable(bytes: Uint8Array): number {
  return pieceCounts(bytes).reduce((sum, count) => sum + count * pieceBytes, sizeOfRows(bytes));
}

/// Of all its bytes. Throws Problem: mesh_not_gltf (a step, distance or bound out of its range, pieces of other bytes than
/// their level).
export function readTable(bytes: Uint8Array): LevelTable {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const reachAt = (at: number, where: string): Reach => {
    const [rms, largest] = [view.getFloat32(at, true), view.getFloat32(at + 4, true)];
    for (const distance of [rms, largest])
      if (!(distance >= 0 && distance < Infinity)) refuse(where, 'has a distance that is negative or not finite');
    return { rms, largest };
  };
  const counts = pieceCounts(bytes);
  const rows = counts.map((_, l) => {
    const [at, where] = [leastTableBytes + l * bytesOfRow(bytes[1]!), nameOf(l)];
    const step = view.getFloat32(at, true);
    if (!(step > 0 && step <= mostCoordinate)) refuse(where, 'has a step that is not above 0 and at most 1e18');
    return { step, ...reachAt(at + 4, where), bytes: view.getUint32(at + 12, true), pieces: [] as Piece[] };
  });
  let at = sizeOfRows(bytes);
  for (const [l, row] of rows.entries()) {
    for (let p = 0; p < counts[l]!; ++p, at += pieceBytes) row.pieces.push(pieceAt(view, at, nameOf(l)));
    if (counts[l]! > 0 && row.pieces.reduce((sum, piece) => sum + piece.bytes, 0) !== row.bytes)
      refuse(nameOf(l), 'has other bytes than its pieces together');
  }
  const [edges, curveBytes] = [view.getUint32(2, true), view.getUint32(6, true)];
  return { edges, curveBytes, ...reachAt(10, "the base's row"), rows };
}

function pieceAt(view: DataView, at: number, where: string): Piece {
  const [largestMove, x, y, z, radius, u, v, w, leastCosine] = Array.from({ length: 9 }, (_, i) =>
    view.getFloat32(at + 4 + 4 * i, true),
  ) as [number, number, number, number, number, number, number, number, number];
  const bounds = { largestMove, radius, leastCosine };
  const within = (number: number, least: number, most: number) => number >= least && number <= most;
  const are =
    [largestMove, radius].every((number) => number >= 0 && number < mostFloat) &&
    [x, y, z].every((number) => Math.abs(number) < mostFloat) &&
    [u, v, w, leastCosine].every((number) => within(number, -1, 1));
  if (!are) refuse(where, 'has a bound that is not finite or out of its range');
  return { bytes: view.getUint32(at, true), ...bounds, centre: [x, y, z], axis: [u, v, w] };
}

export function writeTable({ edges, curveBytes, rms, largest, rows }: LevelTable): Uint8Array<ArrayBuffer> {
  const parted = rows.some(({ pieces }) => pieces.length > 0);
  const sizeOfRow = bytesOfRow(parted ? 2 : 0);
  const pieces = rows.flatMap((row) => row.pieces);
  const bytes = new Uint8Array(leastTableBytes + rows.length * sizeOfRow + pieces.length * pieceBytes);
  const view = new DataView(bytes.buffer);
  bytes[0] = rows.length;
  bytes[1] = parted ? 2 : 0;
  view.setUint32(2, edges, true);
  view.setUint32(6, curveBytes, true);
  const put = (at: number, ...numbers: number[]) => {
    for (const [i, number] of numbers.entries()) view.setFloat32(at + 4 * i, number, true);
  };
  put(10, rms, largest);
  for (const [l, row] of rows.entries()) {
    const at = leastTableBytes + l * sizeOfRow;
    put(at, row.step, row.rms, row.largest);
    view.setUint32(at + 12, row.bytes, true);
    if (parted) view.setUint32(at + rowBytes, Math.max(1, row.pieces.length), true);
  }
  for (const [p, piece] of pieces.entries()) {
    const at = leastTableBytes + rows.length * sizeOfRow + p * pieceBytes;
    view.setUint32(at, piece.bytes, true);
    put(at + 4, piece.largestMove, ...piece.centre, piece.radius, ...piece.axis, piece.leastCosine);
  }
  return bytes;
}
