// The mesh that is open: its bytes, its picture, and its place in the server's store.

import type { BufferGeometry } from 'three';

import type { Decoded, Encoded } from './model';
import { type Level, Problem, refine, store, type Summary } from './service';

export class OpenMesh {
  #id: Promise<string | null> | null = null;

  constructor(
    /// A file's or a sample's.
    readonly name: string,
    readonly encoded: Encoded,
    readonly decoded: Decoded,
  ) {}

  get geometry(): BufferGeometry {
    return this.decoded.geometry;
  }

  get isScene(): boolean {
    return this.encoded.kind === 'scene';
  }

  /// Stores the mesh unless it is. Null where the server's store cannot take it: it is then sent with each request.
  /// Rejects with a Problem where the server refuses the mesh, or cannot be asked now.
  get id(): Promise<string | null> {
    if (this.#id === null) {
      const stored = store(this.encoded).catch((error: unknown) => {
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
        return await refine(this.encoded, id, query, onLevel, signal);
      } catch (error) {
        if (isAgain || !(error instanceof Problem) || error.code !== 'mesh_not_found') throw error;
        this.#id = null;
      }
    }
  }
}
