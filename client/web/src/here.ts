// Refinement in this browser, by the kernel of the npm package.

import { isInstanced, Parts, smooth, viewOf } from 'papilio/three';
import { KernelError, queryOf, Refiner } from 'papilio/wasm';
import { type Camera, Mesh, MeshStandardMaterial, type Object3D } from 'three';

import type { Decoded } from './model';
import type { Values } from './parameters';
import { decodedScene } from './scene';
import { Problem, type Summary } from './service';

/// Result of a refinement.
export interface Made {
  decoded: Decoded;
  summary: Summary;
  milliseconds: number;
}

let refiner: Promise<Refiner> | null = null;

function theRefiner(): Promise<Refiner> {
  const workers = Math.min(4, Math.max(1, (navigator.hardwareConcurrency ?? 2) - 1));
  refiner ??= Refiner.start({ workers });
  refiner.catch(() => (refiner = null)); // for the next attempt
  return refiner;
}

/// Parameters of the camera, which each mesh of a scene has in its own coordinates.
const places = ['eye', 'target', 'up', 'fov_y', 'viewport', 'projection', 'near'].map((name) => `view.${name}`);

export class Here {
  readonly #parts: Parts;
  readonly #decoded: Decoded;

  private constructor(decoded: Decoded, parts: Parts) {
    this.#decoded = decoded;
    this.#parts = parts;
  }

  /// Opens a mesh or scene; null if parts of it need the server: skinned meshes, or many instances.
  static async of(decoded: Decoded): Promise<Here | null> {
    const root = decoded.scene ?? new Mesh(decoded.geometry, new MeshStandardMaterial());
    root.updateMatrixWorld(true);
    const parts = new Parts(root, await theRefiner());
    if (parts.unrefined.length === 0 && !parts.all.some(({ meshes }) => meshes.some(isInstanced)))
      return new Here(decoded, parts);
    parts.dispose();
    return null;
  }

  /// Returns whether the kernel supports the parameters. In a scene of several meshes, a budget of faces and a near
  /// plane apply to all meshes together.
  does(values: Values): boolean {
    return this.#parts.all.length === 1 || !['max_faces', 'view.near'].some((name) => values.has(name));
  }

  /// Refines for a camera and a picture's width and height. Rejects with KernelError, or with the signal's reason.
  async refine(values: Values, camera: Camera, pixels: [number, number], signal: AbortSignal): Promise<Made> {
    const began = performance.now();
    const rest = [...values].filter(([name]) => !places.includes(name) && !name.startsWith('output.'));
    const given = rest.map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join('&');
    const near = values.get('view.near');
    const refined = await Promise.all(
      this.#parts.all.map((part) => {
        const view = { ...viewOf(part.meshes[0], camera, pixels), ...(near !== undefined && { near }) };
        return this.#parts.refine(part, `${given}&${queryOf({ view } as never)}`, { signal });
      }),
    );
    const { scene } = this.#decoded;
    const meshes = this.#parts.all.flatMap((part) => part.meshes);
    const geometries = refined.flatMap((part) => part.geometries);
    const all = refined.map((part) => part.statistics);
    const decoded =
      scene === null ? decodedMesh(geometries[0]) : decodedScene(withGeometries(scene, meshes, geometries));
    decoded.dispose = () => geometries.forEach((geometry) => geometry.dispose());
    const most = (of: (one: (typeof all)[number]) => number) => Math.max(...all.map(of));
    const sum = (of: (one: (typeof all)[number]) => number) => all.reduce((total, one) => total + of(one), 0);
    const mechanical = sum((one) => one.mechanical);
    const last = all.find(({ stopReason }) => stopReason !== 'converged') ?? all[0];
    const summary: Summary = {
      stop_reason: last.stopReason,
      error: most((one) => one.error),
      error_pixels: most((one) => one.errorPixels),
      shape: mechanical === 0 ? 'organic' : `mechanical: ${mechanical} of ${sum((one) => one.components)} components`,
    };
    const wanted = Number(values.get('view.error_pixels') ?? Infinity);
    if (summary.error_pixels! > wanted)
      summary.unreached = `view.error_pixels=${wanted} is not reached: up to ${summary.error_pixels!.toPrecision(2)} pixels are left.`;
    return { decoded, summary, milliseconds: performance.now() - began };
  }

  dispose(): void {
    this.#parts.dispose();
  }
}

/// Returns the problem in the page's words; null if the server can refine where this browser failed.
export function problemOf(error: unknown): Problem | null {
  if (!(error instanceof KernelError)) return new Problem('unexpected', String(error));
  if (error.fault !== 'bad-parameter') return null;
  return new Problem('bad_parameter', error.message, { parameter: error.parameter || null });
}

function decodedMesh(geometry: Decoded['geometry']): Decoded {
  return {
    geometry,
    scene: null,
    vertices: geometry.getAttribute('position').count,
    faces: geometry.index!.count / 3,
    missing: [],
    dispose: () => {},
  };
}

/// Returns a copy of the scene with other geometries for these meshes; it shares materials and textures.
function withGeometries(scene: Object3D, meshes: Mesh[], geometries: Mesh['geometry'][]): Object3D {
  const own: Object3D[] = [];
  const copies: Object3D[] = [];
  const copy = scene.clone(true);
  scene.traverse((object) => own.push(object));
  copy.traverse((object) => copies.push(object));
  const at = new Map(own.map((object, i) => [object, copies[i]]));
  for (const [i, mesh] of meshes.entries()) {
    const copied = at.get(mesh) as Mesh;
    copied.geometry = geometries[i];
    if (!mesh.geometry.hasAttribute('normal')) copied.material = smooth(copied.material);
  }
  return copy;
}
