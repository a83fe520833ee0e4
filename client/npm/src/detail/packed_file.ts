// Reader of the parts of a packed model (proto/detail.md): the Draco streams of its base, its curves, and the residuals
// of each level.

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
  /// Quantization step of the residuals.
  step: number;
  /// Residuals of each piece, each followed by those of its texture coordinates and colours.
  residuals: Uint8Array<ArrayBuffer>;
  /// Quantization step of the residuals of texture coordinates; for colours, 2048 times this value. 0: all are 0.
  texcoordStep: number;
  /// Length of the residuals of texture coordinates and colours in `residuals`.
  texcoordBytes: number;
  /// Consecutive pieces of the residuals; empty for one piece.
  pieces: readonly Piece[];
  /// Number of residuals of the level: edges that it splits, by the table's count for the base.
  residualCount: number;
  /// Distances of the model with the levels up to this one.
  faces: number;
  /// End of its residuals in the file: the bytes that a reader of the levels up to this one requires.
  end: number;
}

/// Faces of the base with one material.
export interface PackedPrimitive {
  draco: Uint8Array<ArrayBuffer>;
  vertices: number;
  faces: number;
  /// Number of its part: 0 without a material, else 1 and the number of its material in the order of their first use.
  part: number;
}

export interface PackedFile {
  base: Reach & {
    /// Primitives in the order of the faces.
    primitives: readonly PackedPrimitive[];
    /// Points of all primitives: a vertex between two counts in both.
    vertices: number;
    faces: number;
    edges: number;
    hasTexcoords: boolean;
    hasColours: boolean;
    end: number;
  };
  /// Style of the original's normals.
  normals: NormalStyle;
  /// Whether the document has a material for any of the faces.
  hasMaterial: boolean;
  /// Coded curves; empty if the base has no creases and no corners.
  curves: Uint8Array<ArrayBuffer>;
  /// Complete levels, coarse first.
  levels: PackedLevel[];
  /// Number of levels that the file declares: more than `levels` if it is cut.
  declaredLevels: number;
  /// Whether levels have residuals of texture coordinates or colours.
  hasTexcoordLevels: boolean;
}

export interface ReadOptions {
  /// Limit of the faces of the last declared level.
  maxFaces?: number;
  /// Whether the file may be a prefix that ends inside a level. Its complete levels are read.
  mayBeCut?: boolean;
}

/// Upper bound of the faces of the last level that `papilio pack` makes.
export const defaultMaxFaces = 8_000_000;

export const dracoExtension = 'KHR_draco_mesh_compression';
export const detailExtension = 'PAPILIO_detail';
export const placeOf = (primitive: number) => `meshes[0].primitives[${primitive}]`;
const detailPlace = `${placeOf(0)}.extensions.${detailExtension}`;
const version = 3;

/// Returns whether the bytes are a .glb file with PAPILIO_detail on a primitive. Reads only the JSON.
export function isPacked(bytes: Uint8Array<ArrayBuffer>): boolean {
  if (!isGlb(bytes)) return false;
  try {
    const json = objectOf(readContainer(bytes, true).json, 'the JSON');
    return arrayOf(json, 'meshes').some((mesh) =>
      arrayOf(objectOf(mesh, 'a mesh'), 'primitives').some(
        (primitive) => extensionOf(objectOf(primitive, 'a primitive'), detailExtension, 'a primitive') !== null,
      ),
    );
  } catch {
    return false;
  }
}

/// Reads a packed model. Throws Problem: mesh_not_gltf (damaged, truncated, a member out of range), mesh_unsupported
/// (no packed model, another version, a scene that the format does not permit), result_too_large (more than
/// `maxFaces`).
export function readPacked(bytes: Uint8Array<ArrayBuffer>, options: ReadOptions = {}): PackedFile {
  return new Reader(bytes, options).read();
}

export function primitivesOf(json: JsonObject): JsonObject[] {
  const primitives = arrayOf(only(json, 'meshes', 'mesh'), 'primitives');
  if (primitives.length === 0) refuse('meshes[0]', 'has no primitives');
  return primitives.map((primitive, p) => objectOf(primitive, placeOf(p)));
}
/// Returns the extension of the first primitive.
export function detailOf(primitives: readonly JsonObject[]): JsonObject | null {
  return extensionOf(primitives[0]!, detailExtension, placeOf(0));
}

/// View with its bytes, which may be fewer in a cut file.
interface View {
  name: string;
  offset: number;
  length: number;
  bytes: Uint8Array<ArrayBuffer>;
}

class Reader {
  readonly #json: JsonObject;
  readonly #binary: Uint8Array<ArrayBuffer>;
  /// Offset of the binary chunk in the file.
  readonly #offset: number;
  readonly #options: ReadOptions;
  /// End of the last view in the binary chunk.
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
    const primitives = this.#primitives();
    const detail = detailOf(primitives)!;
    const found = whole(detail, 'version', detailPlace);
    if (found !== version)
      throw new Problem(
        'mesh_unsupported',
        `${detailExtension} has version ${found}; version ${version} is supported. Update papilio, or pack the model again.`,
      );
    const streams = primitives.map((primitive, p) => this.#stream(primitive, placeOf(p)));
    const view = this.#view(index(detail, 'bufferView', detailPlace), detailPlace);
    const table = tableOf(view);
    const faceCounts = primitives.map((primitive, p) => this.#faces(primitive, placeOf(p)));
    const faces = sumOf(faceCounts);
    const [most, count] = [this.#options.maxFaces ?? defaultMaxFaces, table.rows.length];
    if (faces * 4 ** count > most)
      throw new Problem(
        'result_too_large',
        `The base of ${faces} faces has ${faces * 4 ** count} at level ${count}; the limit is ${most}.`,
      );
    if (table.rows.some(({ pieces }) => pieces.length > faces))
      refuse('the table of levels', 'has more pieces than the base has faces');
    const normals = normalsOf(detail);
    const values = valuesOf(primitives);
    if (table.hasTexcoords && values.length === 0)
      refuse(
        'the table of levels',
        'has residuals of texture coordinates or colours, and the base has neither TEXCOORD_0 nor COLOR_0',
      );
    const partOf = partNumbers();
    const made = primitives.map((primitive, p) => {
      const vertices = this.#vertices(primitive, placeOf(p));
      return { draco: streams[p]!, vertices, faces: faceCounts[p]!, part: partOf(primitive, placeOf(p)) };
    });
    const begin = this.#offset + view.offset;
    const levelsBegin = sizeOfTable(view.bytes) + table.curveBytes;
    if (levelsBegin > view.bytes.length) cut('the curves of its base');
    const { rms, largest, edges } = table;
    return {
      base: {
        ...{ rms, largest, primitives: made, faces, edges, end: begin + levelsBegin },
        vertices: sumOf(made.map(({ vertices }) => vertices)),
        hasTexcoords: values.includes('TEXCOORD_0'),
        hasColours: values.includes('COLOR_0'),
      },
      normals,
      hasMaterial: primitives.some(({ material }) => material !== undefined),
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

  #primitives(): JsonObject[] {
    const primitives = primitivesOf(this.#json);
    if (detailOf(primitives) === null) refuseScene(`no ${detailExtension}`);
    const node = only(this.#json, 'nodes', 'node');
    for (const key of ['matrix', 'translation', 'rotation', 'scale', 'skin', 'extensions'])
      if (node[key] !== undefined) refuseScene(`a node with ${key}`);
    const buffer = only(this.#json, 'buffers', 'buffer');
    if (buffer.uri !== undefined) refuseScene('other than one buffer, the binary chunk');
    const length = whole(buffer, 'byteLength', 'buffers[0]');
    if (length > this.#binary.length && !this.#options.mayBeCut)
      refuse('buffers[0]', `declares ${length} bytes, and there are ${this.#binary.length}`);
    for (const [p, primitive] of primitives.entries()) {
      for (const key of ['targets', 'mode']) if (primitive[key] !== undefined) refuseScene(`a primitive with ${key}`);
      if (p > 0 && extensionOf(primitive, detailExtension, placeOf(p)) !== null)
        refuseScene(`several primitives with ${detailExtension}`);
    }
    return primitives;
  }

  /// Returns the count of an accessor.
  #count(accessor: number | null, place: string): number {
    if (accessor === null) refuse(place, 'lacks an accessor of positions or indices');
    return whole(element(this.#json, 'accessors', accessor), 'count', `accessors[${accessor}]`);
  }

  #vertices(primitive: JsonObject, place: string): number {
    return this.#count(index(attributesOf(primitive, place), 'POSITION', place), place);
  }

  #faces(primitive: JsonObject, place: string): number {
    const corners = this.#count(index(primitive, 'indices', place), place);
    if (corners % 3 !== 0) refuse(place, 'has indices of other than whole triangles');
    return corners / 3;
  }

  /// Returns the Draco stream of a primitive.
  #stream(primitive: JsonObject, place: string): Uint8Array<ArrayBuffer> {
    const draco = extensionOf(primitive, dracoExtension, place);
    if (draco === null) refuse(place, `has no base compressed by ${dracoExtension}`);
    const view = this.#view(index(draco, 'bufferView', place), place);
    if (view.bytes.length < view.length) cut('its base');
    return view.bytes;
  }

  /// Returns a view, which must begin at or after the end of the view before.
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

function attributesOf(primitive: JsonObject, place: string): JsonObject {
  if (primitive.attributes === undefined) refuse(place, 'has no attributes');
  return objectOf(primitive.attributes, `${place}.attributes`);
}

/// Returns the attributes of the base besides its positions, in its order. Refuses others.
function valuesOf(primitives: readonly JsonObject[]): string[] {
  const all = primitives.map((primitive, p) => {
    const attributes = attributesOf(primitive, placeOf(p));
    const values = ['TEXCOORD_0', 'COLOR_0'].filter((name) => attributes[name] !== undefined);
    if (Object.keys(attributes).length !== 1 + values.length)
      refuseScene('other attributes than POSITION, TEXCOORD_0 and COLOR_0');
    return values;
  });
  if (all.some((values) => values.join() !== all[0]!.join())) refuseScene('primitives of different attributes');
  return all[0]!;
}

/// Numbers materials in the order of their first use, for part numbers of primitives.
function partNumbers(): (primitive: JsonObject, place: string) => number {
  const numbers = new Map<number, number>();
  return (primitive, place) => {
    const material = index(primitive, 'material', place);
    if (material === null) return 0;
    if (!numbers.has(material)) numbers.set(material, numbers.size + 1);
    return numbers.get(material)!;
  };
}

const sumOf = (numbers: readonly number[]) => numbers.reduce((sum, number) => sum + number, 0);

/// Returns the table at the begin of a view, which it and its streams must fill.
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

/// Reads the complete levels. `begin`: offset of the bytes in the file; `levelsBegin`: offset of the first level in the
/// bytes.
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
