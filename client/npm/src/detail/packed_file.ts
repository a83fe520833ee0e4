// Reads the parts of a packed model (proto/detail.md): the Draco stream of its base, its curves, and the residuals of each
// level.

import { Problem } from '../client.js';
import { isGlb, readContainer } from './container.js';
import { type NormalStyle, normalStyles } from './decoder.js';
import {
  arrayOf,
  element,
  extensionOf,
  index,
  type JsonObject,
  objectOf,
  only,
  refuse,
  refuseScene,
  whole,
} from './document.js';
import {
  leastTableBytes,
  type LevelRow,
  type LevelTable,
  type Piece,
  type Reach,
  readTable,
  sizeOfRows,
  sizeOfTable,
} from './level_table.js';

export type { Piece, Reach };

export interface PackedLevel extends Reach {
  /// Of the residuals.
  step: number;
  /// Of each piece its residuals, then those of its texture coordinates.
  residuals: Uint8Array<ArrayBuffer>;
  /// Quantization step of the residuals of texture coordinates; 0: all of them are 0.
  texcoordStep: number;
  /// Of those, among `residuals`.
  texcoordBytes: number;
  /// Parts of the residuals, one behind the other. Empty: they are one.
  pieces: readonly Piece[];
  /// Residuals of the level: the edges that it splits, by the table's count of those of the base.
  residualCount: number;
  /// Of the model with the levels up to this one.
  faces: number;
  /// Where its residuals end in the file, which is what a reader of the levels up to this one needs.
  end: number;
}

export interface PackedFile {
  base: Reach & {
    draco: Uint8Array<ArrayBuffer>;
    vertices: number;
    faces: number;
    edges: number;
    hasTexcoords: boolean;
    end: number;
  };
  /// How the original's normals are split.
  normals: NormalStyle;
  /// Whether the document has a material for the faces.
  hasMaterial: boolean;
  /// Empty: the base has no creases and no corners.
  curves: Uint8Array<ArrayBuffer>;
  /// Whole ones, coarse first.
  levels: PackedLevel[];
  /// Levels that the file declares: more than `levels` where it is cut.
  declaredLevels: number;
  /// Whether the table has texture coordinates.
  hasTexcoordLevels: boolean;
}

export interface ReadOptions {
  /// Most faces of the last level that the file declares.
  maxFaces?: number;
  /// Whether the file may end inside the bytes of a level, as a prefix does. Its whole levels are read.
  mayBeCut?: boolean;
}

/// Of the last level that `papilio pack` makes at most.
export const defaultMaxFaces = 8_000_000;

export const dracoExtension = 'KHR_draco_mesh_compression';
export const detailExtension = 'PAPILIO_detail';
export const primitivePlace = 'meshes[0].primitives[0]';
const detailPlace = `${primitivePlace}.extensions.${detailExtension}`;
const version = 2;

/// Whether the bytes are a .glb file with PAPILIO_detail on the only primitive of a mesh. Models of several primitives, one
/// for each material, are scenes here, which show their base. Reads the JSON alone.
export function isPacked(bytes: Uint8Array<ArrayBuffer>): boolean {
  if (!isGlb(bytes)) return false;
  try {
    const json = objectOf(readContainer(bytes, true).json, 'the JSON');
    return arrayOf(json, 'meshes').some((mesh) => {
      const primitives = arrayOf(objectOf(mesh, 'a mesh'), 'primitives');
      const first = objectOf(primitives[0], 'a primitive');
      return primitives.length === 1 && extensionOf(first, detailExtension, 'a primitive') !== null;
    });
  } catch {
    return false;
  }
}

/// Throws Problem: mesh_not_gltf (damaged, truncated, a member out of range), mesh_unsupported (no packed model, another
/// version, a scene that the format does not allow), result_too_large (more than `maxFaces`).
export function readPacked(bytes: Uint8Array<ArrayBuffer>, options: ReadOptions = {}): PackedFile {
  return new Reader(bytes, options).read();
}

export function primitiveOf(json: JsonObject): JsonObject {
  return only(only(json, 'meshes', 'mesh'), 'primitives', 'primitive');
}
export function detailOf(primitive: JsonObject): JsonObject | null {
  return extensionOf(primitive, detailExtension, primitivePlace);
}

/// Of whose bytes a file that is cut has the first ones.
interface View {
  name: string;
  offset: number;
  length: number;
  bytes: Uint8Array<ArrayBuffer>;
}

class Reader {
  readonly #json: JsonObject;
  readonly #binary: Uint8Array<ArrayBuffer>;
  /// Of the binary chunk in the file.
  readonly #offset: number;
  readonly #options: ReadOptions;
  /// Of the last view, in the binary chunk.
  #end = 0;

  constructor(bytes: Uint8Array<ArrayBuffer>, options: ReadOptions) {
    const { json, binary } = readContainer(bytes, options.mayBeCut ?? false);
    this.#json = objectOf(json, 'the JSON');
    this.#binary = binary;
    this.#offset = binary.byteOffset - bytes.byteOffset;
    this.#options = options;
  }

  read(): PackedFile {
    this.#requireVersionOfGltf();
    const primitive = this.#primitive();
    const detail = detailOf(primitive)!;
    const found = whole(detail, 'version', detailPlace);
    if (found !== version)
      throw new Problem(
        'mesh_unsupported',
        `${detailExtension} has version ${found}; version ${version} is supported. Update papilio, or pack the model again.`,
      );
    const { draco, vertices, hasTexcoords } = this.#base(primitive);
    const view = this.#view(index(detail, 'bufferView', detailPlace), detailPlace);
    const table = tableOf(view);
    const corners = this.#count(index(primitive, 'indices', primitivePlace));
    if (corners % 3 !== 0) refuse(primitivePlace, 'has indices of other than whole triangles');
    const faces = corners / 3;
    const [most, count] = [this.#options.maxFaces ?? defaultMaxFaces, table.rows.length];
    if (table.hasTexcoords && !hasTexcoords)
      refuse('the table of levels', 'has texture coordinates, and the base has no TEXCOORD_0');
    if (table.rows.some(({ pieces }) => pieces.length > faces))
      refuse('the table of levels', 'has more pieces than the base has faces');
    if (faces * 4 ** count > most)
      throw new Problem(
        'result_too_large',
        `The base of ${faces} faces has ${faces * 4 ** count} at level ${count}; the limit is ${most}.`,
      );
    const begin = this.#offset + view.offset;
    const levelsBegin = sizeOfTable(view.bytes) + table.curveBytes;
    if (levelsBegin > view.bytes.length) cut('the curves of its base');
    const { rms, largest, edges } = table;
    return {
      base: { rms, largest, draco, vertices, faces, edges, hasTexcoords, end: begin + levelsBegin },
      normals: normalsOf(detail),
      hasMaterial: primitive.material !== undefined,
      curves: view.bytes.subarray(levelsBegin - table.curveBytes, levelsBegin),
      levels: levelsOf(table, view.bytes, { begin, levelsBegin, faces }),
      declaredLevels: count,
      hasTexcoordLevels: table.hasTexcoords,
    };
  }

  #requireVersionOfGltf(): void {
    const asset = objectOf(this.#json.asset, 'asset');
    const wanted = asset.minVersion ?? asset.version;
    if (wanted !== '2.0' && !(typeof wanted === 'string' && wanted.startsWith('2.') && asset.minVersion === undefined))
      throw new Problem('mesh_unsupported', 'The document has another glTF version than 2.0, which is supported.');
  }

  #primitive(): JsonObject {
    const primitive = primitiveOf(this.#json);
    if (detailOf(primitive) === null) refuseScene(`no ${detailExtension}`);
    const node = only(this.#json, 'nodes', 'node');
    for (const key of ['matrix', 'translation', 'rotation', 'scale', 'skin', 'extensions'])
      if (node[key] !== undefined) refuseScene(`a node with ${key}`);
    for (const key of ['targets', 'mode']) if (primitive[key] !== undefined) refuseScene(`a primitive with ${key}`);
    const buffer = only(this.#json, 'buffers', 'buffer');
    if (buffer.uri !== undefined) refuseScene('other than one buffer, the binary chunk');
    const length = whole(buffer, 'byteLength', 'buffers[0]');
    if (length > this.#binary.length && !this.#options.mayBeCut)
      refuse('buffers[0]', `declares ${length} bytes, and there are ${this.#binary.length}`);
    return primitive;
  }

  /// Of an accessor.
  #count(accessor: number | null): number {
    if (accessor === null) refuse(primitivePlace, 'lacks an accessor of positions or indices');
    return whole(element(this.#json, 'accessors', accessor), 'count', `accessors[${accessor}]`);
  }

  #base(primitive: JsonObject): { draco: Uint8Array<ArrayBuffer>; vertices: number; hasTexcoords: boolean } {
    const draco = extensionOf(primitive, dracoExtension, primitivePlace);
    if (draco === null || primitive.attributes === undefined)
      refuse(primitivePlace, `has no base compressed by ${dracoExtension}`);
    const attributes = objectOf(primitive.attributes, `${primitivePlace}.attributes`);
    const hasTexcoords = attributes.TEXCOORD_0 !== undefined;
    if (Object.keys(attributes).some((name) => name !== 'POSITION' && name !== 'TEXCOORD_0'))
      refuseScene('other attributes than POSITION and TEXCOORD_0');
    const vertices = this.#count(index(attributes, 'POSITION', primitivePlace));
    const view = this.#view(index(draco, 'bufferView', primitivePlace), primitivePlace);
    if (view.bytes.length < view.length) cut('its base');
    return { draco: view.bytes, vertices, hasTexcoords };
  }

  /// A view, which begins at or after the end of the view before.
  #view(number: number | null, where: string): View {
    if (number === null) refuse(where, 'has no bufferView');
    const name = `bufferViews[${number}]`;
    const view = element(this.#json, 'bufferViews', number);
    for (const key of ['byteStride', 'extensions'])
      if (view[key] !== undefined) refuse(name, `holds a stream and has ${key}`);
    if (index(view, 'buffer', name) !== 0) refuse(name, 'is not in the binary chunk');
    const [offset, length] = [whole(view, 'byteOffset', name, 0), whole(view, 'byteLength', name)];
    const size = whole(objectOf(arrayOf(this.#json, 'buffers')[0], 'buffers[0]'), 'byteLength', 'buffers[0]');
    if (offset + length > size)
      refuse(name, `has the bytes ${offset} to ${offset + length} of buffers[0], which has ${size}`);
    if (offset < this.#end) refuse(name, `begins at byte ${offset}, before the end of the base at byte ${this.#end}`);
    this.#end = offset + length;
    return { name, offset, length, bytes: this.#binary.subarray(offset, this.#end) };
  }
}

/// The table at the begin of a view, which it and its streams fill.
function tableOf({ name, length, bytes }: View): LevelTable {
  const first = (size: number): Uint8Array => {
    if (length < size) refuse(name, 'is too short for its table of levels');
    if (bytes.length < size) cut('the table of its levels');
    return bytes.subarray(0, size);
  };
  const size = sizeOfTable(first(sizeOfRows(first(leastTableBytes))));
  const table = readTable(first(size));
  const total = table.rows.reduce((sum, row) => sum + row.bytes + row.texcoordBytes, size + table.curveBytes);
  if (length !== total) refuse(name, `has ${length} bytes, and its table declares ${total}`);
  return table;
}

/// The whole ones. `begin`: of the bytes in the file; `levelsBegin`: of the first level in the bytes.
function levelsOf(
  table: LevelTable,
  bytes: Uint8Array<ArrayBuffer>,
  { begin, levelsBegin, faces }: { begin: number; levelsBegin: number; faces: number },
): PackedLevel[] {
  const wholeOnes: PackedLevel[] = [];
  let [at, residualCount] = [levelsBegin, table.edges];
  for (const row of table.rows) {
    const length = row.bytes + row.texcoordBytes;
    const residuals = bytes.subarray(at, at + length);
    if (residuals.length < length) break;
    at += length;
    wholeOnes.push({ ...withoutBytes(row), residuals, residualCount, faces: 4 * faces, end: begin + at });
    residualCount = 2 * residualCount + 3 * faces;
    faces *= 4;
  }
  return wholeOnes;
}

function withoutBytes({ bytes: _, ...row }: LevelRow): Omit<LevelRow, 'bytes'> {
  return row;
}

function normalsOf(detail: JsonObject): NormalStyle {
  const name = detail.normals;
  if (name === undefined) return 'absent';
  const style = normalStyles.find((one) => one === name && one !== 'absent');
  return style ?? refuse(`${detailPlace}.normals`, 'must be "smooth", "creased" or "faceted"');
}

function cut(where: string): never {
  throw new Problem('mesh_not_gltf', `The file is cut inside ${where}, so no level can be read. Provide more of it.`);
}
