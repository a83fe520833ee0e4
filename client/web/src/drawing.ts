// Drawings of a mesh: shaded, with its edges, or with a colour for each face.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  type MeshStandardMaterialParameters,
  type Object3D,
  SkinnedMesh,
  Vector3,
  Vector4,
} from 'three';

import { measureBounds, positionsOf } from './bounds';
import { findEdges, foundEdges } from './edges';
import type { Decoded } from './model';
import { pause } from './pause';
import { isMesh } from './scene';

function material(options: MeshStandardMaterialParameters): MeshStandardMaterial {
  return new MeshStandardMaterial({
    ...options,
    roughness: 0.55,
    metalness: 0,
    side: DoubleSide,
    polygonOffset: true, // edges lie in front of the faces that they border
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

// Materials shared by all pictures: a new material has its shaders compiled again.
const smoothSurface = material({ color: 0xa9bccd, flatShading: false });
const facets = material({ color: 0xa9bccd, flatShading: true });
const colouredFacets = material({ vertexColors: true, flatShading: true, toneMapped: false });
const lines = new LineBasicMaterial({ color: 0x16344f, transparent: true });

/// Returns a small drawing of each material, whose shaders can be compiled before they are needed.
export function sampleDrawings(): Object3D[] {
  const geometry = new BufferGeometry();
  for (const name of ['position', 'normal', 'color'])
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(9), 3));
  const faces = [smoothSurface, facets, colouredFacets].map((one) => new Mesh(geometry, one));
  faces[2].userData.isColoured = true;
  return [...faces, new LineSegments(geometry, lines)];
}

/// Returns a scene with its materials, or a mesh: faceted, or smooth if it has normals.
export function shaded({ geometry, scene }: Decoded): Object3D {
  if (scene !== null) return scene;
  if (geometry.boundingSphere === null) measureBounds(geometry);
  return new Mesh(geometry, geometry.hasAttribute('normal') ? smoothSurface : facets);
}

/// Returns the shaded mesh with its edges, except those not found yet.
export function withEdges(decoded: Decoded): Object3D {
  const all = new Group().add(shaded(decoded));
  for (const edged of edgedIn(decoded)) {
    const edges = drawnEdges(edged);
    if (edges) all.add(edges);
  }
  return all;
}

/// Finds edges; once resolved, withEdges draws all of them.
export async function findEdgesOf(decoded: Decoded): Promise<void> {
  await Promise.all(edgedIn(decoded).map(({ geometry }) => findEdges(geometry)));
}

export function hasFoundEdges(decoded: Decoded): boolean {
  return edgedIn(decoded).every(({ geometry }) => foundEdges(geometry) !== null);
}

/// Geometry whose edges are drawn.
interface Edged {
  geometry: BufferGeometry;
  /// Mesh with its transformation and visibility; null: none.
  mesh: Mesh | null;
}

/// Returns the meshes of a scene if they are all of it; otherwise all triangles as one.
function edgedIn(decoded: Decoded): Edged[] {
  const meshes: Mesh[] = [];
  let isAll = decoded.scene !== null;
  decoded.scene?.traverse((object) => {
    if (isPlain(object)) meshes.push(object);
    else if (isMesh(object)) isAll = false;
  });
  if (!isAll) return [{ geometry: decoded.geometry, mesh: null }];
  return meshes.map((mesh) => ({ geometry: mesh.geometry as BufferGeometry, mesh }));
}

/// Returns whether an object is drawn as its geometry is.
function isPlain(object: Object3D): object is Mesh {
  if (!(object instanceof Mesh) || object instanceof SkinnedMesh || object instanceof InstancedMesh) return false;
  const geometry = object.geometry as BufferGeometry;
  return geometry.index !== null && Object.keys(geometry.morphAttributes).length === 0;
}

/// Returns the edges, fainter if they are close together in the picture, so that the surface stays visible; a scene's
/// edges are all as faint as the first ones drawn. Null while they are not found yet.
function drawnEdges({ geometry, mesh }: Edged): LineSegments | null {
  const ends = foundEdges(geometry);
  if (ends === null) return null;
  const edges = new BufferGeometry();
  edges.setAttribute('position', geometry.getAttribute('position'));
  edges.setIndex(new BufferAttribute(ends, 1));
  if (geometry.boundingSphere === null) measureBounds(geometry);
  edges.boundingSphere = geometry.boundingSphere;
  const made = new LineSegments(edges, lines);
  if (mesh !== null) {
    made.matrixAutoUpdate = false;
    made.matrix.copy(mesh.matrixWorld);
    Object.defineProperty(made, 'visible', { get: () => isShown(mesh) });
  }
  const length = medianLength(geometry.getAttribute('position'), ends);
  const centre = new Vector3();
  made.onBeforeRender = (renderer, _, camera) => {
    centre.copy(edges.boundingSphere!.center).applyMatrix4(made.matrixWorld).applyMatrix4(camera.matrixWorldInverse);
    const perspective = camera.projectionMatrix.elements[11] === 0 ? 1 : Math.max(-centre.z, 1e-30);
    const high = renderer.getCurrentViewport(new Vector4()).w;
    const scale = made.matrixWorld.getMaxScaleOnAxis();
    const pixels = (((scale * length) / perspective) * camera.projectionMatrix.elements[5] * high) / 2;
    lines.opacity = Math.min(1, Math.max(0.08, pixels / 12));
  };
  return made;
}

/// Returns whether an object and its ancestors are visible.
function isShown(object: Object3D | null): boolean {
  return object === null || (object.visible && isShown(object.parent));
}

/// Returns the median length of a few hundred edges.
function medianLength(
  position: { getX(i: number): number; getY(i: number): number; getZ(i: number): number },
  ends: Uint32Array,
): number {
  const lengths: number[] = [];
  const step = 2 * Math.ceil(ends.length / 1000);
  for (let i = 0; i + 1 < ends.length; i += step) {
    const [a, b] = [ends[i], ends[i + 1]];
    lengths.push(
      Math.hypot(
        position.getX(a) - position.getX(b),
        position.getY(a) - position.getY(b),
        position.getZ(a) - position.getZ(b),
      ),
    );
  }
  return lengths.sort((a, b) => a - b)[lengths.length >> 1] ?? 0;
}

/// Faces that are coloured between pauses: a few milliseconds.
const facesOfSlice = 1 << 15;

/// Returns the mesh with coloured faces, made in several tasks if it is large. `shareOf`: position of a face on the
/// ramp, 0 to 1.
export async function coloured(geometry: BufferGeometry, shareOf: (face: number) => number): Promise<Object3D> {
  const points = positionsOf(geometry);
  const corners = geometry.index!.array;
  const positions = new Float32Array(3 * corners.length);
  const colours = new Uint16Array(3 * corners.length);
  const table = Uint16Array.from(
    Array.from({ length: 256 }, (_, i) =>
      new Color(rampColour(i / 255)).toArray().map((x) => Math.round(65535 * x)),
    ).flat(),
  );
  for (let from = 0; from < corners.length; from += 3 * facesOfSlice) {
    if (from > 0) await pause();
    const end = Math.min(from + 3 * facesOfSlice, corners.length);
    putCorners(points, corners, positions, from, end);
    for (let face = from / 3, to = 3 * from; face < end / 3; ++face) {
      const colour = 3 * Math.round(255 * Math.min(Math.max(shareOf(face), 0), 1));
      for (let corner = 0; corner < 3; ++corner)
        for (let channel = 0; channel < 3; ++channel) colours[to++] = table[colour + channel];
    }
  }
  const faces = new BufferGeometry();
  faces.setAttribute('position', new BufferAttribute(positions, 3));
  faces.setAttribute('color', new BufferAttribute(colours, 3, true));
  if (geometry.boundingSphere === null) measureBounds(geometry);
  faces.boundingSphere = geometry.boundingSphere;
  const made = new Mesh(faces, colouredFacets);
  made.userData.isColoured = true;
  return made;
}

/// Writes the positions of these corners.
function putCorners(
  points: Float32Array,
  corners: ArrayLike<number>,
  positions: Float32Array,
  from: number,
  end: number,
): void {
  for (let i = from; i < end; ++i) {
    const point = 3 * corners[i];
    positions[3 * i] = points[point];
    positions[3 * i + 1] = points[point + 1];
    positions[3 * i + 2] = points[point + 2];
  }
}

// Dark blue through green to yellow, with even steps of lightness: readable without distinguishing hues.
const ramp = ['#3b4a8f', '#31688e', '#21908c', '#35b779', '#90d743', '#fde725'].map((text) => new Color(text));

/// Returns a colour of the ramp as #rrggbb.
export function rampColour(share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const below = Math.min(Math.floor(at), ramp.length - 2);
  return `#${ramp[below]
    .clone()
    .lerp(ramp[below + 1], at - below)
    .getHexString()}`;
}
