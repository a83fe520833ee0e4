// The mesh that is open: its bytes, its picture, and who refines it.

import { RemoteMesh } from 'papilio/client';
import type { BufferGeometry } from 'three';

import { Here } from './here';
import { type Decoded, type Encoded, mediaTypes } from './model';
import { client, type Level, levelOf, read, type Summary } from './service';

export class OpenMesh {
  readonly #remote: RemoteMesh;
  #here: Promise<Here | null> | null = null;

  constructor(
    /// A file's or a sample's.
    readonly name: string,
    readonly encoded: Encoded,
    readonly decoded: Decoded,
  ) {
    this.#remote = new RemoteMesh(client, { type: mediaTypes[encoded.kind], bytes: encoded.bytes });
  }

  get geometry(): BufferGeometry {
    return this.decoded.geometry;
  }

  get isScene(): boolean {
    return this.encoded.kind === 'scene';
  }

  /// As RemoteMesh has it.
  get id(): Promise<string | null> {
    return this.#remote.id;
  }

  /// Its refinement in this browser; null where this browser cannot.
  get here(): Promise<Here | null> {
    this.#here ??= Here.of(this.decoded).catch(() => null);
    return this.#here;
  }

  /// Refines it by the server. Calls onLevel for each level of a mesh as it comes, the coarse mesh first; for a scene,
  /// whose levels would each bring its images again, with the result alone. Rejects with a Problem, or with an AbortError
  /// once the signal says so.
  async refine(query: string, onLevel: (level: Level) => void, signal: AbortSignal): Promise<Summary> {
    if (!this.isScene) return this.#remote.levels(query, (levels) => read(levels, onLevel), { signal });
    const fine = await this.#remote.refine(query, { signal });
    onLevel(levelOf(fine));
    return fine.summary;
  }

  dispose(): void {
    void this.#here?.then((here) => here?.dispose());
    this.decoded.dispose();
  }
}
