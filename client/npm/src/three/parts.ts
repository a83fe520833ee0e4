// The meshes of a scene, each opened for refinement in workers.

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

/// Meshes that are refined as one, as they meet: those of a glTF mesh with several materials.
export interface Part {
  readonly meshes: readonly Mesh[];
  /// The geometries that they came with.
  readonly coarse: readonly BufferGeometry[];
}

/// What a part has become.
export interface RefinedPart {
  /// One for each mesh, the caller's own; with normals, whether the coarse ones have them or not.
  geometries: BufferGeometry[];
  statistics: Statistics;
}

export class Parts {
  readonly all: Part[] = [];
  /// Meshes that are not refined: moved by a skeleton, without triangles, or with several materials in one geometry.
  readonly unrefined: Mesh[] = [];
  readonly #refiner: Refiner;
  /// Opened once, however often the same geometries are in the scene.
  readonly #opened = new Map<string, { mesh: OpenMesh; arrays: Arrays }>();

  /// `scene`: as it was loaded; what its meshes show later is not looked at.
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

  /// Rejects with KernelError, or with the signal's reason.
  async refine(part: Part, query: string, options: RefineOptions = {}): Promise<RefinedPart> {
    const { mesh, arrays } = this.#open(part);
    const isAsked = arrays.hasNormals || /(^|&)output\.normals=/.test(query);
    const asked = isAsked ? query : `${query}&output.normals=true`;
    const refined = await this.#refiner.refine(mesh, asked, { ...options, singlePrecision: true });
    return { geometries: geometriesOf(refined.mesh, arrays, part.coarse), statistics: refined.statistics };
  }

  /// Frees what the workers keep.
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

/// For a mesh that has normals now: what is drawn in facets for want of them is smooth.
export function smooth<T extends Material | Material[]>(material: T): T {
  if (Array.isArray(material) || !(material as unknown as MeshStandardMaterial).flatShading) return material;
  const copy = material.clone() as MeshStandardMaterial; // others may be drawn with it
  copy.flatShading = false;
  return copy as unknown as T;
}
