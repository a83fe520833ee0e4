// The parts of a packed model (proto/detail.md): the Draco stream of its base, its curves, and the residuals of each level.

import { Problem } from '../client.js';
import { isGlb, type Json, readContainer, writeContainer } from './container.js';
import {
  arrayOf,
  distance,
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

/// Distances to the original, the larger of both directions, as shares of the diagonal of its bounding box.
export interface Reach {
  /// Root mean square.
  rms: number;
  largest: number;
}

export interface PackedLevel extends Reach {
  /// Of the residuals.
  step: number;
  residuals: Uint8Array<ArrayBuffer>;
  /// Residuals of the level: edges that it splits.
  residualCount: number;
  /// Of the model with the levels up to this one.
  faces: number;
  /// Where its residuals end in the file, which is what a reader of the levels up to this one needs.
  end: number;
}

export interface PackedFile {
  base: Reach & { draco: Uint8Array<ArrayBuffer>; vertices: number; faces: number; end: number };
  /// Empty: the base has no creases and no corners.
  curves: Uint8Array<ArrayBuffer>;
  /// Whole ones, coarse first.
  levels: PackedLevel[];
  /// Levels that the file declares: more than `levels` where it is cut.
  declaredLevels: number;
}

export interface ReadOptions {
  /// Most faces of the last level that the file declares.
  maxFaces?: number;
  /// Whether the file may end inside the bytes of a level, as a prefix does. Its whole levels are read.
  mayBeCut?: boolean;
}

/// Of the last level that `papilio pack` makes at most.
export const defaultMaxFaces = 8_000_000;

const dracoExtension = 'KHR_draco_mesh_compression';
const detailExtension = 'PAPILIO_detail';
const primitivePlace = 'meshes[0].primitives[0]';
const detailPlace = `${primitivePlace}.extensions.${detailExtension}`;
const version = 1;
const mostLevels = 10;
const mostCoordinate = 1e18;

/// Whether the bytes are a .glb file with PAPILIO_detail on a primitive, and without texture coordinates there: their
/// residuals are not decoded here, so that such a model is a scene, which shows its textured base. Reads the JSON alone.
export function isPacked(bytes: Uint8Array<ArrayBuffer>): boolean {
  if (!isGlb(bytes)) return false;
  try {
    const json = objectOf(readContainer(bytes, true).json, 'the JSON');
    return arrayOf(json, 'meshes').some((mesh) =>
      arrayOf(objectOf(mesh, 'a mesh'), 'primitives').some((primitive) => {
        const of = objectOf(primitive, 'a primitive');
        if (extensionOf(of, detailExtension, 'a primitive') === null) return false;
        return objectOf(of.attributes ?? {}, 'attributes').TEXCOORD_0 === undefined;
      }),
    );
  } catch {
    return false;
  }
}

/// Throws Problem: mesh_not_gltf (damaged, truncated, a member out of range), mesh_unsupported (no packed model, another
/// version, a scene that the format does not allow), result_too_large (more than `maxFaces`).
export function readPacked(bytes: Uint8Array<ArrayBuffer>, options: ReadOptions = {}): PackedFile {
  return new Reader(bytes, options).read();
}

/// The file of a packed model with its first `count` levels alone. Throws as readPacked.
export function withLevels(bytes: Uint8Array<ArrayBuffer>, count: number): Uint8Array<ArrayBuffer> {
  const { base, curves, levels } = readPacked(bytes, { maxFaces: Infinity });
  const document = objectOf(readContainer(bytes, false).json, 'the JSON');
  const streams: Uint8Array[] = [];
  const views: JsonObject[] = [];
  let length = 0;
  const put = (of: JsonObject, key: string, stream: Uint8Array) => {
    delete of[key];
    if (stream.length === 0) return;
    of[key] = views.push({ buffer: 0, byteOffset: length, byteLength: stream.length }) - 1;
    streams.push(stream);
    length += stream.length;
  };
  const primitive = primitiveOf(document);
  const detail = detailOf(primitive)!;
  put(extensionOf(primitive, dracoExtension, primitivePlace)!, 'bufferView', base.draco);
  put(detail, 'curves', curves);
  const kept = (detail.levels as JsonObject[]).slice(0, count);
  for (const [l, level] of kept.entries()) put(level, 'bufferView', levels[l]!.residuals);
  Object.assign(detail, { levels: kept });
  Object.assign(document, { bufferViews: views, buffers: [{ byteLength: length }] });
  const binary = new Uint8Array(length);
  for (const [i, stream] of streams.entries()) binary.set(stream, whole(views[i]!, 'byteOffset', ''));
  return writeContainer(document, binary);
}

function primitiveOf(json: JsonObject): JsonObject {
  return only(only(json, 'meshes', 'mesh'), 'primitives', 'primitive');
}
function detailOf(primitive: JsonObject): JsonObject | null {
  return extensionOf(primitive, detailExtension, primitivePlace);
}

class Reader {
  readonly #json: JsonObject;
  readonly #binary: Uint8Array<ArrayBuffer>;
  /// Of the binary chunk in the file.
  readonly #offset: number;
  readonly #options: ReadOptions;
  /// Of the last view, in the binary chunk.
  #end = 0;
  #before = 'the binary chunk';

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
    const { levels } = detail;
    if (!Array.isArray(levels)) refuse(detailPlace, 'has no array of levels');
    if (levels.length > mostLevels)
      refuse(detailPlace, `has ${levels.length} levels; at most ${mostLevels} are allowed`);
    const corners = this.#count(index(primitive, 'indices', primitivePlace));
    if (corners % 3 !== 0) refuse(primitivePlace, 'has indices of other than whole triangles');
    const faces = corners / 3;
    const most = this.#options.maxFaces ?? defaultMaxFaces;
    if (faces * 4 ** levels.length > most)
      throw new Problem(
        'result_too_large',
        `The base of ${faces} faces has ${faces * 4 ** levels.length} at level ${levels.length}; the limit is ${most}.`,
      );
    const base = { ...reachOf(detail, detailPlace), ...this.#base(primitive), faces, end: 0 };
    base.end = this.#offset + this.#end;
    const curves = this.#curves(detail);
    if (curves.length > 0) base.end = this.#offset + this.#end;
    return { base, curves, levels: this.#levels(levels, faces), declaredLevels: levels.length };
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

  #base(primitive: JsonObject): { draco: Uint8Array<ArrayBuffer>; vertices: number } {
    const draco = extensionOf(primitive, dracoExtension, primitivePlace);
    if (draco === null || primitive.attributes === undefined)
      refuse(primitivePlace, `has no base compressed by ${dracoExtension}`);
    const attributes = objectOf(primitive.attributes, `${primitivePlace}.attributes`);
    if (Object.keys(attributes).join() !== 'POSITION') refuseScene('other attributes than POSITION');
    const vertices = this.#count(index(attributes, 'POSITION', primitivePlace));
    const view = index(draco, 'bufferView', primitivePlace);
    if (view === null) refuse(primitivePlace, `has no view of its ${dracoExtension}`);
    return { draco: this.#bytes(view) ?? cut('its base'), vertices };
  }

  #curves(detail: JsonObject): Uint8Array<ArrayBuffer> {
    const view = index(detail, 'curves', detailPlace);
    if (view === null) return new Uint8Array();
    return this.#bytes(view) ?? cut('the curves of its base');
  }

  /// The whole ones.
  #levels(levels: Json[], baseFaces: number): PackedLevel[] {
    const wholeOnes: PackedLevel[] = [];
    let faces = baseFaces;
    for (const [l, json] of levels.entries()) {
      const where = `${detailPlace}.levels[${l}]`;
      const level = objectOf(json, where);
      const step = Math.fround(distance(level, 'step', where));
      if (!(step > 0 && step <= mostCoordinate)) refuse(`${where}.step`, 'must be above 0, and at most 1e18');
      faces *= 4;
      const [reach, residualCount] = [reachOf(level, where), whole(level, 'vertices', where)];
      const view = index(level, 'bufferView', where);
      const residuals = view === null ? new Uint8Array() : this.#bytes(view);
      if (residuals !== null && l === wholeOnes.length)
        wholeOnes.push({ ...reach, step, residuals, residualCount, faces, end: this.#offset + this.#end });
    }
    return wholeOnes;
  }

  /// Of a view, which begins at or after the end of the view before. Null where the file is cut before its end.
  #bytes(number: number): Uint8Array<ArrayBuffer> | null {
    const name = `bufferViews[${number}]`;
    const view = element(this.#json, 'bufferViews', number);
    for (const key of ['byteStride', 'extensions'])
      if (view[key] !== undefined) refuse(name, `holds a stream and has ${key}`);
    if (index(view, 'buffer', name) !== 0) refuse(name, 'is not in the binary chunk');
    const [offset, length] = [whole(view, 'byteOffset', name, 0), whole(view, 'byteLength', name)];
    const size = whole(objectOf(arrayOf(this.#json, 'buffers')[0], 'buffers[0]'), 'byteLength', 'buffers[0]');
    if (offset + length > size)
      refuse(name, `has the bytes ${offset} to ${offset + length} of buffers[0], which has ${size}`);
    if (offset < this.#end)
      refuse(name, `begins at byte ${offset}, before the end of ${this.#before} at byte ${this.#end}`);
    this.#end = offset + length;
    this.#before = name;
    return this.#end > this.#binary.length ? null : this.#binary.subarray(offset, this.#end);
  }
}

function reachOf(of: JsonObject, where: string): Reach {
  return { rms: distance(of, 'rms', where), largest: distance(of, 'largest', where) };
}

function cut(where: string): never {
  throw new Problem('mesh_not_gltf', `The file is cut inside ${where}, so no level can be read. Provide more of it.`);
}
