// Open mesh: its bytes, its decoded form, and its refinement.

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
    /// Name of a file or sample.
    readonly name: string,
    readonly encoded: Encoded,
    readonly decoded: Decoded,
    /// Level of a packed model that is this mesh; null: no packed model.
    readonly packed: PackedLevel | null = null,
  ) {}

  get geometry(): BufferGeometry {
    return this.decoded.geometry;
  }

  /// Returns what the user has to give for the mesh to look as meant; "" for nothing.
  get hint(): string {
    const { missing } = this.decoded;
    if (missing.length > 0) return `${this.name} has no ${missing.join(', ')} inside, which is shown white.`;
    const { libraries = [] } = this.encoded;
    if (libraries.length === 0) return '';
    return `${this.name} has its materials in ${libraries.join(', ')}: drop or pick the files together.`;
  }

  /// Returns whether the mesh is a scene; packed models with materials or colours are scenes.
  get isScene(): boolean {
    return this.decoded.scene !== null;
  }

  /// Returns the format for the server.
  get sentKind(): 'draco' | 'scene' {
    return this.isScene ? 'scene' : 'draco';
  }

  /// Returns the id on the server, as RemoteMesh does.
  get id(): Promise<string | null> {
    return this.#theRemote().then((remote) => remote.id);
  }

  /// Returns the mesh in the kernel; null if this browser cannot refine it.
  get here(): Promise<Here | null> {
    this.#here ??= Here.of(this.decoded).catch(() => null);
    return this.#here;
  }

  /// Refines by the server. Calls onLevel for each level of a mesh, the coarse mesh first; for a scene only with the
  /// result, as each level would repeat its images. Rejects with a Problem, or with an AbortError once the signal is
  /// aborted.
  async refine(query: string, onLevel: (level: Level) => void, signal: AbortSignal): Promise<Summary> {
    const remote = await this.#theRemote();
    signal.throwIfAborted();
    if (!this.isScene) return remote.levels(query, (levels) => read(levels, onLevel), { signal });
    const fine = await remote.refine(query, { signal });
    onLevel(levelOf(fine));
    return fine.summary;
  }

  /// Returns the mesh on the server; encodes a level of a packed model with the first call.
  #theRemote(): Promise<RemoteMesh> {
    if (this.#remote !== null) return this.#remote;
    const sent = this.packed?.encode() ?? Promise.resolve(this.encoded.bytes);
    this.#remote = sent.then((bytes) => new RemoteMesh(client, { type: mediaTypes[this.sentKind], bytes }));
    this.#remote.catch(() => (this.#remote = null)); // the next request retries
    return this.#remote;
  }

  dispose(): void {
    void this.#here?.then((here) => here?.dispose());
    this.decoded.dispose();
  }

  /// Frees the mesh and the packed model it is a level of.
  close(): void {
    this.dispose();
    this.packed?.model.close();
    this.packed?.base?.dispose();
  }
}
