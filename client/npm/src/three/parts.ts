// Meshes of a scene, opened for refinement in workers.

import {
  type BufferGeometry,
  type InstancedMesh,
  type Material,
  Mesh,
  type MeshStandardMaterial,
  type Object3D,
  type SkinnedMesh,
} from 'three';

import type { Statistics } from '../kernel.js';
import type { OpenMesh, RefineOptions, Refiner } from '../refiner.js';
import { type Arrays, arraysOf, geometriesOf, hasNormals, isRefinable } from './arrays.js';

/// Adjoining meshes that are refined as one: those of a glTF mesh with several materials.
export interface Part {
  readonly meshes: readonly Mesh[];
  /// Geometries as loaded.
  readonly coarse: readonly BufferGeometry[];
}

/// Result of refining a part.
export interface RefinedPart {
  /// Geometries, one for each mesh, owned by the caller; always with normals.
  geometries: BufferGeometry[];
  statistics: Statistics;
}

export class Parts {
  readonly all: Part[] = [];
  /// Meshes that are not refined: skinned, without triangles, or with several materials in one geometry.
  readonly unrefined: Mesh[] = [];
  readonly #refiner: Refiner;
  /// Open meshes: one for each set of geometries, even if it is in the scene repeatedly.
  readonly #opened = new Map<string, { mesh: OpenMesh; arrays: Arrays }>();

  /// `scene`: scene as loaded; later geometries of its meshes are ignored.
  constructor(scene: Object3D, refiner: Refiner) {
    this.#refiner = refiner;
    const together = new Map<string, Mesh[]>();
    scene.traverse((object) => {
      if (!(object instanceof Mesh)) return;
      const mesh = object as Mesh;
      if ((mesh as Partial<SkinnedMesh>).isSkinnedMesh || !isRefinable(mesh.geometry)) {
        this.unrefined.push(mesh);
        return;
      }
      mesh.updateMatrix();
      const place = `${mesh.parent?.uuid ?? ''} ${mesh.matrix.elements.join()} ${hasNormals(mesh.geometry)}`;
      const key = isInstanced(mesh) ? mesh.uuid : place;
      together.set(key, [...(together.get(key) ?? []), mesh]);
    });
    for (const meshes of together.values())
      this.all.push({ meshes, coarse: meshes.map((mesh) => mesh.geometry as BufferGeometry) });
  }

  /// Refines a part. Rejects with KernelError, or with the signal's reason.
  async refine(part: Part, query: string, options: RefineOptions = {}): Promise<RefinedPart> {
    const { mesh, arrays } = this.#open(part);
    const isAsked = arrays.hasNormals || /(^|&)output\.normals=/.test(query);
    const asked = isAsked ? query : `${query}&output.normals=true`;
    const refined = await this.#refiner.refine(mesh, asked, { ...options, singlePrecision: true });
    return { geometries: geometriesOf(refined.mesh, arrays, part.coarse), statistics: refined.statistics };
  }

  /// Frees the data kept by the workers.
  dispose(): void {
    for (const { mesh } of this.#opened.values()) this.#refiner.forget(mesh);
    this.#opened.clear();
  }

  #open({ coarse }: Part): { mesh: OpenMesh; arrays: Arrays } {
    const key = coarse.map(({ uuid }) => uuid).join();
    let opened = this.#opened.get(key);
    if (opened === undefined) {
      const arrays = arraysOf(coarse);
      opened = { mesh: this.#refiner.open(arrays.triangles), arrays };
      this.#opened.set(key, opened);
    }
    return opened;
  }
}

export function isInstanced(mesh: Mesh): boolean {
  return (mesh as Partial<InstancedMesh>).isInstancedMesh === true;
}

/// Sets smooth shading for a mesh that was faceted without normals, and has normals now.
export function smooth<T extends Material | Material[]>(material: T): T {
  if (Array.isArray(material) || !(material as unknown as MeshStandardMaterial).flatShading) return material;
  const copy = material.clone() as MeshStandardMaterial; // other meshes may share it
  copy.flatShading = false;
  return copy as unknown as T;
}
