// A scene that refines itself to whichever camera draws it.

import { type BufferGeometry, type Camera, Group, Mesh, type Object3D, type Object3DEventMap, Vector4 } from 'three';
import type { WebGLRenderer } from 'three';

import { type Client, type Encoded, Problem, RemoteMesh } from '../client.js';
import { type Parameters, queryOf } from '../parameters.js';
import type { Refiner } from '../refiner.js';
import { Latest } from './latest.js';
import { isInstanced, type Part, Parts, smooth } from './parts.js';
import { viewOf } from './view.js';

/// Who refines: workers of this page, or a server, which is sent the model as it was encoded and whose answers `decode`
/// makes a scene of again.
export type Source =
  | { refiner: Refiner }
  | { client: Client; encoded: Encoded; decode(encoded: Encoded): Promise<Object3D> };

/// What is shown now, all meshes together.
export interface ModelStatistics {
  faces: number;
  vertices: number;
  /// Largest deviation left, in pixels of the view that it was refined for.
  errorPixels: number;
}

export interface RefinedModelEvents extends Object3DEventMap {
  /// Something finer, or coarser, is shown: where pictures are drawn on demand, draw.
  refined: { statistics: ModelStatistics };
  /// Stays as it was; the next view is tried again.
  failed: { error: unknown };
}

export class RefinedModel extends Group<RefinedModelEvents> {
  /// The camera to refine for; null: each that draws it, which is for pictures with one camera.
  camera: Camera | null = null;
  /// Keeps what it shows, whatever the camera does.
  isFrozen = false;
  #parameters: Parameters;
  readonly #abort = new AbortController();
  readonly #own = new Map<Mesh, { coarse: BufferGeometry; errorPixels: number }>();
  readonly #parts: Parts | null = null;
  /// What is asked for, by the object in whose coordinates it is seen.
  readonly #latest = new Map<Object3D, Latest>();

  /// `parameters`: of the refinement, without where the camera is: `{ view: { error_pixels: 1 } }` unless given. The
  /// scene's meshes become this model's.
  constructor(scene: Object3D, source: Source, parameters: Parameters = { view: { error_pixels: 1 } }) {
    super();
    this.#parameters = parameters;
    this.add(scene);
    const all: Mesh[] = [];
    scene.traverse((object) => object instanceof Mesh && all.push(object as Mesh));
    for (const mesh of all) this.#own.set(mesh, { coarse: mesh.geometry as BufferGeometry, errorPixels: 0 });
    if ('refiner' in source) {
      const parts = new Parts(scene, source.refiner);
      this.#parts = parts;
      for (const part of parts.all) {
        const [first] = part.meshes;
        for (const mesh of part.meshes) this.#watch(mesh, first!);
        this.#latest.set(
          first!,
          this.#latestOf((query) => this.#refinePart(parts, part, query)),
        );
      }
    } else {
      const remote = new RemoteMesh(source.client, source.encoded);
      for (const mesh of all) this.#watch(mesh, this);
      this.#latest.set(
        this,
        this.#latestOf((query) => this.#refineAll(remote, source.decode, all, query)),
      );
    }
  }

  get parameters(): Parameters {
    return this.#parameters;
  }

  /// Takes effect with the next picture.
  set parameters(parameters: Parameters) {
    this.#parameters = parameters;
  }

  /// Meshes that stay as they were loaded.
  get unrefined(): readonly Mesh[] {
    return this.#parts?.unrefined ?? [];
  }

  get statistics(): ModelStatistics {
    const all = { faces: 0, vertices: 0, errorPixels: 0 };
    for (const [{ geometry }, { errorPixels }] of this.#own) {
      const points = geometry.attributes.position?.count ?? 0;
      all.faces += Math.floor((geometry.index?.count ?? points) / 3);
      all.vertices += points;
      all.errorPixels = Math.max(all.errorPixels, errorPixels);
    }
    return all;
  }

  /// Resolves once all that was asked for is shown.
  async settled(): Promise<void> {
    await Promise.all([...this.#latest.values()].map((latest) => latest.rest));
  }

  /// Refines no more, and frees geometries and what workers keep; materials and textures are the caller's.
  dispose(): void {
    this.#abort.abort(new Error('The model was disposed of.'));
    for (const latest of this.#latest.values()) latest.stop();
    this.#parts?.dispose();
    for (const [mesh, { coarse }] of this.#own) {
      mesh.geometry.dispose();
      coarse.dispose();
    }
  }

  #latestOf(work: (query: string) => Promise<void>): Latest {
    return new Latest(work, (error) => {
      if (!this.#abort.signal.aborted) this.dispatchEvent({ type: 'failed', error });
    });
  }

  /// Asks for what a camera sees of `object` each time it draws `mesh`.
  #watch(mesh: Mesh, object: Object3D): void {
    const before = mesh.onBeforeRender;
    mesh.onBeforeRender = (...drawn) => {
      before.apply(mesh, drawn);
      const [renderer, , camera] = drawn;
      const isOther = this.camera !== null && this.camera !== camera;
      if (this.isFrozen || isOther || this.#abort.signal.aborted) return;
      const query = this.#queryOf(object, camera, renderer);
      if (query !== null) this.#latest.get(object)?.ask(query);
    };
  }

  #queryOf(object: Object3D, camera: Camera, renderer: WebGLRenderer): string | null {
    const { view, ...rest } = this.#parameters;
    if (object instanceof Mesh && isInstanced(object)) {
      // Seen from many sides at once: refined for none of them.
      const isTarget = ['tolerance', 'flatness', 'max_faces'].some((name) => name in rest);
      return queryOf(isTarget ? rest : { tolerance: 0.001, ...rest });
    }
    const { z, w } = renderer.getCurrentViewport(new Vector4());
    const seen = viewOf(object, camera, [z, w]);
    return seen && queryOf({ ...rest, view: { verify: false, ...seen, ...(view as object) } } as Parameters);
  }

  async #refinePart(parts: Parts, part: Part, query: string): Promise<void> {
    const { geometries, statistics } = await parts.refine(part, query, { signal: this.#abort.signal });
    for (const [i, mesh] of part.meshes.entries()) this.#show(mesh, geometries[i]!, statistics.errorPixels);
    this.dispatchEvent({ type: 'refined', statistics: this.statistics });
  }

  async #refineAll(
    remote: RemoteMesh,
    decode: (encoded: Encoded) => Promise<Object3D>,
    all: Mesh[],
    query: string,
  ): Promise<void> {
    const answer = await remote.refine(query, { signal: this.#abort.signal });
    const made: Mesh[] = [];
    (await decode(answer)).traverse((object) => object instanceof Mesh && made.push(object as Mesh));
    this.#abort.signal.throwIfAborted();
    if (made.length !== all.length) throw new Problem('unexpected', 'The answer has other meshes than the model.');
    // The nodes stay, so that what moves them still does.
    for (const [i, mesh] of all.entries()) this.#show(mesh, made[i]!.geometry, answer.summary.error_pixels ?? 0);
    this.dispatchEvent({ type: 'refined', statistics: this.statistics });
  }

  #show(mesh: Mesh, geometry: BufferGeometry, errorPixels: number): void {
    const own = this.#own.get(mesh)!;
    if (mesh.geometry !== own.coarse) mesh.geometry.dispose();
    mesh.geometry = geometry;
    own.errorPixels = errorPixels;
    // What came without normals is drawn in facets, and has normals now.
    if (!own.coarse.hasAttribute('normal') && geometry.hasAttribute('normal')) mesh.material = smooth(mesh.material);
  }
}
