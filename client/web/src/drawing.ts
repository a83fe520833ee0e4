// What a panel draws of a mesh: shaded, with its edges, or each face in a colour of its own.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
} from 'three';

import type { Decoded } from './model';

/// A scene with its materials. A mesh has facets as they are; it is smooth where it has normals.
export function shaded({ geometry, scene }: Decoded): Object3D {
  if (scene !== null) return scene;
  return new Mesh(geometry, material({ color: 0xb9c6d2, flatShading: !geometry.hasAttribute('normal') }));
}

export function withEdges(decoded: Decoded): Object3D {
  const { geometry } = decoded;
  const corners = geometry.index!.array;
  const ends = new Uint32Array(2 * corners.length);
  for (let i = 0; i < corners.length; ++i) {
    ends[2 * i] = corners[i];
    ends[2 * i + 1] = corners[i % 3 === 2 ? i - 2 : i + 1];
  }
  const edges = new BufferGeometry();
  edges.setAttribute('position', geometry.getAttribute('position'));
  edges.setIndex(new BufferAttribute(ends, 1));
  return new Group().add(shaded(decoded), new LineSegments(edges, new LineBasicMaterial({ color: 0x16344f })));
}

/// `shares` [faces]: 0 to 1, each face's place on the ramp.
export function coloured(geometry: BufferGeometry, shares: ArrayLike<number>): Object3D {
  const position = geometry.getAttribute('position');
  const corners = geometry.index!.array;
  const positions = new Float32Array(3 * corners.length);
  const colours = new Float32Array(3 * corners.length);
  const colour = new Color();
  for (let i = 0; i < corners.length; ++i) {
    positions.set([position.getX(corners[i]), position.getY(corners[i]), position.getZ(corners[i])], 3 * i);
    if (i % 3 === 0) colour.set(rampColour(shares[i / 3]));
    colours.set([colour.r, colour.g, colour.b], 3 * i);
  }
  const faces = new BufferGeometry();
  faces.setAttribute('position', new BufferAttribute(positions, 3));
  faces.setAttribute('color', new BufferAttribute(colours, 3));
  return new Mesh(faces, material({ vertexColors: true, flatShading: true }));
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

function material(options: { color?: number; vertexColors?: boolean; flatShading: boolean }): MeshStandardMaterial {
  return new MeshStandardMaterial({
    ...options,
    roughness: 0.75,
    metalness: 0,
    side: DoubleSide,
    polygonOffset: true, // edges lie in front of the faces that they border
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}
