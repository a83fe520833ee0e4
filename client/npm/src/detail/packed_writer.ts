// Writer of files from a packed model: with fewer levels, or with other surfaces in place of all levels.

import { type Json, readContainer, writeContainer } from './container.js';
import { arrayOf, extensionOf, index, type JsonObject, objectOf, whole } from './document.js';
import { writeTable } from './level_table.js';
import { detailExtension, detailOf, dracoExtension, placeOf, primitivesOf, readPacked } from './packed_file.js';

/// Surface as Draco, with the unique ids of its glTF attributes.
export interface DracoSurface {
  draco: Uint8Array;
  points: number;
  faces: number;
  /// Unique ids by glTF's names, including POSITION.
  attributes: Readonly<Record<string, number>>;
  /// Bounds of the positions.
  min: readonly number[];
  max: readonly number[];
}

/// Returns the file of a packed model with only its first `count` levels. Throws as readPacked().
export function withLevels(bytes: Uint8Array<ArrayBuffer>, count: number): Uint8Array<ArrayBuffer> {
  const { base, curves, levels, hasTexcoordLevels } = readPacked(bytes, { maxFaces: Infinity });
  const kept = levels.slice(0, count);
  const table = writeTable({
    ...base,
    curveBytes: curves.length,
    hasTexcoords: hasTexcoordLevels,
    rows: kept.map((level) => ({ ...level, bytes: level.residuals.length - level.texcoordBytes })),
  });
  const detail = joined([table, curves, ...kept.map(({ residuals }) => residuals)]);
  const { json, binary } = openDocument(bytes);
  const view = index(detailOf(primitivesOf(json))!, 'bufferView', placeOf(0))!;
  return withViews(json, binary, new Map([[view, detail]]));
}

/// Returns the scene of a packed model with its materials and images, and with other surfaces, one for each of its
/// primitives. It is no packed model. Throws as readPacked().
export function withSurfaces(
  bytes: Uint8Array<ArrayBuffer>,
  surfaces: readonly DracoSurface[],
): Uint8Array<ArrayBuffer> {
  readPacked(bytes, { maxFaces: Infinity });
  const { json, binary } = openDocument(bytes);
  const primitives = primitivesOf(json);
  if (surfaces.length !== primitives.length)
    throw new RangeError(`The model has ${primitives.length} primitives, not ${surfaces.length}.`);
  const views = new Map<number, Uint8Array | null>([[index(detailOf(primitives)!, 'bufferView', placeOf(0))!, null]]);
  delete objectOf(primitives[0]!.extensions, placeOf(0))[detailExtension];
  json.extensionsUsed = arrayOf(json, 'extensionsUsed').filter((name) => name !== detailExtension);
  const accessors: Json[] = [];
  for (const [p, { draco, points, faces, min, max, attributes }] of surfaces.entries()) {
    const primitive = primitives[p]!;
    const extension = extensionOf(primitive, dracoExtension, placeOf(p))!;
    views.set(index(extension, 'bufferView', placeOf(p))!, draco);
    extension.attributes = { ...attributes };
    const add = (accessor: JsonObject) => accessors.push(accessor) - 1;
    primitive.indices = add({ componentType: 5125, count: 3 * faces, type: 'SCALAR' });
    const box = { min: [...min], max: [...max] };
    primitive.attributes = Object.fromEntries(
      Object.keys(attributes).map((name) => {
        return [name, add({ ...formatOf(name), count: points, ...(name === 'POSITION' && box) })];
      }),
    );
  }
  json.accessors = accessors;
  return withViews(json, binary, views);
}

/// Returns the format of an attribute, by glTF's name.
function formatOf(name: string): JsonObject {
  if (name.startsWith('COLOR')) return { componentType: 5121, normalized: true, type: 'VEC3' };
  return { componentType: 5126, type: name.startsWith('TEXCOORD') ? 'VEC2' : 'VEC3' };
}

function openDocument(bytes: Uint8Array<ArrayBuffer>): { json: JsonObject; binary: Uint8Array } {
  const { json, binary } = readContainer(bytes, false);
  return { json: objectOf(json, 'the JSON'), binary };
}

/// Returns the file of a document in which some views have other bytes, or are dropped (null). Other views keep their
/// order.
function withViews(
  json: JsonObject,
  binary: Uint8Array,
  changed: ReadonlyMap<number, Uint8Array | null>,
): Uint8Array<ArrayBuffer> {
  const views = arrayOf(json, 'bufferViews').map((view, v) => {
    const of = objectOf(view, `bufferViews[${v}]`);
    const begin = whole(of, 'byteOffset', `bufferViews[${v}]`, 0);
    const own = binary.subarray(begin, begin + whole(of, 'byteLength', `bufferViews[${v}]`));
    return { of, v, begin, bytes: changed.has(v) ? changed.get(v)! : own };
  });
  const kept = views.filter(({ bytes }) => bytes !== null).sort((one, other) => one.begin - other.begin);
  const numbers = new Map(kept.map(({ v }, i) => [v, i]));
  let end = 0;
  json.bufferViews = kept.map(({ of, bytes }) => {
    const view = { ...of, byteOffset: end, byteLength: bytes!.length };
    end += bytes!.length;
    return view;
  });
  json.buffers = [{ byteLength: end }];
  renumberViews(json, numbers);
  return writeContainer(json, joined(kept.map(({ bytes }) => bytes!)));
}

/// Renumbers views in all members that refer to one.
function renumberViews(json: Json | undefined, numbers: ReadonlyMap<number, number>): void {
  if (json === null || typeof json !== 'object') return;
  if (!Array.isArray(json) && typeof json.bufferView === 'number')
    json.bufferView = numbers.get(json.bufferView) ?? json.bufferView;
  for (const member of Object.values(json)) renumberViews(member, numbers);
}

function joined(parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
