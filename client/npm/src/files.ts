// papilio/files: readers of triangle files, those of the command line as a WebAssembly module, papilio-files.wasm. Its
// structures are defined in client/wasm/files_module.cpp.

import { Problem } from './client.js';

/// In the order of the module.
const formats = ['obj', 'ply', 'off', 'stl'] as const;
export type TriangleFormat = (typeof formats)[number];

/// In the order of the module: generic attributes are smoothing groups.
const kinds = ['normals', 'colours', 'texcoords', 'smoothing-groups'] as const;

export interface FileAttribute {
  kind: (typeof kinds)[number];
  components: number;
  /// [points * components] values; colours are from 0 to 1, texture coordinates upwards as in OBJ, and faces of
  /// different smoothing groups meet at creases.
  values: Float32Array<ArrayBuffer>;
}

/// Triangles of a file, counter-clockwise seen from outside. Points of equal position are one vertex.
export interface TriangleFile {
  /// [points * 3] positions, which may be NaN or infinite.
  positions: Float32Array<ArrayBuffer>;
  /// [faces * 3]
  triangles: Uint32Array<ArrayBuffer>;
  attributes: FileAttribute[];
  /// Texts after each different `mtllib` of an OBJ file: one or several file names.
  libraries: string[];
  /// Names of the materials that faces of an OBJ file use.
  materials: string[];
  /// [faces] indices in `materials`, 2^32 - 1 without one; null if no face has one.
  materialOfFace: Uint32Array<ArrayBuffer> | null;
}

export interface ReadOptions {
  /// papilio-files.wasm: its bytes, a response of `fetch`, or a compiled module. Default: the file beside this one.
  wasm?: BufferSource | Response | Promise<Response> | WebAssembly.Module;
}

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  allocate(bytes: number): number;
  file_read(format: number, bytes: number, length: number): number;
}

let shared: Promise<WebAssembly.Module> | null = null;

/// Returns the module beside this file, fetched with the first file.
function sharedModule(): Promise<WebAssembly.Module> {
  shared ??= WebAssembly.compileStreaming(fetch(new URL('papilio-files.wasm', import.meta.url)));
  shared.catch(() => (shared = null)); // the next file retries
  return shared;
}

async function moduleOf(wasm: ReadOptions['wasm']): Promise<WebAssembly.Module> {
  if (wasm === undefined) return sharedModule();
  const from = await wasm;
  if (from instanceof WebAssembly.Module) return from;
  return from instanceof Response ? WebAssembly.compileStreaming(from) : WebAssembly.compile(from);
}

/// Reads a file, as the command line does. Rejects with Problem: `mesh_unusable`, with the line at fault, if it is
/// damaged or holds no triangles, `out_of_memory`; and with an Error if the module cannot be fetched.
export async function readTriangleFile(
  format: TriangleFormat,
  bytes: Uint8Array,
  options: ReadOptions = {},
): Promise<TriangleFile> {
  const module = await moduleOf(options.wasm);
  try {
    return new Reading(module).read(format, bytes);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError)
      throw new Problem('internal', `The reader of files failed: ${error.message}.`);
    throw error;
  }
}

/// Numbers of a known count.
type Tuple<Count extends number, Known extends number[] = []> = Known['length'] extends Count
  ? Known
  : Tuple<Count, [...Known, number]>;

/// Instance of the module that reads one file: its memory is freed with it.
class Reading {
  readonly #exports: Exports;

  constructor(module: WebAssembly.Module) {
    const instance = new WebAssembly.Instance(module, {
      papilio: {
        fault: (fault: number, message: number) => {
          const [text] = this.#texts(message, 1);
          throw new Problem(['', '', 'mesh_unusable', '', '', 'out_of_memory'][fault] || 'internal', text!);
        },
      },
    });
    this.#exports = instance.exports as unknown as Exports;
    this.#exports._initialize();
  }

  read(format: TriangleFormat, bytes: Uint8Array): TriangleFile {
    const at = this.#exports.allocate(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, at, bytes.length).set(bytes);
    const file = this.#exports.file_read(formats.indexOf(format), at, bytes.length);
    const words = Array.from(this.#words(file, 11)) as Tuple<11>;
    const [points, faces, positions, triangles, count, attributes, ...names] = words;
    const [libraryCount, libraries, materialCount, materials, materialOfFace] = names;
    return {
      positions: this.#floats(positions, 3 * points),
      triangles: this.#words(triangles, 3 * faces),
      attributes: Array.from({ length: count }, (_, a) => {
        const [kind, components, values] = Array.from(this.#words(attributes + 12 * a, 3)) as Tuple<3>;
        return { kind: kinds[kind]!, components, values: this.#floats(values, points * components) };
      }),
      libraries: this.#texts(libraries, libraryCount),
      materials: this.#texts(materials, materialCount),
      materialOfFace: materialOfFace === 0 ? null : this.#words(materialOfFace, faces),
    };
  }

  #words(at: number, count: number): Uint32Array<ArrayBuffer> {
    return new Uint32Array(this.#exports.memory.buffer, at, count).slice() as Uint32Array<ArrayBuffer>;
  }
  #floats(at: number, count: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.#exports.memory.buffer, at, count).slice() as Float32Array<ArrayBuffer>;
  }

  /// Returns texts that follow each other, each ended by 0.
  #texts(at: number, count: number): string[] {
    const bytes = new Uint8Array(this.#exports.memory.buffer);
    return Array.from({ length: count }, () => {
      const end = bytes.indexOf(0, at);
      const text = new TextDecoder().decode(bytes.slice(at, end));
      at = end + 1;
      return text;
    });
  }
}
