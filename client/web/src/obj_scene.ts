// OBJ files with their material libraries, images and smoothing groups, as scenes.

import type { FileAttribute, TriangleFile } from 'papilio/files';

import { glbOf, padded } from './glb';
import type { Bytes, Encoded } from './model';
import { type LibraryMaterial, readMtl, undefinedMaterial } from './mtl';

const lastOf = (path: string) => path.replaceAll('\\', '/').split('/').at(-1)!.trim().toLowerCase();

/// Returns a file as a scene of this name, if one of its libraries is among `files`, which were dropped or picked with
/// it, or if it has smoothing groups; null otherwise.
export async function sceneOf(name: string, read: TriangleFile, files: readonly File[]): Promise<Encoded | null> {
  // A line may name several libraries, and names may have blanks.
  const names = read.libraries.flatMap((line) => line.split(/(?<=\.mtl)\s+/i));
  const fileNamed = (path: string) => files.find(({ name }) => lastOf(name) === lastOf(path));
  const libraries = names.map(fileNamed).filter((file) => file !== undefined);
  if (libraries.length === 0 && !read.attributes.some(({ kind }) => kind === 'smoothing-groups')) return null;
  const defined = new Map<string, LibraryMaterial>();
  for (const library of libraries)
    for (const one of readMtl(await library.text())) if (!defined.has(one.name)) defined.set(one.name, one);
  const writer = new SceneWriter(name, read);
  for (const [material, surface] of surfacesOf(read))
    await writer.add(surface, defined.get(material) ?? undefinedMaterial(material), fileNamed);
  return { kind: 'scene', bytes: writer.bytes(), ...(libraries.length === 0 && { libraries: names }) };
}

/// Triangles of one material, and their points.
class Surface {
  readonly points: number[] = [];
  readonly triangles: number[] = [];
  readonly #numbers = new Map<number, number>();

  add(corner: number): void {
    let number = this.#numbers.get(corner);
    if (number === undefined) {
      this.#numbers.set(corner, (number = this.points.length));
      this.points.push(corner);
    }
    this.triangles.push(number);
  }

  /// Returns the first components of the values of its points.
  valuesOf(values: Float32Array, components: number, taken = components): Float32Array<ArrayBuffer> {
    const own = new Float32Array(this.points.length * taken);
    for (const [i, point] of this.points.entries())
      own.set(values.subarray(point * components, point * components + taken), i * taken);
    return own;
  }
}

/// Returns the triangles by the name of their material, in the order of the materials; '' without one.
function surfacesOf({ triangles, materials, materialOfFace }: TriangleFile): Map<string, Surface> {
  const surfaces = new Map<string, Surface>(materials.map((name) => [name, new Surface()]));
  for (let i = 0; i < triangles.length; ++i) {
    const name = materials[materialOfFace?.[Math.floor(i / 3)] ?? materials.length] ?? '';
    let surface = surfaces.get(name);
    if (surface === undefined) surfaces.set(name, (surface = new Surface()));
    surface.add(triangles[i]);
  }
  return surfaces;
}

type Json = Record<string, unknown>;

const semantics: Record<FileAttribute['kind'], string> = {
  normals: 'NORMAL',
  colours: 'COLOR_0',
  texcoords: 'TEXCOORD_0',
  'smoothing-groups': '_SMOOTHING_GROUP',
};

/// Writer of a .glb file with one mesh, which has a primitive for each material.
class SceneWriter {
  readonly #name: string;
  readonly #read: TriangleFile;
  readonly #chunks: Bytes[] = [];
  readonly #views: Json[] = [];
  readonly #accessors: Json[] = [];
  readonly #primitives: Json[] = [];
  readonly #materials: Json[] = [];
  readonly #images: Json[] = [];
  /// Numbers of images by the name of their file.
  readonly #imageNumbers = new Map<string, number>();
  #length = 0;

  constructor(name: string, read: TriangleFile) {
    this.#name = name;
    this.#read = read;
  }

  async add(surface: Surface, material: LibraryMaterial, fileNamed: (path: string) => File | undefined): Promise<void> {
    const positions = surface.valuesOf(this.#read.positions, 3);
    const attributes: Json = { POSITION: this.#accessor(positions, 3, bounds(positions)) };
    for (const attribute of this.#read.attributes) this.#addAttribute(attributes, surface, attribute);
    this.#primitives.push({
      attributes,
      indices: this.#accessor(new Uint32Array(surface.triangles), 1),
      material: this.#materials.length,
    });
    const textures: Record<string, { index: number }> = {};
    if (attributes.TEXCOORD_0 !== undefined)
      for (const [use, path] of Object.entries(material.images) as [string, string | undefined][])
        if (path !== undefined) textures[use] = { index: await this.#image(path, fileNamed(path)) };
    const { baseColorTexture, metallicRoughnessTexture, ...others } = textures;
    const { name, baseColorFactor, metallicFactor, roughnessFactor, emissive, isBlended } = material;
    const strength = Math.max(1, ...emissive); // factors are at most 1
    this.#materials.push({
      name,
      pbrMetallicRoughness: {
        baseColorFactor,
        metallicFactor,
        roughnessFactor,
        baseColorTexture,
        metallicRoughnessTexture,
      },
      ...others,
      emissiveFactor: emissive.map((x) => x / strength),
      ...(isBlended && { alphaMode: 'BLEND' }),
      ...(strength > 1 && { extensions: { KHR_materials_emissive_strength: { emissiveStrength: strength } } }),
    });
  }

  bytes(): Bytes {
    const hasStrength = this.#materials.some(({ extensions }) => extensions !== undefined);
    const hasImages = this.#images.length > 0;
    const document = {
      asset: { version: '2.0' },
      scene: 0,
      scenes: [{ nodes: [0] }],
      nodes: [{ mesh: 0, name: this.#name }],
      meshes: [{ primitives: this.#primitives }],
      materials: this.#materials,
      ...(hasImages && { images: this.#images, textures: this.#images.map((_, source) => ({ source })) }),
      ...(hasStrength && { extensionsUsed: ['KHR_materials_emissive_strength'] }),
      accessors: this.#accessors,
      bufferViews: this.#views,
      buffers: [{ byteLength: this.#length }],
    };
    return glbOf(new TextEncoder().encode(JSON.stringify(document)), this.#chunks, this.#length);
  }

  #addAttribute(to: Json, surface: Surface, { kind, components, values }: FileAttribute): void {
    const taken = kind === 'texcoords' ? 2 : components;
    const own = surface.valuesOf(values, components, taken);
    // OBJ has the lower left corner of images at 0, 0, and glTF the upper left.
    if (kind === 'texcoords') for (let i = 1; i < own.length; i += 2) own[i] = 1 - own[i];
    to[semantics[kind]] = this.#accessor(own, taken);
  }

  /// Returns the number of an image; one that is not there stays a reference, which the page reports.
  async #image(path: string, file: File | undefined): Promise<number> {
    const key = lastOf(path);
    let number = this.#imageNumbers.get(key);
    if (number !== undefined) return number;
    const bytes = file ? new Uint8Array(await file.arrayBuffer()) : null;
    const mimeType = bytes && mediaTypeOf(bytes);
    number = this.#images.length;
    this.#imageNumbers.set(key, number);
    this.#images.push(mimeType ? { bufferView: this.#view(bytes), mimeType } : { uri: encodeURI(path) });
    return number;
  }

  #accessor(values: Float32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>, components: number, more: Json = {}): number {
    const type = components === 1 ? 'SCALAR' : `VEC${components}`;
    const componentType = values instanceof Float32Array ? 5126 : 5125;
    const bufferView = this.#view(new Uint8Array(values.buffer));
    return this.#accessors.push({ bufferView, componentType, type, count: values.length / components, ...more }) - 1;
  }

  #view(bytes: Bytes): number {
    const view = { buffer: 0, byteOffset: this.#length, byteLength: bytes.length };
    this.#chunks.push(bytes);
    this.#length += padded(bytes.length);
    return this.#views.push(view) - 1;
  }
}

function bounds(positions: Float32Array): Json {
  const min = [Infinity, Infinity, Infinity];
  const max = [-Infinity, -Infinity, -Infinity];
  for (const [i, x] of positions.entries()) {
    min[i % 3] = Math.min(min[i % 3], x);
    max[i % 3] = Math.max(max[i % 3], x);
  }
  return { min, max };
}

/// Returns the media type of an image that glTF may have; null for others.
function mediaTypeOf(bytes: Uint8Array): string | null {
  if (bytes[0] === 0x89 && bytes[1] === 0x50) return 'image/png';
  return bytes[0] === 0xff && bytes[1] === 0xd8 ? 'image/jpeg' : null;
}
