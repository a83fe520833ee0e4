// Decoder of packed models as a WebAssembly module, papilio-detail.wasm, on the calling thread. Its structures are
// defined in client/wasm/detail_module.cpp.

import { Problem } from '../client.js';

/// Residuals of a level.
export interface CodedLevel {
  step: number;
  /// Bytes of the present pieces in their order: the residuals of each, followed by those of its texture coordinates
  /// and colours.
  residuals: Uint8Array;
  /// Quantization step of the residuals of texture coordinates; for colours, 2048 times this value. Default 0: no
  /// residuals.
  texcoordStep?: number;
  /// Length of the residuals of texture coordinates and colours in `residuals`.
  texcoordBytes?: number;
  /// Pieces of the residuals; empty for one piece. Vertices of a missing piece, and of pieces that depend on it, are
  /// predicted only. A piece depends on the pieces of the level before at all vertices of its faces of the base, and on
  /// the first piece of its level.
  pieces: readonly { bytes: number; texcoordBytes?: number; isMissing?: boolean }[];
}

/// Indexed triangles, counter-clockwise seen from outside. Points of equal position are one vertex.
export interface DecodedTriangles {
  /// [points * 3]
  positions: Float32Array<ArrayBuffer>;
  /// [faces * 3]
  triangles: Uint32Array<ArrayBuffer>;
  /// [points * 2] texture coordinates, downwards as in glTF; absent if there are none.
  texcoords?: Float32Array<ArrayBuffer>;
  /// [points * 3] red, green and blue, as in glTF's COLOR_0; absent if there are none.
  colours?: Uint8Array<ArrayBuffer>;
  /// [points * 3] normals; absent if there are none.
  normals?: Float32Array<ArrayBuffer>;
}

/// Base as of joinPrimitives().
export interface BaseTriangles extends DecodedTriangles {
  /// [points] part numbers, if there are several parts: borders of parts are seams.
  parts?: Uint32Array<ArrayBuffer>;
}

/// Places where normals are split: nowhere, at creases, or at all edges, which needs no normals. `absent`: the original
/// has none.
export type NormalStyle = (typeof normalStyles)[number];
/// In the order of papilio/detail.h.
export const normalStyles = ['absent', 'smooth', 'creased', 'faceted'] as const;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  allocate(bytes: number): number;
  release(block: number): void;
  base_create(base: number): number;
  base_edges(base: number): number;
  base_free(base: number): void;
  decode(base: number, levels: number, rows: number, maxFaces: number, normals: number): number;
  decoded_free(decoded: number): void;
}

const levelBytes = 24;
const missingPiece = 2 ** 32 - 1;
// papilio.h
const codes = ['bad_parameter', 'mesh_unusable', 'result_too_large', 'cancelled', 'out_of_memory'];

/// Compiles papilio-detail.wasm, from its bytes or from a response of `fetch`.
export async function compileDecoder(source: BufferSource | Response | Promise<Response>): Promise<WebAssembly.Module> {
  const from = await source;
  return from instanceof Response ? WebAssembly.compileStreaming(from) : WebAssembly.compile(from);
}

/// Decoder of the levels of one base, whose arrays must not change.
export class DetailDecoder {
  readonly #module: WebAssembly.Module;
  readonly #base: BaseTriangles;
  readonly #curves: Uint8Array;
  readonly #mostBytes: number;
  #instance: WebAssembly.Instance | null = null;
  #exports!: Exports;
  /// Address in the memory of this instance.
  #pointer = 0;

  /// `base`: the decoded base. `mostBytes`: limit of memory; as it never shrinks, a larger instance is discarded after
  /// it has decoded.
  constructor(module: WebAssembly.Module, base: BaseTriangles, curves: Uint8Array, mostBytes = 64 * 2 ** 20) {
    this.#module = module;
    this.#base = base;
    this.#curves = curves;
    this.#mostBytes = mostBytes;
  }

  /// Returns the memory of its instance, in bytes.
  get bytes(): number {
    return this.#instance ? this.#exports.memory.buffer.byteLength : 0;
  }

  /// Returns the number of edges of the base. Throws Problem unless it is manifold.
  countEdges(): number {
    return this.#guarded(() => this.#exports.base_edges(this.#pointer));
  }

  /// Returns the surface with these levels, bit-identical to the native library's, with the attributes of the base.
  /// `normals`: style of normals to add, `smooth` or `creased`, which splits points at creases. Throws Problem.
  decode(levels: readonly CodedLevel[], maxFaces = 2 ** 30, normals: NormalStyle = 'absent'): DecodedTriangles {
    const made = this.#guarded(() => {
      const blocks: number[] = [];
      const write = (bytes: ArrayBufferView) => blocks[blocks.push(this.#write(bytes)) - 1]!;
      const rows = new DataView(new ArrayBuffer(levels.length * levelBytes));
      for (const [l, level] of levels.entries()) {
        const sizes = sizesOf(level);
        const { step, texcoordStep = 0, residuals } = level;
        for (const [i, number] of [step, texcoordStep].entries()) rows.setFloat32(l * levelBytes + 4 * i, number, true);
        for (const [i, number] of [residuals.length, write(residuals), sizes.length / 2, write(sizes)].entries())
          rows.setUint32(l * levelBytes + 8 + 4 * i, number, true);
      }
      const [limit, style] = [Math.min(maxFaces, 2 ** 30), normalStyles.indexOf(normals)];
      const decoded = this.#exports.decode(this.#pointer, levels.length, write(rows), limit, style);
      for (const block of blocks) this.#exports.release(block);
      const copy = this.#read(decoded);
      this.#exports.decoded_free(decoded);
      return copy;
    });
    if (this.bytes > this.#mostBytes) this.close();
    return made;
  }

  /// Discards the instance and its memory; the next call starts another.
  close(): void {
    this.#instance = null;
  }

  /// Runs work in the instance. After an error its state is undefined: the next call starts another.
  #guarded<T>(work: () => T): T {
    try {
      this.#start();
      return work();
    } catch (error) {
      this.#instance = null;
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError)
        throw new Problem('internal', `The decoder of packed models failed: ${error.message}.`);
      throw error;
    }
  }

  #start(): void {
    if (this.#instance) return;
    this.#instance = new WebAssembly.Instance(this.#module, {
      papilio: {
        fault: (fault: number, message: number) => {
          throw new Problem(codes[fault - 1] ?? 'internal', this.#text(message));
        },
      },
      // Seeds a hash table, whose order affects no result.
      wasi_snapshot_preview1: { random_get: () => 0 },
    });
    this.#exports = this.#instance.exports as unknown as Exports;
    this.#exports._initialize();
    const { positions, triangles, texcoords, colours, parts } = this.#base;
    const [points, faces] = [positions, triangles].map(({ length }) => Math.floor(length / 3)) as [number, number];
    const blocks = [positions, triangles, this.#curves, texcoords, colours, parts].map((array) =>
      array === undefined ? 0 : this.#write(array),
    ) as [number, number, number, number, number, number];
    const [at, corners, curves, ...values] = blocks;
    const words = new Uint32Array([points, at, faces, corners, this.#curves.length, curves, ...values]);
    const base = this.#write(words);
    this.#pointer = this.#exports.base_create(base);
    for (const block of [...blocks, base]) if (block !== 0) this.#exports.release(block);
  }

  /// Copies values into memory, and returns their address.
  #write(array: ArrayBufferView): number {
    const at = this.#exports.allocate(array.byteLength);
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    new Uint8Array(this.#exports.memory.buffer, at, array.byteLength).set(bytes);
    return at;
  }

  /// Copies the triangles out.
  #read(decoded: number): DecodedTriangles {
    const { buffer } = this.#exports.memory;
    const [points, faces, positions, triangles, texcoords, colours, normals] = new Uint32Array(
      buffer,
      decoded,
      7,
    ) as unknown as [number, number, number, number, number, number, number];
    const floats = (at: number, count: number) =>
      new Float32Array(buffer, at, count).slice() as Float32Array<ArrayBuffer>;
    return {
      positions: floats(positions, 3 * points),
      triangles: new Uint32Array(buffer, triangles, 3 * faces).slice() as Uint32Array<ArrayBuffer>,
      ...(texcoords !== 0 && { texcoords: floats(texcoords, 2 * points) }),
      ...(colours !== 0 && { colours: new Uint8Array(buffer, colours, 3 * points).slice() as Uint8Array<ArrayBuffer> }),
      ...(normals !== 0 && { normals: floats(normals, 3 * points) }),
    };
  }

  /// Returns the text up to a 0.
  #text(at: number): string {
    const bytes = new Uint8Array(this.#exports.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }
}

/// Returns [pieces * 2] the lengths of each piece's residuals, and of those of its texture coordinates and colours.
function sizesOf({ residuals, texcoordBytes = 0, pieces }: CodedLevel): Uint32Array {
  if (pieces.length === 0) return new Uint32Array([residuals.length - texcoordBytes, texcoordBytes]);
  return new Uint32Array(
    pieces.flatMap(({ bytes, texcoordBytes = 0, isMissing }) =>
      isMissing ? [missingPiece, 0] : [bytes, texcoordBytes],
    ),
  );
}
