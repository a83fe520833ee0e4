// Formats that three's loaders read as triangles only, in the page and in workers.

import { type BufferGeometry, Mesh, type Object3D, Vector3 } from 'three';
import { Problem } from 'papilio/client';

import { readOff } from './off';
import type { Surface } from './surface_samples';

/// Extensions of the formats.
export const triangleFormats: readonly string[] = ['.obj', '.ply', '.stl', '.off'];

/// Reads all triangles of a file; points of equal position are one vertex. Rejects with a Problem.
export async function readTriangles(name: string, extension: string, bytes: ArrayBuffer): Promise<Surface> {
  let geometries: BufferGeometry[];
  try {
    geometries = await load(extension, bytes);
  } catch (error) {
    throw new Problem('damaged', `${name} cannot be read: ${error instanceof Error ? error.message : String(error)}`);
  }
  const surface = welded(geometries);
  if (surface.triangles.length === 0) throw new Problem('empty', `There are no triangles in ${name}.`);
  if (!surface.positions.every(Number.isFinite))
    throw new Problem('mesh_unusable', `${name} has positions that are no numbers.`);
  return surface;
}

async function load(extension: string, bytes: ArrayBuffer): Promise<BufferGeometry[]> {
  switch (extension) {
    case '.obj': {
      const { OBJLoader } = await import('three/examples/jsm/loaders/OBJLoader.js');
      return meshesIn(new OBJLoader().parse(new TextDecoder().decode(bytes)));
    }
    case '.ply': {
      const { PLYLoader } = await import('three/examples/jsm/loaders/PLYLoader.js');
      const head = new TextDecoder().decode(bytes.slice(0, 10_000));
      if (!/^element face [1-9]/m.test(head)) return []; // a point cloud
      return [new PLYLoader().parse(bytes)];
    }
    case '.off':
      return [readOff(new TextDecoder().decode(bytes))];
    default: {
      const { STLLoader } = await import('three/examples/jsm/loaders/STLLoader.js');
      return [new STLLoader().parse(bytes)];
    }
  }
}

/// Returns the meshes of a scene in world coordinates.
function meshesIn(scene: Object3D): BufferGeometry[] {
  scene.updateMatrixWorld(true);
  const found: BufferGeometry[] = [];
  scene.traverse((object) => {
    if (object instanceof Mesh)
      found.push((object.geometry as BufferGeometry).clone().applyMatrix4(object.matrixWorld));
  });
  return found;
}

/// Merges geometries, and points of equal position: many formats repeat points in each triangle.
function welded(geometries: BufferGeometry[]): Surface {
  const positions: number[] = [];
  const triangles: number[] = [];
  const numbers = new Map<string, number>();
  const point = new Vector3();
  for (const geometry of geometries) {
    const position = geometry.getAttribute('position');
    const vertices = new Uint32Array(position.count);
    for (let i = 0; i < position.count; ++i) {
      point.fromBufferAttribute(position, i);
      const [x, y, z] = [Math.fround(point.x), Math.fround(point.y), Math.fround(point.z)];
      const at = `${x},${y},${z}`;
      let vertex = numbers.get(at);
      if (vertex === undefined) {
        vertex = numbers.size;
        numbers.set(at, vertex);
        positions.push(x, y, z);
      }
      vertices[i] = vertex;
    }
    const corners = geometry.index?.count ?? position.count;
    for (let i = 0; i + 2 < corners; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => vertices[geometry.index?.getX(i + k) ?? i + k]);
      if (a !== b && b !== c && c !== a) triangles.push(a, b, c);
    }
  }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles) };
}
