// Original of a packed model: a file that levels are compared with, in a worker.

import type { BufferGeometry } from 'three';

import { formatOf, readEncoded } from './open_file';
import { openMesh } from './opening';
import { Problem } from './service';
import { triangleFormats } from './triangle_files';
import type { Surface, TwoSided } from './two_sided';
import type { FromMeasurer, ToMeasurer } from './two_sided_worker';

export type { TwoSided };

export class Original {
  readonly #worker = new Worker(new URL('./two_sided_worker.ts', import.meta.url), {
    type: 'module',
    name: 'papilio-distance',
  });
  /// Pending request; null: none.
  #waiting: { resolve: (measured: TwoSided | null) => void; reject: (reason: unknown) => void } | null = null;

  private constructor(readonly name: string) {
    this.#worker.onmessage = ({ data }: MessageEvent<FromMeasurer>) => {
      if ('fault' in data) this.#fail(data.fault);
      else this.#waiting?.resolve(data.measured);
    };
    this.#worker.onerror = ({ message }) =>
      this.#fail(`The distance cannot be measured: ${message || 'its script could not be loaded'}.`);
  }

  /// Opens an original. `files`: files dropped or picked together, including `file`. Rejects with a Problem.
  static async open(file: File, files: readonly File[]): Promise<Original> {
    const extension = formatOf(file);
    if (triangleFormats.includes(extension)) {
      const bytes = await file.arrayBuffer();
      return new Original(file.name).#opened({ kind: 'file', name: file.name, extension, bytes }, [bytes]);
    }
    const mesh = await openMesh(file.name, await readEncoded(file, files)).catch((error: unknown) => {
      if (!(error instanceof Problem) || error.code === 'unreachable') throw error;
      throw new Problem(error.code, `${file.name} cannot be read: ${error.message}`);
    });
    try {
      return await new Original(file.name).#opened({ kind: 'original', surface: surfaceOf(mesh.geometry) });
    } finally {
      mesh.close();
    }
  }

  /// Measures the distance of a surface from the original, one surface at a time. Rejects with a Problem.
  async measure(geometry: BufferGeometry): Promise<TwoSided> {
    return (await this.#send({ kind: 'measure', surface: surfaceOf(geometry) }))!;
  }

  /// Ends the worker, and rejects a pending measurement.
  close(): void {
    this.#worker.terminate();
    this.#fail('The original was closed.');
  }

  async #opened(message: ToMeasurer, transfer: Transferable[] = []): Promise<this> {
    try {
      await this.#send(message, transfer);
      return this;
    } catch (error) {
      this.close();
      throw error;
    }
  }

  /// Sends a message. Arrays that are not transferred are copied, as the page draws them.
  #send(message: ToMeasurer, transfer: Transferable[] = []): Promise<TwoSided | null> {
    return new Promise((resolve, reject) => {
      this.#waiting = { resolve, reject };
      this.#worker.postMessage(message, transfer);
    });
  }

  #fail(why: string): void {
    this.#waiting?.reject(new Problem('unexpected', why));
  }
}

function surfaceOf(geometry: BufferGeometry): Surface {
  const index = geometry.index!.array;
  return {
    positions: new Float32Array(geometry.getAttribute('position').array),
    triangles: index instanceof Uint32Array ? index : new Uint32Array(index),
  };
}
