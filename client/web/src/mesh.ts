// The mesh that is open: its bytes, its picture, and its place in the server's store.

import type { BufferGeometry } from 'three';

import { type Level, Problem, refine, store, type Summary } from './service';

export class OpenMesh {
  #id: Promise<string | null> | null = null;

  constructor(
    /// A file's or a sample's.
    readonly name: string,
    readonly draco: Uint8Array<ArrayBuffer>,
    readonly geometry: BufferGeometry,
  ) {}

  get faces(): number {
    return this.geometry.index!.count / 3;
  }

  get vertices(): number {
    return this.geometry.getAttribute('position').count;
  }

  /// Stores the mesh unless it is. Null where the server's store cannot take it: it is then sent with each request.
  /// Rejects with a Problem where the server refuses the mesh, or cannot be asked now.
  get id(): Promise<string | null> {
    if (this.#id === null) {
      const stored = store(this.draco).catch((error: unknown) => {
        if (error instanceof Problem && ['store_full', 'store_unavailable'].includes(error.code)) return null;
        this.#id = null; // the next time it is tried again
        throw error;
      });
      this.#id = stored;
    }
    return this.#id;
  }

  /// As `refine` of service.ts. A mesh that the store has given up is stored again.
  async refine(query: string, onLevel: (level: Level) => void, signal: AbortSignal): Promise<Summary> {
    for (let isAgain = false; ; isAgain = true) {
      const id = await this.id;
      signal.throwIfAborted();
      try {
        return await refine(id === null ? { draco: this.draco } : { id }, query, onLevel, signal);
      } catch (error) {
        if (isAgain || !(error instanceof Problem) || error.code !== 'mesh_not_found') throw error;
        this.#id = null;
      }
    }
  }
}
