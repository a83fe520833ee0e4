// Table of a packed model's streams (proto/detail.md).

import { refuse } from './document.js';

/// Distances to the original, the larger of both directions, as shares of the diagonal of its bounding box.
export interface Reach {
  /// Root mean square distance.
  rms: number;
  largest: number;
}

/// Independently coded part of a level: the residuals below some neighbouring faces of the base. Its bounds hold for
/// the last level's surface below those faces.
export interface Piece {
  /// Length of its residuals.
  bytes: number;
  /// Length of its residuals of texture coordinates and colours, which follow.
  texcoordBytes: number;
  /// Upper bound of the distance by which its residuals move a vertex.
  largestMove: number;
  /// Bounding sphere of the surface.
  centre: [number, number, number];
  radius: number;
  /// Cone of the surface's normals: `leastCosine` is a lower bound of their cosine with the axis.
  axis: [number, number, number];
  leastCosine: number;
}

export interface LevelRow extends Reach {
  /// Quantization step of the residuals.
  step: number;
  /// Length of the residuals.
  bytes: number;
  /// Quantization step of the residuals of texture coordinates; for colours, 2048 times this value. 0: all are 0.
  texcoordStep: number;
  /// Length of the residuals of texture coordinates and colours.
  texcoordBytes: number;
  /// Pieces in the order of their bytes; empty for one piece.
  pieces: readonly Piece[];
}

export interface LevelTable extends Reach {
  /// Edges of the base.
  edges: number;
  curveBytes: number;
  /// Whether levels have residuals of texture coordinates or colours.
  hasTexcoords: boolean;
  /// Rows of the levels, coarse first.
  rows: LevelRow[];
}

/// Length of the prefix that sizeOfRows() reads.
export const leastTableBytes = 18;
const rowBytes = 16;
const texcoordRowBytes = 8;
const pieceCountBytes = 4;
const pieceBytes = 40;
const texcoordPieceBytes = 4;
const mostLevels = 10;
const mostPieces = 65535;
const mostCoordinate = 1e18;
const mostFloat = 2 ** 128;

/// Layout of the rows, by the flags of the table.
interface Layout {
  hasTexcoords: boolean;
  hasPieces: boolean;
  row: number;
  piece: number;
}

function layoutOf(hasTexcoords: boolean, hasPieces: boolean): Layout {
  const row = rowBytes + (hasTexcoords ? texcoordRowBytes : 0) + (hasPieces ? pieceCountBytes : 0);
  return { hasTexcoords, hasPieces, row, piece: pieceBytes + (hasTexcoords ? texcoordPieceBytes : 0) };
}

/// Returns the layout of the rows by the flags of the table.
function layoutIn(bytes: Uint8Array): Layout {
  const flags = bytes[1]!;
  if (flags > 3) refuse('the table of levels', 'has unknown flags');
  return layoutOf(flags % 2 === 1, flags >= 2);
}
const nameOf = (level: number) => `the row of level ${level + 1}`;

/// Returns the length of a table up to the end of its levels' rows, from its prefix. Throws Problem for too many
/// levels.
export function sizeOfRows(bytes: Uint8Array): number {
  const levels = bytes[0]!;
  const { row } = layoutIn(bytes);
  if (levels > mostLevels) refuse('the table of levels', `has ${levels} of them; at most ${mostLevels} are allowed`);
  return leastTableBytes + levels * row;
}

/// Returns the number of pieces of each level, from the bytes up to the end of the rows; 0 for a level without pieces.
function pieceCounts(bytes: Uint8Array): number[] {
  const { row, hasPieces } = layoutIn(bytes);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  return Array.from({ length: bytes[0]! }, (_, l) => {
    if (!hasPieces) return 0;
    const count = view.getUint32(leastTableBytes + (l + 1) * row - pieceCountBytes, true);
    if (count < 1 || count > mostPieces) refuse(nameOf(l), `has ${count} pieces; 1 to ${mostPieces} are allowed`);
    return count > 1 ? count : 0;
  });
}

/// Returns the length of a table, from the bytes up to the end of its rows. Throws Problem if a level has no or too
/// many pieces.
export function sizeOfTable(bytes: Uint8Array): number {
  const { piece } = layoutIn(bytes);
  return pieceCounts(bytes).reduce((sum, count) => sum + count * piece, sizeOfRows(bytes));
}

/// Reads a table. Throws Problem mesh_not_gltf: a step, distance or bound is out of its range, or the bytes of pieces
/// do not match their level.
export function readTable(bytes: Uint8Array): LevelTable {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const layout = layoutIn(bytes);
  const counts = pieceCounts(bytes);
  const rows = counts.map((_, l) => rowAt(view, leastTableBytes + l * layout.row, layout, nameOf(l)));
  let at = sizeOfRows(bytes);
  for (const [l, row] of rows.entries()) {
    const pieces: Piece[] = [];
    for (let p = 0; p < counts[l]!; ++p, at += layout.piece) pieces.push(pieceAt(view, at, layout, nameOf(l)));
    const sum = (of: 'bytes' | 'texcoordBytes') => pieces.reduce((total, piece) => total + piece[of], 0);
    if (pieces.length > 0 && (sum('bytes') !== row.bytes || sum('texcoordBytes') !== row.texcoordBytes))
      refuse(nameOf(l), 'has other bytes than its pieces together');
    row.pieces = pieces;
  }
  const [edges, curveBytes] = [view.getUint32(2, true), view.getUint32(6, true)];
  const { hasTexcoords } = layout;
  return { edges, curveBytes, hasTexcoords, ...reachAt(view, 10, "the base's row"), rows };
}

function reachAt(view: DataView, at: number, where: string): Reach {
  const [rms, largest] = [view.getFloat32(at, true), view.getFloat32(at + 4, true)];
  for (const distance of [rms, largest])
    if (!(distance >= 0 && distance < Infinity)) refuse(where, 'has a distance that is negative or not finite');
  return { rms, largest };
}

/// Reads a row, without its pieces.
function rowAt(view: DataView, at: number, { hasTexcoords }: Layout, where: string): LevelRow {
  const stepAt = (place: number, mayBeZero: boolean) => {
    const step = view.getFloat32(place, true);
    if (!(step > 0 || (mayBeZero && step === 0)) || step > mostCoordinate)
      refuse(where, 'has a step that is not above 0 and at most 1e18');
    return step;
  };
  const row = { step: stepAt(at, false), ...reachAt(view, at + 4, where), bytes: view.getUint32(at + 12, true) };
  const texcoordStep = hasTexcoords ? stepAt(at + rowBytes, true) : 0;
  const texcoordBytes = hasTexcoords ? view.getUint32(at + rowBytes + 4, true) : 0;
  if (texcoordStep === 0 && texcoordBytes > 0) refuse(where, 'has texture coordinates without a step');
  return { ...row, texcoordStep, texcoordBytes, pieces: [] };
}

function pieceAt(view: DataView, at: number, { hasTexcoords }: Layout, where: string): Piece {
  const begin = at + (hasTexcoords ? texcoordPieceBytes : 0);
  const [largestMove, x, y, z, radius, u, v, w, leastCosine] = Array.from({ length: 9 }, (_, i) =>
    view.getFloat32(begin + 4 + 4 * i, true),
  ) as [number, number, number, number, number, number, number, number, number];
  const bounds = { largestMove, radius, leastCosine };
  const within = (number: number, least: number, most: number) => number >= least && number <= most;
  const are =
    [largestMove, radius].every((number) => number >= 0 && number < mostFloat) &&
    [x, y, z].every((number) => Math.abs(number) < mostFloat) &&
    [u, v, w, leastCosine].every((number) => within(number, -1, 1));
  if (!are) refuse(where, 'has a bound that is not finite or out of its range');
  const texcoordBytes = hasTexcoords ? view.getUint32(at + 4, true) : 0;
  return { bytes: view.getUint32(at, true), texcoordBytes, ...bounds, centre: [x, y, z], axis: [u, v, w] };
}

export function writeTable({
  edges,
  curveBytes,
  hasTexcoords,
  rms,
  largest,
  rows,
}: LevelTable): Uint8Array<ArrayBuffer> {
  const layout = layoutOf(
    hasTexcoords,
    rows.some(({ pieces }) => pieces.length > 0),
  );
  const pieces = rows.flatMap((row) => row.pieces);
  const bytes = new Uint8Array(leastTableBytes + rows.length * layout.row + pieces.length * layout.piece);
  const view = new DataView(bytes.buffer);
  bytes[0] = rows.length;
  bytes[1] = (hasTexcoords ? 1 : 0) + (layout.hasPieces ? 2 : 0);
  view.setUint32(2, edges, true);
  view.setUint32(6, curveBytes, true);
  const put = (at: number, ...numbers: number[]) => {
    for (const [i, number] of numbers.entries()) view.setFloat32(at + 4 * i, number, true);
  };
  put(10, rms, largest);
  for (const [l, row] of rows.entries()) {
    const at = leastTableBytes + l * layout.row;
    put(at, row.step, row.rms, row.largest);
    view.setUint32(at + 12, row.bytes, true);
    if (hasTexcoords) put(at + rowBytes, row.texcoordStep);
    if (hasTexcoords) view.setUint32(at + rowBytes + 4, row.texcoordBytes, true);
    if (layout.hasPieces) view.setUint32(at + layout.row - pieceCountBytes, Math.max(1, row.pieces.length), true);
  }
  for (const [p, piece] of pieces.entries()) {
    const at = leastTableBytes + rows.length * layout.row + p * layout.piece;
    view.setUint32(at, piece.bytes, true);
    if (hasTexcoords) view.setUint32(at + 4, piece.texcoordBytes, true);
    const bounds = [piece.largestMove, ...piece.centre, piece.radius, ...piece.axis, piece.leastCosine];
    put(at + layout.piece - 4 * bounds.length, ...bounds);
  }
  return bytes;
}
