// OBJ files with their material libraries and images, as scenes.

import type { BufferGeometry, Material, Mesh, Object3D } from 'three';

import { glbOf, padded } from './glb';
import type { Bytes, Encoded } from './model';
import { type LibraryMaterial, readMtl, undefinedMaterial } from './mtl';
import { Problem } from './service';

const lastOf = (path: string) => path.replaceAll('\\', '/').split('/').at(-1)!.trim().toLowerCase();

/// Returns the names of the libraries that an OBJ file refers to; a line may have several, and names may have blanks.
function librariesOf(text: string): string[] {
  return [...text.matchAll(/^[ \t]*mtllib[ \t]+(.+?)[ \t\r]*$/gm)].flatMap(([, line]) => line.split(/(?<=\.mtl)\s+/i));
}

/// Reads an OBJ file as a scene, if one of its libraries is among `files`, which were dropped or picked with it. Returns
/// the names of its libraries otherwise. Rejects with a Problem.
export async function readObjScene(obj: File, files: readonly File[]): Promise<Encoded | string[]> {
  const text = await obj.text();
  const names = librariesOf(text);
  const fileNamed = (path: string) => files.find(({ name }) => lastOf(name) === lastOf(path));
  const libraries = names.map(fileNamed).filter((file) => file !== undefined);
  if (libraries.length === 0) return names;
  const defined = new Map<string, LibraryMaterial>();
  for (const library of libraries)
    for (const one of readMtl(await library.text())) if (!defined.has(one.name)) defined.set(one.name, one);
  const { OBJLoader } = await import('three/examples/jsm/loaders/OBJLoader.js');
  let parsed: Object3D;
  try {
    parsed = new OBJLoader().parse(text);
  } catch (error) {
    throw new Problem(
      'damaged',
      `${obj.name} cannot be read: ${error instanceof Error ? error.message : String(error)}`,
    );
  }
  const surfaces = surfacesOf(parsed, /^[ \t]*vn\s/m.test(text));
  if (surfaces.size === 0) throw new Problem('empty', `There are no triangles in ${obj.name}.`);
  const writer = new SceneWriter();
  for (const [name, surface] of surfaces) {
    if (!surface.positions.every(Number.isFinite))
      throw new Problem('mesh_unusable', `${obj.name} has positions that are no numbers.`);
    await writer.add(surface, defined.get(name) ?? undefinedMaterial(name), fileNamed);
  }
  return { kind: 'scene', bytes: writer.bytes() };
}

/// Triangles of one material.
class Surface {
  readonly positions: number[] = [];
  readonly texcoords: number[] = [];
  readonly normals: number[] = [];
  readonly triangles: number[] = [];
  /// Vertices by their values: OBJLoader repeats them in each triangle.
  readonly #vertices = new Map<string, number>();

  add(geometry: BufferGeometry, from: number, hasTexcoords: boolean, hasNormals: boolean): void {
    const position = geometry.getAttribute('position');
    const texcoord = geometry.hasAttribute('uv') ? geometry.getAttribute('uv') : null;
    const normal = geometry.getAttribute('normal');
    const corners: number[] = [];
    const places: string[] = [];
    for (let i = from; i < from + 3; ++i) {
      const point = [position.getX(i), position.getY(i), position.getZ(i)];
      // OBJ has the lower left corner of images at 0, 0, and glTF the upper left.
      const uv = !hasTexcoords ? [] : texcoord ? [texcoord.getX(i), 1 - texcoord.getY(i)] : [0, 0];
      const direction = hasNormals ? [normal.getX(i), normal.getY(i), normal.getZ(i)] : [];
      const key = [point, uv, direction].join(';');
      let vertex = this.#vertices.get(key);
      if (vertex === undefined) {
        vertex = this.#vertices.size;
        this.#vertices.set(key, vertex);
        this.positions.push(...point);
        this.texcoords.push(...uv);
        this.normals.push(...direction);
      }
      corners.push(vertex);
      places.push(point.join());
    }
    if (new Set(places).size === 3) this.triangles.push(...corners);
  }
}

/// Returns the triangles by the name of their material. `hasNormals`: whether the file has normals; three makes flat
/// ones otherwise.
function surfacesOf(parsed: Object3D, hasNormals: boolean): Map<string, Surface> {
  const meshes: Mesh[] = [];
  parsed.traverse((object) => (object as Partial<Mesh>).isMesh === true && meshes.push(object as Mesh));
  const hasTexcoords = meshes.some(({ geometry }) => geometry.hasAttribute('uv'));
  const surfaces = new Map<string, Surface>();
  for (const { geometry, material } of meshes) {
    const materials = ([] as Material[]).concat(material);
    const whole = { start: 0, count: geometry.getAttribute('position').count, materialIndex: 0 };
    for (const { start, count, materialIndex } of geometry.groups.length > 0 ? geometry.groups : [whole]) {
      const name = materials[materialIndex ?? 0].name;
      let surface = surfaces.get(name);
      if (surface === undefined) surfaces.set(name, (surface = new Surface()));
      for (let i = start; i + 2 < start + count; i += 3) surface.add(geometry, i, hasTexcoords, hasNormals);
    }
  }
  for (const [name, { triangles }] of surfaces) if (triangles.length === 0) surfaces.delete(name);
  return surfaces;
}

type Json = Record<string, unknown>;

/// Writer of a .glb file with one mesh, which has a primitive for each material.
class SceneWriter {
  readonly #chunks: Bytes[] = [];
  readonly #views: Json[] = [];
  readonly #accessors: Json[] = [];
  readonly #primitives: Json[] = [];
  readonly #materials: Json[] = [];
  readonly #images: Json[] = [];
  /// Numbers of images by the name of their file.
  readonly #imageNumbers = new Map<string, number>();
  #length = 0;

  async add(surface: Surface, material: LibraryMaterial, fileNamed: (path: string) => File | undefined): Promise<void> {
    const { positions, texcoords, normals, triangles } = surface;
    const attributes: Json = { POSITION: this.#accessor(new Float32Array(positions), 3, bounds(positions)) };
    if (texcoords.length > 0) attributes.TEXCOORD_0 = this.#accessor(new Float32Array(texcoords), 2);
    if (normals.length > 0) attributes.NORMAL = this.#accessor(new Float32Array(normals), 3);
    this.#primitives.push({
      attributes,
      indices: this.#accessor(new Uint32Array(triangles), 1),
      material: this.#materials.length,
    });
    const textures: Record<string, { index: number }> = {};
    if (texcoords.length > 0)
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
      nodes: [{ mesh: 0 }],
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

function bounds(positions: readonly number[]): Json {
  const min = [Infinity, Infinity, Infinity];
  const max = [-Infinity, -Infinity, -Infinity];
  for (const [i, number] of positions.entries()) {
    const x = Math.fround(number);
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
