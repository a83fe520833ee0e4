// What a panel draws of a mesh: shaded, with its edges, or each face in a colour of its own.

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

import { edgesOf } from './mesh_edges';
import type { Decoded } from './model';

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

// Each is for all pictures: a material that comes and goes has its shaders compiled again each time.
const smoothSurface = material({ color: 0xa9bccd, flatShading: false });
const facets = material({ color: 0xa9bccd, flatShading: true });
const colouredFacets = material({ vertexColors: true, flatShading: true, toneMapped: false });
const lines = new LineBasicMaterial({ color: 0x16344f, transparent: true });

/// A scene with its materials. A mesh has facets as they are; it is smooth where it has normals.
export function shaded({ geometry, scene }: Decoded): Object3D {
  if (scene !== null) return scene;
  return new Mesh(geometry, geometry.hasAttribute('normal') ? smoothSurface : facets);
}

export function withEdges(decoded: Decoded): Object3D {
  const all = new Group().add(shaded(decoded));
  const { scene } = decoded;
  const meshes: Mesh[] = [];
  scene?.traverse((object) => isPlain(object) && meshes.push(object));
  const isPlainScene =
    scene !== null && meshes.reduce((sum, { geometry }) => sum + facesOf(geometry), 0) === decoded.faces;
  if (!isPlainScene) return all.add(drawnEdges(decoded.geometry));
  for (const mesh of meshes) {
    const edges = drawnEdges(mesh.geometry);
    edges.matrixAutoUpdate = false;
    edges.matrix.copy(mesh.matrixWorld);
    all.add(edges);
  }
  return all;
}

/// Whether it is drawn as its geometry is.
function isPlain(object: Object3D): object is Mesh {
  if (!(object instanceof Mesh) || object instanceof SkinnedMesh || object instanceof InstancedMesh) return false;
  const geometry = object.geometry as BufferGeometry;
  return geometry.index !== null && Object.keys(geometry.morphAttributes).length === 0;
}

const facesOf = (geometry: BufferGeometry) => Math.floor(geometry.index!.count / 3);

/// Fainter where they are close to each other in the picture, so that the surface is seen through them: those of a scene
/// as the first that is drawn.
function drawnEdges(geometry: BufferGeometry): LineSegments {
  const ends = edgesOf(geometry.index!.array, geometry.getAttribute('position').count);
  const edges = new BufferGeometry();
  edges.setAttribute('position', geometry.getAttribute('position'));
  edges.setIndex(new BufferAttribute(ends, 1));
  edges.boundingSphere = geometry.boundingSphere;
  const made = new LineSegments(edges, lines);
  const length = medianLength(geometry.getAttribute('position'), ends);
  const centre = new Vector3();
  made.onBeforeRender = (renderer, _, camera) => {
    if (edges.boundingSphere === null) edges.computeBoundingSphere();
    centre.copy(edges.boundingSphere!.center).applyMatrix4(made.matrixWorld).applyMatrix4(camera.matrixWorldInverse);
    const perspective = camera.projectionMatrix.elements[11] === 0 ? 1 : Math.max(-centre.z, 1e-30);
    const high = renderer.getCurrentViewport(new Vector4()).w;
    const scale = made.matrixWorld.getMaxScaleOnAxis();
    const pixels = (((scale * length) / perspective) * camera.projectionMatrix.elements[5] * high) / 2;
    lines.opacity = Math.min(1, Math.max(0.08, pixels / 12));
  };
  return made;
}

/// Of a few hundred edges.
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

/// `shares` [faces]: 0 to 1, each face's place on the ramp.
export function coloured(geometry: BufferGeometry, shares: ArrayLike<number>): Object3D {
  const position = geometry.getAttribute('position');
  const corners = geometry.index!.array;
  const positions = new Float32Array(3 * corners.length);
  const colours = new Float32Array(3 * corners.length);
  const table = Array.from({ length: 256 }, (_, i) => new Color(rampColour(i / 255)));
  for (let i = 0, to = 0; i < corners.length; ++i, to += 3) {
    const { r, g, b } = table[Math.round(255 * Math.min(Math.max(shares[Math.floor(i / 3)], 0), 1))];
    colours[to] = r;
    colours[to + 1] = g;
    colours[to + 2] = b;
    positions[to] = position.getX(corners[i]);
    positions[to + 1] = position.getY(corners[i]);
    positions[to + 2] = position.getZ(corners[i]);
  }
  const faces = new BufferGeometry();
  faces.setAttribute('position', new BufferAttribute(positions, 3));
  faces.setAttribute('color', new BufferAttribute(colours, 3));
  const made = new Mesh(faces, colouredFacets);
  made.userData.isColoured = true;
  return made;
}

// From dark blue by green to yellow, even in lightness, so that it is read without telling hues apart.
const ramp = ['#3b4a8f', '#31688e', '#21908c', '#35b779', '#90d743', '#fde725'].map((text) => new Color(text));

/// As #rrggbb.
export function rampColour(share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const below = Math.min(Math.floor(at), ramp.length - 2);
  return `#${ramp[below]
    .clone()
    .lerp(ramp[below + 1], at - below)
    .getHexString()}`;
}
