// Scene that refines itself to the camera that draws it.

import { type BufferGeometry, type Camera, Group, Mesh, type Object3D, type Object3DEventMap, Vector4 } from 'three';
import type { WebGLRenderer } from 'three';

import { type Client, type Encoded, Problem, RemoteMesh } from '../client.js';
import { type Parameters, queryOf } from '../parameters.js';
import type { Refiner } from '../refiner.js';
import { Latest } from './latest.js';
import { isInstanced, type Part, Parts, smooth } from './parts.js';
import { viewOf } from './view.js';

/// Source of refinements: workers of this page; or a server, which receives the encoded model, and whose answers
/// `decode` converts to a scene.
export type Source =
  | { refiner: Refiner }
  | { client: Client; encoded: Encoded; decode(encoded: Encoded): Promise<Object3D> };

/// Statistics of the shown meshes, all together.
export interface ModelStatistics {
  faces: number;
  vertices: number;
  /// Largest deviation left, in pixels of the refined view.
  errorPixels: number;
}

export interface RefinedModelEvents extends Object3DEventMap {
  /// Event after finer or coarser meshes are shown: redraw, if pictures are drawn on demand.
  refined: { statistics: ModelStatistics };
  /// Event after a failure: the model is unchanged, and the next view retries.
  failed: { error: unknown };
}

export class RefinedModel extends Group<RefinedModelEvents> {
  /// Camera to refine for; null: each camera that draws the model, for pictures with one camera.
  camera: Camera | null = null;
  /// Whether to keep the shown meshes when the camera moves.
  isFrozen = false;
  #parameters: Parameters;
  readonly #abort = new AbortController();
  readonly #own = new Map<Mesh, { coarse: BufferGeometry; errorPixels: number }>();
  readonly #parts: Parts | null = null;
  /// Requested parameters, by the object in whose coordinates the view is.
  readonly #latest = new Map<Object3D, Latest>();

  /// `parameters`: parameters of the refinement without the camera; default `{ view: { error_pixels: 1 } }`. The model
  /// takes the scene's meshes.
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

  /// Sets the parameters for the next picture.
  set parameters(parameters: Parameters) {
    this.#parameters = parameters;
  }

  /// Returns the meshes that are not refined.
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

  /// Resolves once all requested refinements are shown.
  async settled(): Promise<void> {
    await Promise.all([...this.#latest.values()].map((latest) => latest.rest));
  }

  /// Stops refining, and frees geometries and data of the workers. The caller owns materials and textures.
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

  /// Requests the view of a camera on `object` each time it draws `mesh`.
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
      // Instances are seen from many sides at once, and are not refined.
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
    // Nodes are kept, so that animations still apply.
    for (const [i, mesh] of all.entries()) this.#show(mesh, made[i]!.geometry, answer.summary.error_pixels ?? 0);
    this.dispatchEvent({ type: 'refined', statistics: this.statistics });
  }

  #show(mesh: Mesh, geometry: BufferGeometry, errorPixels: number): void {
    const own = this.#own.get(mesh)!;
    if (mesh.geometry !== own.coarse) mesh.geometry.dispose();
    mesh.geometry = geometry;
    own.errorPixels = errorPixels;
    // Meshes without normals are faceted, and have normals now.
    if (!own.coarse.hasAttribute('normal') && geometry.hasAttribute('normal')) mesh.material = smooth(mesh.material);
  }
}
