// Files made of a packed model: with fewer levels, or with another surface in place of all of them.

import { type Json, readContainer, writeContainer } from './container.js';
import { arrayOf, extensionOf, index, type JsonObject, objectOf, whole } from './document.js';
import { writeTable } from './level_table.js';
import { detailExtension, detailOf, dracoExtension, primitiveOf, primitivePlace, readPacked } from './packed_file.js';

/// A surface as Draco, whose unique ids are those of glTF's attributes here.
export interface DracoSurface {
  draco: Uint8Array;
  points: number;
  faces: number;
  /// By glTF's names, POSITION among them.
  attributes: Readonly<Record<string, number>>;
  /// Of the positions.
  min: readonly number[];
  max: readonly number[];
}

/// The file of a packed model with its first `count` levels alone. Throws as readPacked.
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
  const view = index(detailOf(primitiveOf(json))!, 'bufferView', primitivePlace)!;
  return withViews(json, binary, new Map([[view, detail]]));
}

/// The scene of a packed model, with its material and images, of this surface: no packed model. Throws as readPacked.
export function withSurface(bytes: Uint8Array<ArrayBuffer>, surface: DracoSurface): Uint8Array<ArrayBuffer> {
  readPacked(bytes, { maxFaces: Infinity });
  const { json, binary } = openDocument(bytes);
  const primitive = primitiveOf(json);
  const [draco, detail] = [extensionOf(primitive, dracoExtension, primitivePlace)!, detailOf(primitive)!];
  const views = new Map<number, Uint8Array | null>([
    [index(draco, 'bufferView', primitivePlace)!, surface.draco],
    [index(detail, 'bufferView', primitivePlace)!, null],
  ]);
  delete objectOf(primitive.extensions, primitivePlace)[detailExtension];
  json.extensionsUsed = arrayOf(json, 'extensionsUsed').filter((name) => name !== detailExtension);
  draco.attributes = { ...surface.attributes };
  const { points, faces, min, max } = surface;
  const accessors: Json[] = [{ componentType: 5125, count: 3 * faces, type: 'SCALAR' }];
  primitive.indices = 0;
  primitive.attributes = Object.fromEntries(
    Object.keys(surface.attributes).map((name) => {
      const type = name.startsWith('TEXCOORD') ? 'VEC2' : 'VEC3';
      const box = name === 'POSITION' ? { min: [...min], max: [...max] } : {};
      return [name, accessors.push({ componentType: 5126, count: points, type, ...box }) - 1];
    }),
  );
  json.accessors = accessors;
  return withViews(json, binary, views);
}

function openDocument(bytes: Uint8Array<ArrayBuffer>): { json: JsonObject; binary: Uint8Array } {
  const { json, binary } = readContainer(bytes, false);
  return { json: objectOf(json, 'the JSON'), binary };
}

/// The file of a document, some of whose views have other bytes, or are left out (null). The others come behind one
/// another as they did.
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

/// In all members that name a view.
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
