// glTF scenes, decoded by three's loader.

import {
  BufferAttribute,
  BufferGeometry,
  type InstancedMesh,
  type Material,
  Matrix4,
  Mesh,
  type Object3D,
  type SkinnedMesh,
  type Texture,
  Vector3,
} from 'three';

import { fetchDecoder } from './draco';
import { requireWholeGlb } from './glb';
import type { Bytes, Decoded } from './model';
import { Problem } from './service';

const whitePixel =
  'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4//8/AAX+Av4N70a4AAAAAElFTkSuQmCC';

/// Decodes a scene. Rejects with a Problem unless the bytes are a scene of triangles.
export async function decodeScene(bytes: Bytes): Promise<Decoded> {
  requireWholeGlb(bytes);
  const [{ GLTFLoader }, { MeshoptDecoder }, draco] = await Promise.all([
    import('three/examples/jsm/loaders/GLTFLoader.js'),
    import('three/examples/jsm/libs/meshopt_decoder.module.js'),
    fetchDecoder(),
  ]);
  const loader = new GLTFLoader().setDRACOLoader(draco).setMeshoptDecoder(MeshoptDecoder);
  // Embedded files are blobs. External files are absent, and are replaced by white.
  const missing = new Set<string>();
  loader.manager.setURLModifier((url) => {
    if (/^(blob|data):/.test(url)) return url;
    missing.add(url);
    return whitePixel;
  });
  let scene: Object3D;
  try {
    scene = (await loader.parseAsync(bytes.slice().buffer, '')).scene;
  } catch (error) {
    throw new Problem('mesh_not_gltf', error instanceof Error ? error.message : String(error));
  }
  scene.userData.hasMaterials = true;
  scene.traverse((object) => {
    if (!isMesh(object)) return;
    for (const material of ([] as Material[]).concat(object.material)) {
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }); // edges lie in front
      for (const texture of texturesOf(material)) texture.anisotropy = 8; // sharp at oblique angles
    }
  });
  const decoded = decodedScene(scene);
  if (decoded.faces === 0) throw new Problem('mesh_unsupported', 'There are no triangles in this file.');
  decoded.missing.push(...missing);
  return decoded;
}

/// Returns the decoded scene; its triangles are merged on demand.
export function decodedScene(scene: Object3D): Decoded {
  scene.updateMatrixWorld(true);
  const geometries = new Set<BufferGeometry>();
  let faces = 0;
  scene.traverse((object) => {
    if (!isMesh(object)) return;
    geometries.add(object.geometry);
    faces += instancesOf(object) * facesOf(object.geometry);
  });
  let vertices = 0;
  for (const one of geometries) vertices += one.getAttribute('position').count;
  let merged: BufferGeometry | null = null;
  return {
    get geometry() {
      return (merged ??= mergedGeometry(scene));
    },
    scene,
    vertices,
    faces,
    missing: [],
    dispose: () => {
      merged?.dispose();
      disposeScene(scene);
    },
  };
}

export function isMesh(object: Object3D): object is Mesh {
  return object instanceof Mesh && (object.geometry as BufferGeometry).hasAttribute('position');
}

function instancesOf(mesh: Mesh): number {
  return (mesh as Partial<InstancedMesh>).isInstancedMesh === true ? (mesh as InstancedMesh).count : 1;
}

/// Numbers of faces; meshes share geometries.
const counted = new WeakMap<BufferGeometry, number>();

/// Returns the number of a geometry's triangles, without those of which two corners are at one position: refined meshes
/// do not have them either.
function facesOf(geometry: BufferGeometry): number {
  let faces = counted.get(geometry);
  if (faces !== undefined) return faces;
  const position = geometry.getAttribute('position');
  const cornerOf = (i: number) => geometry.index?.getX(i) ?? i;
  const areEqual = (a: number, b: number) =>
    a === b ||
    (position.getX(a) === position.getX(b) &&
      position.getY(a) === position.getY(b) &&
      position.getZ(a) === position.getZ(b));
  faces = 0;
  for (let i = 0; i + 2 < cornersOf(geometry); i += 3) {
    const [a, b, c] = [cornerOf(i), cornerOf(i + 1), cornerOf(i + 2)];
    if (!areEqual(a, b) && !areEqual(b, c) && !areEqual(c, a)) ++faces;
  }
  counted.set(geometry, faces);
  return faces;
}

function cornersOf(geometry: BufferGeometry): number {
  return geometry.index?.count ?? geometry.getAttribute('position').count;
}

/// Returns all triangles of a scene in world coordinates, skinned meshes in their current pose.
function mergedGeometry(scene: Object3D): BufferGeometry {
  const positions: number[] = [];
  const corners: number[] = [];
  const point = new Vector3();
  const add = (mesh: Mesh, matrix: Matrix4) => {
    const first = positions.length / 3;
    const position = mesh.geometry.getAttribute('position');
    for (let i = 0; i < position.count; ++i) {
      mesh.getVertexPosition(i, point).applyMatrix4(matrix); // applies morph targets and skin
      positions.push(point.x, point.y, point.z);
    }
    const count = cornersOf(mesh.geometry) - (cornersOf(mesh.geometry) % 3);
    for (let i = 0; i < count; ++i) corners.push(first + (mesh.geometry.index?.getX(i) ?? i));
  };
  scene.traverse((object) => {
    if (!isMesh(object)) return;
    if (!('isInstancedMesh' in object)) {
      add(object, object.matrixWorld);
      return;
    }
    const instances = object as InstancedMesh;
    for (let i = 0; i < instances.count; ++i) {
      const matrix = new Matrix4();
      instances.getMatrixAt(i, matrix);
      add(object, matrix.premultiply(object.matrixWorld));
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(corners), 1));
  return geometry;
}

function texturesOf(material: Material): Texture[] {
  const values = Object.values(material) as unknown[];
  return values.filter((value) => value !== null && typeof value === 'object' && 'isTexture' in value) as Texture[];
}

function disposeScene(scene: Object3D): void {
  scene.traverse((object) => {
    if (!isMesh(object)) return;
    object.geometry.dispose();
    (object as Partial<SkinnedMesh>).skeleton?.dispose();
    for (const material of ([] as Material[]).concat(object.material)) {
      for (const texture of texturesOf(material)) texture.dispose();
      material.dispose();
    }
  });
}
