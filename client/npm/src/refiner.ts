// Refinement in workers, which does not block the page, and can be stopped.

import { Kernel, KernelError, type Refined, type Triangles } from './kernel.js';
import type { FromWorker, ToWorker } from './messages.js';
import { queryOf, type Parameters } from './parameters.js';

export interface RefinerOptions {
  /// papilio.wasm: its bytes, a response of `fetch`, or a compiled module. Default: the file beside this one.
  wasm?: BufferSource | Response | Promise<Response> | WebAssembly.Module;
  /// Number of workers, each with its own memory.
  workers?: number;
  /// Limit of a worker's memory: a larger one is discarded after the refinement, with its data for further views.
  mostBytes?: number;
}

export interface RefineOptions {
  /// Signal that stops the refinement; the promise is rejected with its reason.
  signal?: AbortSignal;
  /// Function called with each level but the last, coarse first.
  onLevel?: (level: Refined) => void;
  /// Whether attributes are returned as Float32Array, for graphics cards.
  singlePrecision?: boolean;
}

/// Open mesh. Its arrays must not change.
export interface OpenMesh {
  readonly triangles: Triangles;
}

interface Task {
  request: number;
  mesh: Mesh;
  query: string;
  options: RefineOptions;
  resolve: (refined: Refined) => void;
  reject: (reason: unknown) => void;
}

class Mesh implements OpenMesh {
  constructor(
    readonly number: number,
    readonly triangles: Triangles,
  ) {}
}

/// Worker, which runs one task at a time.
class Seat {
  readonly meshes = new Set<Mesh>();
  task: Task | null = null;
  readonly #worker: Worker;
  /// Stops the task: by shared memory if that is permitted, else by ending the worker.
  readonly #cancelled = globalThis.crossOriginIsolated ? new SharedArrayBuffer(4) : null;

  constructor(module: WebAssembly.Module, mostBytes: number, onMessage: (seat: Seat, message: FromWorker) => void) {
    this.#worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'papilio' });
    this.#worker.onmessage = ({ data }: MessageEvent<FromWorker>) => onMessage(this, data);
    this.#worker.onerror = (event) => {
      if (this.task)
        onMessage(this, {
          kind: 'failed',
          request: this.task.request,
          fault: 'internal',
          message: `The worker failed: ${event.message || 'it could not be loaded'}.`,
          parameter: '',
        });
    };
    this.#send({ kind: 'start', module, cancelled: this.#cancelled, mostBytes });
  }

  run(task: Task): void {
    if (!this.meshes.has(task.mesh)) {
      this.#send({ kind: 'open', mesh: task.mesh.number, triangles: task.mesh.triangles });
      this.meshes.add(task.mesh);
    }
    this.task = task;
    const { request, query, mesh, options } = task;
    const [wantsLevels, isSingle] = [!!options.onLevel, options.singlePrecision === true];
    this.#send({ kind: 'refine', request, mesh: mesh.number, query, wantsLevels, isSingle });
  }

  forget(mesh: Mesh): void {
    if (this.meshes.delete(mesh)) this.#send({ kind: 'close', mesh: mesh.number });
  }

  /// Returns whether the worker continues; else it has ended.
  stop(): boolean {
    if (this.#cancelled) Atomics.store(new Int32Array(this.#cancelled), 0, this.task!.request);
    else this.end();
    return this.#cancelled !== null;
  }

  end(): void {
    this.#worker.terminate();
  }

  #send(message: ToWorker): void {
    this.#worker.postMessage(message);
  }
}

export class Refiner {
  readonly #module: WebAssembly.Module;
  readonly #workers: number;
  readonly #mostBytes: number;
  #seats: Seat[] = [];
  #waiting: Task[] = [];
  #numbers = 0;
  #isClosed = false;

  private constructor(module: WebAssembly.Module, { workers = 1, mostBytes = 512 * 2 ** 20 }: RefinerOptions) {
    this.#module = module;
    this.#workers = workers;
    this.#mostBytes = mostBytes;
  }

  static async start(options: RefinerOptions = {}): Promise<Refiner> {
    const source = options.wasm ?? fetch(new URL('./papilio.wasm', import.meta.url));
    const module = source instanceof WebAssembly.Module ? source : await Kernel.compile(source);
    return new Refiner(module, options);
  }

  open(triangles: Triangles): OpenMesh {
    return new Mesh(++this.#numbers, triangles);
  }

  /// Frees the data kept for the mesh; pending refinements of it continue.
  forget(mesh: OpenMesh): void {
    for (const seat of this.#seats) seat.forget(mesh as Mesh);
  }

  /// Refines a mesh, bit-identically to the service before its encoding. Further views of a mesh cost less than the
  /// first. Rejects with KernelError, or with the signal's reason.
  refine(mesh: OpenMesh, parameters: Parameters | string = {}, options: RefineOptions = {}): Promise<Refined> {
    const { signal } = options;
    return new Promise((resolve, reject) => {
      if (this.#isClosed) return reject(new Error('The refiner was closed.'));
      if (signal?.aborted) return reject(signal.reason);
      const request = ++this.#numbers;
      const task: Task = { request, mesh: mesh as Mesh, query: queryOf(parameters), options, resolve, reject };
      signal?.addEventListener('abort', () => this.#abort(task), { once: true });
      this.#waiting.push(task);
      this.#assign();
    });
  }

  /// Ends the workers. Pending refinements are rejected.
  close(): void {
    this.#isClosed = true;
    const tasks = [...this.#seats.flatMap((seat) => seat.task ?? []), ...this.#waiting];
    for (const seat of this.#seats) seat.end();
    this.#seats = [];
    this.#waiting = [];
    for (const task of tasks) task.reject(new Error('The refiner was closed.'));
  }

  /// Assigns waiting tasks to free workers, preferably to one that already has the mesh.
  #assign(): void {
    while (this.#waiting.length > 0) {
      const free = this.#seats.filter((seat) => !seat.task);
      let seat = free.find((one) => one.meshes.has(this.#waiting[0]!.mesh)) ?? free[0];
      if (!seat) {
        if (this.#seats.length >= this.#workers) return;
        seat = new Seat(this.#module, this.#mostBytes, (from, message) => this.#take(from, message));
        this.#seats.push(seat);
      }
      seat.run(this.#waiting.shift()!);
    }
  }

  #take(seat: Seat, message: FromWorker): void {
    const { task } = seat;
    if (task?.request !== message.request) return;
    if (message.kind === 'level') {
      if (!task.options.signal?.aborted) task.options.onLevel?.(message.level);
      return;
    }
    seat.task = null;
    if (message.kind === 'done') task.resolve(message.refined);
    else task.reject(new KernelError(message.fault, message.message, message.parameter));
    this.#assign();
  }

  #abort(task: Task): void {
    this.#waiting = this.#waiting.filter((one) => one !== task);
    const seat = this.#seats.find((one) => one.task === task);
    if (seat && !seat.stop()) this.#seats = this.#seats.filter((one) => one !== seat);
    task.reject(task.options.signal!.reason);
    this.#assign();
  }
}
