// The kernel: Papilio's core as a WebAssembly module, on the thread that calls it. papilio.h (client/c) says what its
// functions do; here are their structures in the module's memory.

import { queryOf, type Parameters } from './parameters.js';

/// What becomes of an attribute's values: `values` are interpolated, `normals` are those of the refined surface, split
/// where the input splits them; faces of different `smoothing-groups`, or of group 0, meet at creases; `displacements`
/// move the refined surface as a morph target moves the coarse mesh.
export type AttributeKind = 'values' | 'normals' | 'smoothing-groups' | 'displacements';

export interface Attribute {
  kind: AttributeKind;
  components: number;
  /// [points * components]
  values: ArrayLike<number>;
}

/// Indexed triangles, counter-clockwise seen from outside. Points of equal position are one vertex, and with different
/// attributes a seam.
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
  /// Of this mesh; 0: the coarse mesh.
  level: number;
  /// Whether no further level comes; what follows holds of the last level only.
  isLast: boolean;
  stopReason: 'converged' | 'levels' | 'budget' | 'limits';
  /// Parts of the mesh that the shape rules looked at, and how many of them were taken for mechanical.
  components: number;
  mechanical: number;
  /// Edges of the coarse mesh kept sharp.
  creases: number;
  /// Largest deviation left, as a share of the coarse mesh's diagonal.
  error: number;
  /// The same in pixels of the view; 0 without one.
  errorPixels: number;
}

export interface Refined {
  mesh: RefinedTriangles;
  statistics: Statistics;
}

export interface Hooks {
  /// Called with each level, coarse first; the last is what `refine` returns.
  onLevel?: (level: Refined) => void;
  /// Asked every few milliseconds whether to stop.
  cancelled?: () => boolean;
}

export type Fault = 'bad-parameter' | 'unusable-mesh' | 'too-large' | 'cancelled' | 'out-of-memory' | 'internal';

/// A refusal of the kernel: `message` says what is wrong and what to do.
export class KernelError extends Error {
  override name = 'KernelError';
  constructor(
    readonly fault: Fault,
    message: string,
    /// The parameter at fault, or ''.
    readonly parameter = '',
  ) {
    super(message);
  }
}

/// The shortest text of a number, as C++ writes it: 0.25, 20000, 1e+18, 1e-07.
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

/// A coarse mesh that was opened. Its arrays must not change: they are read again where the kernel starts anew.
export class CoarseMesh {
  /// Where it lies in the memory of this instance.
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

  /// `mostBytes`: memory never shrinks, so an instance that has come to hold more than this is given up after the
  /// refinement, with what it kept for further views.
  constructor(module: WebAssembly.Module, mostBytes = 512 * 2 ** 20) {
    this.#module = module;
    this.#mostBytes = mostBytes;
  }

  /// Compiles papilio.wasm, from its bytes or from what `fetch` gives.
  static async compile(source: BufferSource | Response | Promise<Response>): Promise<WebAssembly.Module> {
    const from = await source;
    return from instanceof Response ? WebAssembly.compileStreaming(from) : WebAssembly.compile(from);
  }

  /// What its instance holds in memory.
  get bytes(): number {
    return this.#instance ? this.#exports.memory.buffer.byteLength : 0;
  }

  /// Throws KernelError where the mesh cannot be refined.
  open(triangles: Triangles): CoarseMesh {
    const mesh = new CoarseMesh(triangles);
    this.#guarded(() => this.#place(mesh));
    return mesh;
  }

  close(mesh: CoarseMesh): void {
    if (mesh.instance && mesh.instance === this.#instance) this.#guarded(() => this.#exports.mesh_free(mesh.pointer));
    mesh.instance = null;
  }

  /// Throws KernelError. Further views of a mesh cost less than the first.
  refine(mesh: CoarseMesh, parameters: Parameters | string = {}, hooks: Hooks = {}): Refined {
    this.#hooks = hooks;
    const refined = this.#guarded(() => {
      this.#place(mesh);
      const text = this.#write(new TextEncoder().encode(`${queryOf(parameters)}\0`));
      const result = this.#exports.refine(mesh.pointer, text, hooks.onLevel ? 1 : 0);
      this.#exports.release(text);
      const made = this.#read(this.#exports.result_mesh(result), this.#exports.result_statistics(result));
      this.#exports.result_free(result);
      return made;
    });
    if (this.bytes > this.#mostBytes) this.#instance = null;
    return refined;
  }

  /// After an error the instance has lost its way: the next call starts another.
  #guarded<T>(work: () => T): T {
    try {
      this.#start();
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
          // Node 18 has no global crypto; it is for the order of a hash table, on which no result depends.
          if (globalThis.crypto) crypto.getRandomValues(to);
          else to.forEach((_, i) => (to[i] = 256 * Math.random()));
          return 0;
        },
        // The C library's streams, to which nothing is written.
        fd_close: () => 0,
        fd_seek: () => 0,
        fd_write: () => 0,
      },
    });
    this.#exports = this.#instance.exports as unknown as Exports;
    this.#exports._initialize();
  }

  /// Copies the mesh into the instance, where it is not there yet.
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

  /// Returns where the copy lies.
  #write(array: ArrayBufferView): number {
    const at = this.#exports.allocate(array.byteLength);
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    new Uint8Array(this.#exports.memory.buffer, at, array.byteLength).set(bytes);
    return at;
  }

  /// Copies a level out.
  #read(mesh: number, statistics: number): Refined {
    const { buffer } = this.#exports.memory;
    const view = new DataView(buffer);
    const word = (at: number) => view.getUint32(at, true);
    const [points, faces, count, positions, triangles, attributes] = Array.from(
      new Uint32Array(buffer, mesh, trianglesBytes / 4),
    ) as [number, number, number, number, number, number];
    return {
      mesh: {
        positions: new Float32Array(buffer, positions, 3 * points).slice(),
        triangles: new Uint32Array(buffer, triangles, 3 * faces).slice(),
        attributes: Array.from({ length: count }, (_, a) => {
          const [components, kind, values] = [0, 4, 8].map((o) => word(attributes + a * attributeBytes + o)) as [
            number,
            number,
            number,
          ];
          return {
            kind: kinds[kind]!,
            components,
            values: new Float64Array(buffer, values, points * components).slice(),
          };
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

  /// Without a length, up to a 0.
  #text(at: number, length?: number): string {
    const bytes = new Uint8Array(this.#exports.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, length ?? bytes.indexOf(0)));
  }
}
