// Open packed model, decoded in a worker, level by level.

import { Problem } from '../client.js';
import { decodeBase, type DracoDecoder } from './base.js';
import { type BaseTriangles, compileDecoder, type DecodedTriangles, type NormalStyle } from './decoder.js';
import type { FromDecoder, ToDecoder } from './messages.js';
import { type PackedFile, type Reach, type ReadOptions, readPacked } from './packed_file.js';

export interface OpenOptions extends ReadOptions {
  decodeDraco: DracoDecoder;
  /// papilio-detail.wasm: its bytes, a response of `fetch`, or a compiled module. Default: the file beside this one.
  wasm?: BufferSource | Response | Promise<Response> | WebAssembly.Module;
}

export interface LevelInfo extends Reach {
  /// Length of the level's residuals, including texture coordinates and colours; for the base, of its Draco streams and
  /// curves.
  bytes: number;
  /// Bytes of the file that this level requires.
  fileBytes: number;
  vertices: number;
  faces: number;
}

export interface DecodeOptions {
  /// Signal that aborts the decoding; the promise is rejected with its reason.
  signal?: AbortSignal;
  /// Style of normals. Default: the original's style, and none if it has none.
  normals?: NormalStyle;
}

interface Task {
  request: number;
  levels: number;
  normals: NormalStyle;
  resolve: (triangles: DecodedTriangles) => void;
  reject: (reason: unknown) => void;
}

let shared: Promise<WebAssembly.Module> | null = null;

/// Returns the module beside this file, fetched with the first model.
function sharedModule(): Promise<WebAssembly.Module> {
  shared ??= compileDecoder(fetch(new URL('../papilio-detail.wasm', import.meta.url)));
  shared.catch(() => (shared = null)); // the next model retries
  return shared;
}

/// Opens a packed model. Rejects with Problem: as readPacked(), and mesh_unusable if the base is not manifold or
/// differs from the declaration.
export async function openPacked(bytes: Uint8Array<ArrayBuffer>, options: OpenOptions): Promise<PackedModel> {
  const file = readPacked(bytes, options);
  const { wasm } = options;
  const compiled =
    wasm === undefined ? sharedModule() : wasm instanceof WebAssembly.Module ? wasm : compileDecoder(wasm);
  const [module, base] = await Promise.all([compiled, decodeBase(file.base, options.decodeDraco)]);
  const model = new PackedModel(module, file, base);
  try {
    await model.opened;
  } catch (error) {
    model.close();
    throw error;
  }
  return model;
}

export class PackedModel {
  readonly base: LevelInfo;
  /// Complete levels, coarse first.
  readonly levels: readonly LevelInfo[];
  /// Number of levels that the file declares: more than `levels` if it is cut.
  readonly declaredLevels: number;
  /// Style of the original's normals.
  readonly normals: NormalStyle;
  readonly hasTexcoords: boolean;
  readonly hasColours: boolean;
  /// Whether the file has a material for any face, so that GLTFLoader reads it as a scene, too.
  readonly hasMaterial: boolean;
  /// Promise that is rejected if the base differs from the declaration.
  readonly opened: Promise<void>;
  readonly #module: WebAssembly.Module;
  readonly #file: PackedFile;
  readonly #triangles: BaseTriangles;
  #worker: Worker | null = null;
  #running: Task | null = null;
  #waiting: Task[] = [];
  #requests = 0;
  #isClosed = false;
  #settle!: { resolve: () => void; reject: (reason: unknown) => void };

  /// Use openPacked() instead.
  constructor(module: WebAssembly.Module, file: PackedFile, base: BaseTriangles) {
    this.#module = module;
    this.#file = file;
    this.#triangles = base;
    ({ declaredLevels: this.declaredLevels, normals: this.normals, hasMaterial: this.hasMaterial } = file);
    const { rms, largest, vertices, faces, primitives, end } = file.base;
    ({ hasTexcoords: this.hasTexcoords, hasColours: this.hasColours } = file.base);
    const bytes = primitives.reduce((sum, { draco }) => sum + draco.length, file.curves.length);
    this.base = { rms, largest, bytes, fileBytes: end, vertices, faces };
    let points = vertices;
    this.levels = file.levels.map((level) => ({
      rms: level.rms,
      largest: level.largest,
      bytes: level.residuals.length,
      fileBytes: level.end,
      vertices: (points += level.residualCount),
      faces: level.faces,
    }));
    this.opened = new Promise((resolve, reject) => (this.#settle = { resolve, reject }));
    this.#start();
  }

  /// Returns the surface with the first `levels` levels, 0 for the base, bit-identical to that of `papilio unpack`.
  /// Rejects with Problem, or with the signal's reason.
  decode(levels: number, { signal, normals = this.normals }: DecodeOptions = {}): Promise<DecodedTriangles> {
    return new Promise((resolve, reject) => {
      if (this.#isClosed) return reject(new Error('The packed model was closed.'));
      if (!Number.isInteger(levels) || levels < 0 || levels > this.levels.length)
        return reject(new RangeError(`The model has ${this.levels.length} levels, not ${levels}.`));
      if (signal?.aborted) return reject(signal.reason);
      const task: Task = { request: ++this.#requests, levels, normals, resolve, reject };
      signal?.addEventListener('abort', () => this.#abort(task, signal), { once: true });
      this.#waiting.push(task);
      this.#next();
    });
  }

  /// Ends the worker and frees its memory. Pending calls are rejected.
  close(): void {
    this.#isClosed = true;
    this.#worker?.terminate();
    this.#worker = null;
    const tasks = [...(this.#running ? [this.#running] : []), ...this.#waiting];
    this.#running = null;
    this.#waiting = [];
    for (const task of tasks) task.reject(new Error('The packed model was closed.'));
  }

  #start(): void {
    this.#worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'papilio-detail' });
    this.#worker.onmessage = ({ data }: MessageEvent<FromDecoder>) => this.#take(data);
    this.#worker.onerror = (event) => {
      const message = `The worker failed: ${event.message || 'it could not be loaded'}.`;
      this.#take({ kind: 'failed', request: this.#running?.request ?? null, code: 'internal', message });
    };
    const levels = this.#file.levels.map(({ step, residuals, texcoordStep, texcoordBytes, pieces }) => {
      return { step, residuals: residuals.slice(), texcoordStep, texcoordBytes, pieces };
    });
    const [base, curves] = [this.#triangles, this.#file.curves.slice()];
    this.#send({ kind: 'open', module: this.#module, base, curves, levels });
  }

  #next(): void {
    if (this.#running !== null) return;
    this.#running = this.#waiting.shift() ?? null;
    if (this.#running === null) return;
    if (this.#worker === null) this.#start();
    const { request, levels, normals } = this.#running;
    this.#send({ kind: 'decode', request, levels, normals });
  }

  #take(message: FromDecoder): void {
    if (message.kind === 'opened') return this.#check(message.edges);
    const problem = message.kind === 'failed' ? new Problem(message.code, message.message) : null;
    if (problem !== null) this.#settle.reject(problem);
    const task = this.#running;
    if (task === null || task.request !== message.request) return;
    this.#running = null;
    if (message.kind === 'decoded') task.resolve(message.triangles);
    else task.reject(problem);
    this.#next();
  }

  /// Rejects the model unless its counts match the base: each level splits all edges of the one before.
  #check(edges: number): void {
    let { faces } = this.base;
    for (const [l, { residualCount }] of this.#file.levels.entries()) {
      if (residualCount !== edges) {
        const what = `Level ${l + 1} declares ${residualCount} residuals, and the base gives ${edges}.`;
        this.#settle.reject(new Problem('mesh_not_gltf', `${what} Pack the model again.`));
        return this.close();
      }
      edges = 2 * edges + 3 * faces;
      faces *= 4;
    }
    this.#settle.resolve();
  }

  /// Ends a worker that decodes, as it receives no messages meanwhile.
  #abort(task: Task, signal: AbortSignal): void {
    this.#waiting = this.#waiting.filter((one) => one !== task);
    if (this.#running === task) {
      this.#running = null;
      this.#worker?.terminate();
      this.#worker = null;
    }
    task.reject(signal.reason);
    if (!this.#isClosed) this.#next();
  }

  #send(message: ToDecoder): void {
    this.#worker!.postMessage(message);
  }
}
