// Files that the user drops or picks: a .drc mesh or a .glb scene as it is, a .gltf file with those that it names as a .glb,
// other formats by three's loaders as a Draco mesh of positions and triangles alone.

import { type BufferGeometry, Mesh, type Object3D, Vector3 } from 'three';

import { encode } from './draco';
import { packGlb } from './gltf_files';
import type { Encoded } from './model';
import { readOff } from './off';
import { Problem } from './service';

export const extensions = ['.drc', '.obj', '.ply', '.stl', '.off', '.glb', '.gltf'];

const extensionIn = (name: string) => /\.[^.]*$/.exec(name.toLowerCase())?.[0] ?? '';

/// The mesh among files that were dropped together: the others are what it names.
export function meshAmong(files: readonly File[]): File {
  return files.find(({ name }) => extensions.includes(extensionIn(name))) ?? files[0];
}

/// `files`: those that came with it, itself among them. Rejects with a Problem. `maxBytes`: of the service.
export async function readMeshFile(file: File, files: readonly File[], maxBytes: number): Promise<Encoded> {
  const extension = extensionIn(file.name);
  if (!extensions.includes(extension))
    throw new Problem('unsupported', `${file.name} is no mesh file. Open one of ${extensions.join(', ')}.`);
  if (file.size === 0) throw new Problem('empty', `${file.name} is empty.`);
  if (extension === '.gltf') return { kind: 'scene', bytes: await packGlb(file, files) };
  const kind = extension === '.drc' ? 'draco' : extension === '.glb' ? 'scene' : null;
  if (kind !== null && file.size > maxBytes)
    throw new Problem('body_too_large', `${file.name} has ${file.size} bytes; this server takes ${maxBytes}.`);
  const bytes = await file.arrayBuffer();
  if (kind !== null) return { kind, bytes: new Uint8Array(bytes) };
  let geometries: BufferGeometry[];
  try {
    geometries = await load(extension, bytes);
  } catch (error) {
    throw new Problem(
      'damaged',
      `${file.name} cannot be read: ${error instanceof Error ? error.message : String(error)}`,
    );
  }
  const { positions, triangles } = welded(geometries);
  if (triangles.length === 0) throw new Problem('empty', `There are no triangles in ${file.name}.`);
  if (!positions.every(Number.isFinite))
    throw new Problem('mesh_unusable', `${file.name} has positions that are no numbers.`);
  return { kind: 'draco', bytes: await encode({ positions, triangles }) };
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
      if (!/^element face [1-9]/m.test(head)) return []; // the points are no triangles
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

/// In world coordinates.
function meshesIn(scene: Object3D): BufferGeometry[] {
  scene.updateMatrixWorld(true);
  const found: BufferGeometry[] = [];
  scene.traverse((object) => {
    if (object instanceof Mesh)
      found.push((object.geometry as BufferGeometry).clone().applyMatrix4(object.matrixWorld));
  });
  return found;
}

/// All triangles as one mesh; points at the same place are one vertex, as many formats repeat them in each triangle.
function welded(geometries: BufferGeometry[]): { positions: Float32Array; triangles: Uint32Array } {
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
