// Kernel: Papilio's core as a WebAssembly module, on the calling thread. Its functions are documented in papilio.h
// (client/c); this file defines their structures in the module's memory.

import { queryOf, type Parameters } from './parameters.js';

/// Kind of an attribute: `values` are interpolated; `normals` are recomputed from the refined surface, and split as in
/// the input; faces of different `smoothing-groups` meet at creases; `displacements` of a morph target
/// are refined as the surface is.
export type AttributeKind = 'values' | 'normals' | 'smoothing-groups' | 'displacements';

export interface Attribute {
  kind: AttributeKind;
  components: number;
  /// [points * components]
  values: ArrayLike<number>;
}

/// Indexed triangles, counter-clockwise seen from outside. Points of equal position are one vertex; with different
/// attributes they form a seam.
export interface Triangles {
  /// [points * 3]
  positions: Float32Array;
  /// [faces * 3]
  triangles: Uint32Array;
  attributes?: readonly Attribute[];
}

export interface RefinedTriangles extends Triangles {
  attributes: { kind: AttributeKind; components: number; values: Float64Array | Float32Array }[];
}

export interface Statistics {
  /// Level of this mesh; 0: the coarse mesh.
  level: number;
  /// Whether no further level follows; the members that follow are set for the last level only.
  isLast: boolean;
  stopReason: 'converged' | 'levels' | 'budget' | 'limits';
  /// Components of the mesh under the shape rules, and mechanical ones.
  components: number;
  mechanical: number;
  /// Creases among the edges of the coarse mesh.
  creases: number;
  /// Largest deviation left, as a share of the coarse mesh's diagonal.
  error: number;
  /// Largest deviation left in pixels of the view; 0 without a view.
  errorPixels: number;
}

export interface Refined {
  mesh: RefinedTriangles;
  statistics: Statistics;
}

export interface Hooks {
  /// Function called with each level, coarse first; refine() returns the last.
  onLevel?: (level: Refined) => void;
  /// Function polled every few milliseconds; true stops the refinement.
  cancelled?: () => boolean;
  /// Whether attributes are returned as Float32Array, for graphics cards.
  singlePrecision?: boolean;
  /// Whether positions, triangles and attributes of double precision are views of the module's memory, which saves their
  /// copies. They are valid until the next call of the kernel; those of a level, until onLevel returns.
  inPlace?: boolean;
}

export type Fault = 'bad-parameter' | 'unusable-mesh' | 'too-large' | 'cancelled' | 'out-of-memory' | 'internal';

/// Error of the kernel: `message` states the problem and its remedy.
export class KernelError extends Error {
  override name = 'KernelError';
  constructor(
    readonly fault: Fault,
    message: string,
    /// Parameter at fault, or ''.
    readonly parameter = '',
  ) {
    super(message);
  }
}

/// Returns the shortest exact text of a number, as in C++: 0.25, 20000, 1e+18, 1e-07.
function textOf(value: number): string {
  const scientific = value.toExponential().replace(/e([+-])(\d)$/, 'e$10$2');
  const fixed = String(value);
  const isFixed =
    !fixed.includes('e') && ((Math.abs(value) < 1e9 && Number.isInteger(value)) || fixed.length <= scientific.length);
  return isFixed ? fixed : scientific;
}

// papilio.h
const faults: readonly Fault[] = ['bad-parameter', 'unusable-mesh', 'too-large', 'cancelled', 'out-of-memory'];
const kinds: readonly AttributeKind[] = ['values', 'normals', 'smoothing-groups', 'displacements'];
const stopReasons = ['converged', 'levels', 'budget', 'limits'] as const;
const attributeBytes = 12;
const trianglesBytes = 24;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  allocate(bytes: number): number;
  release(block: number): void;
  mesh_create(triangles: number): number;
  mesh_free(mesh: number): void;
  refine(mesh: number, parameters: number, wantsLevels: number): number;
  result_mesh(result: number): number;
  result_statistics(result: number): number;
  result_free(result: number): void;
}

/// Open coarse mesh. Its arrays must not change: they are read again when the kernel restarts.
export class CoarseMesh {
  /// Address in the memory of this instance.
  pointer = 0;
  instance: WebAssembly.Instance | null = null;
  constructor(readonly triangles: Triangles) {}
}

export class Kernel {
  readonly #module: WebAssembly.Module;
  readonly #mostBytes: number;
  #instance: WebAssembly.Instance | null = null;
  #exports!: Exports;
  #hooks: Hooks = {};
  /// Address of the result that the caller views; 0: none.
  #viewed = 0;

  /// `mostBytes`: limit of memory; as it never shrinks, a larger instance is discarded after the refinement, with its
  /// data for further views.
  constructor(module: WebAssembly.Module, mostBytes = 512 * 2 ** 20) {
    this.#module = module;
    this.#mostBytes = mostBytes;
  }

  /// Compiles papilio.wasm, from its bytes or from a response of `fetch`.
  static async compile(source: BufferSource | Response | Promise<Response>): Promise<WebAssembly.Module> {
    const from = await source;
    return from instanceof Response ? WebAssembly.compileStreaming(from) : WebAssembly.compile(from);
  }

  /// Returns the memory of its instance, in bytes.
  get bytes(): number {
    return this.#instance ? this.#exports.memory.buffer.byteLength : 0;
  }

  /// Opens a mesh. Throws KernelError if it cannot be refined.
  open(triangles: Triangles): CoarseMesh {
    const mesh = new CoarseMesh(triangles);
    this.#guarded(() => this.#place(mesh));
    return mesh;
  }

  close(mesh: CoarseMesh): void {
    if (mesh.instance && mesh.instance === this.#instance) this.#guarded(() => this.#exports.mesh_free(mesh.pointer));
    mesh.instance = null;
  }

  /// Refines a mesh. Further views of it cost less than the first. Throws KernelError.
  refine(mesh: CoarseMesh, parameters: Parameters | string = {}, hooks: Hooks = {}): Refined {
    this.#hooks = hooks;
    const refined = this.#guarded(() => {
      this.#place(mesh);
      const text = this.#write(new TextEncoder().encode(`${queryOf(parameters)}\0`));
      const result = this.#exports.refine(mesh.pointer, text, hooks.onLevel ? 1 : 0);
      this.#exports.release(text);
      const made = this.#read(this.#exports.result_mesh(result), this.#exports.result_statistics(result));
      if (hooks.inPlace) this.#viewed = result;
      else this.#exports.result_free(result);
      return made;
    });
    if (this.bytes > this.#mostBytes) this.#instance = null;
    return refined;
  }

  /// Runs work in the instance. After an error its state is undefined: the next call starts another.
  #guarded<T>(work: () => T): T {
    try {
      this.#start();
      if (this.#viewed) this.#exports.result_free(this.#viewed);
      this.#viewed = 0;
      return work();
    } catch (error) {
      this.#instance = null;
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError)
        throw new KernelError('internal', `The kernel failed: ${error.message}.`);
      throw error;
    }
  }

  #start(): void {
    if (this.#instance) return;
    this.#viewed = 0;
    this.#instance = new WebAssembly.Instance(this.#module, {
      papilio: {
        fault: (fault: number, message: number, parameter: number) => {
          throw new KernelError(faults[fault - 1] ?? 'internal', this.#text(message), this.#text(parameter));
        },
        cancelled: () => (this.#hooks.cancelled?.() ? 1 : 0),
        parse_number: (text: number, length: number) => Number(this.#text(text, length)),
        format_number: (value: number, at: number) =>
          new TextEncoder().encodeInto(textOf(value), new Uint8Array(this.#exports.memory.buffer, at, 32)).written,
        level: (mesh: number, statistics: number) => this.#hooks.onLevel?.(this.#read(mesh, statistics)),
      },
      wasi_snapshot_preview1: {
        random_get: (at: number, bytes: number) => {
          const to = new Uint8Array(this.#exports.memory.buffer, at, bytes);
          // Node 18 has no global crypto. The bytes seed a hash table, whose order affects no result.
          if (globalThis.crypto) crypto.getRandomValues(to);
          else to.forEach((_, i) => (to[i] = 256 * Math.random()));
          return 0;
        },
        // Stubs of the C library's streams, which are not used.
        fd_close: () => 0,
        fd_seek: () => 0,
        fd_write: () => 0,
      },
    });
    this.#exports = this.#instance.exports as unknown as Exports;
    this.#exports._initialize();
  }

  /// Copies the mesh into the instance, unless it is there.
  #place(mesh: CoarseMesh): void {
    if (mesh.instance === this.#instance) return;
    const { positions, triangles, attributes = [] } = mesh.triangles;
    const points = Math.floor(positions.length / 3);
    const blocks: number[] = [];
    const write = (array: ArrayBufferView) => blocks[blocks.push(this.#write(array)) - 1]!;
    const rows = new Uint32Array((attributes.length * attributeBytes) / 4);
    attributes.forEach(({ kind, components, values }, a) => {
      if (values.length !== points * components)
        throw new KernelError(
          'unusable-mesh',
          `Attribute ${a} has ${values.length} values for ${points} points of ${components}.`,
        );
      rows.set([components, kinds.indexOf(kind), write(Float64Array.from(values))], (a * attributeBytes) / 4);
    });
    const view = new Uint32Array([
      points,
      Math.floor(triangles.length / 3),
      attributes.length,
      write(positions),
      write(triangles),
      write(rows),
    ]);
    mesh.pointer = this.#exports.mesh_create(write(view));
    mesh.instance = this.#instance;
    for (const block of blocks) this.#exports.release(block);
  }

  /// Copies values into memory, and returns their address.
  #write(array: ArrayBufferView): number {
    const at = this.#exports.allocate(array.byteLength);
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    new Uint8Array(this.#exports.memory.buffer, at, array.byteLength).set(bytes);
    return at;
  }

  /// Returns a level, copied unless it is read in place.
  #read(mesh: number, statistics: number): Refined {
    const { buffer } = this.#exports.memory;
    const view = new DataView(buffer);
    const word = (at: number) => view.getUint32(at, true);
    const { singlePrecision, inPlace } = this.#hooks;
    const given = <T extends Float32Array | Float64Array | Uint32Array>(view: T) =>
      (inPlace ? view : view.slice()) as T;
    const [points, faces, count, positions, triangles, attributes] = Array.from(
      new Uint32Array(buffer, mesh, trianglesBytes / 4),
    ) as [number, number, number, number, number, number];
    return {
      mesh: {
        positions: given(new Float32Array(buffer, positions, 3 * points)),
        triangles: given(new Uint32Array(buffer, triangles, 3 * faces)),
        attributes: Array.from({ length: count }, (_, a) => {
          const [components, kind, values] = [0, 4, 8].map((o) => word(attributes + a * attributeBytes + o)) as [
            number,
            number,
            number,
          ];
          const all = new Float64Array(buffer, values, points * components);
          return { kind: kinds[kind]!, components, values: singlePrecision ? new Float32Array(all) : given(all) };
        }),
      },
      statistics: {
        level: word(statistics),
        isLast: word(statistics + 4) !== 0,
        stopReason: stopReasons[word(statistics + 8)]!,
        components: word(statistics + 12),
        mechanical: word(statistics + 16),
        creases: word(statistics + 20),
        error: view.getFloat64(statistics + 24, true),
        errorPixels: view.getFloat64(statistics + 32, true),
      },
    };
  }

  /// Returns the text; without a length, up to a 0.
  #text(at: number, length?: number): string {
    const bytes = new Uint8Array(this.#exports.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, length ?? bytes.indexOf(0)));
  }
}
