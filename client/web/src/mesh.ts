// The mesh that is open: its bytes, its picture, and who refines it.

import { RemoteMesh } from 'papilio/client';
import type { BufferGeometry } from 'three';

import { Here } from './here';
import { type Decoded, type Encoded, mediaTypes } from './model';
import type { PackedLevel } from './packed';
import { client, type Level, levelOf, read, type Summary } from './service';

export class OpenMesh {
  #remote: Promise<RemoteMesh> | null = null;
  #here: Promise<Here | null> | null = null;

  constructor(
    /// A file's or a sample's.
    readonly name: string,
    readonly encoded: Encoded,
    readonly decoded: Decoded,
    /// The level of a packed model that this is; null: no packed model.
    readonly packed: PackedLevel | null = null,
  ) {}

  get geometry(): BufferGeometry {
    return this.decoded.geometry;
  }

  /// A packed model with materials or colours is one, too.
  get isScene(): boolean {
    return this.decoded.scene !== null;
  }

  /// What the server is sent.
  get sentKind(): 'draco' | 'scene' {
    return this.isScene ? 'scene' : 'draco';
  }

  /// As RemoteMesh has it.
  get id(): Promise<string | null> {
    return this.#theRemote().then((remote) => remote.id);
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
    const remote = await this.#theRemote();
    signal.throwIfAborted();
    if (!this.isScene) return remote.levels(query, (levels) => read(levels, onLevel), { signal });
    const fine = await remote.refine(query, { signal });
    onLevel(levelOf(fine));
    return fine.summary;
  }

  /// Made when it is needed: a level of a packed model is encoded for it.
  #theRemote(): Promise<RemoteMesh> {
    if (this.#remote !== null) return this.#remote;
    const sent = this.packed?.encode() ?? Promise.resolve(this.encoded.bytes);
    this.#remote = sent.then((bytes) => new RemoteMesh(client, { type: mediaTypes[this.sentKind], bytes }));
    this.#remote.catch(() => (this.#remote = null)); // the next request tries again
    return this.#remote;
  }

  dispose(): void {
    void this.#here?.then((here) => here?.dispose());
    this.decoded.dispose();
  }

  /// Also of the packed model that it is a level of.
  close(): void {
    this.dispose();
    this.packed?.model.close();
    this.packed?.base?.dispose();
  }
}
