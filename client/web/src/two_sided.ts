// Distances between a surface and its original, in both directions.

import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';

import { type Samples, samplesOf, type Surface } from './surface_samples';

export type { Surface };

/// Distances in the unit of the positions.
export interface TwoSided {
  /// Root mean square over the area; the larger of both directions.
  rms: number;
  /// Largest of both directions, at vertices and samples.
  largest: number;
  /// Diagonal of the original's bounding box.
  diagonal: number;
  /// [faces of the surface] the largest distance found at each face.
  ofFaces: Float32Array<ArrayBuffer>;
}

/// Samples in each direction, as in `papilio compare`.
const sampleCount = 50_000;

/// Original prepared for comparison with surfaces.
export class MeasuredOriginal {
  readonly #side: Side;
  readonly #diagonal: number;

  constructor(surface: Surface) {
    this.#side = new Side(surface);
    this.#diagonal = diagonalOf(surface);
  }

  measure(surface: Surface): TwoSided {
    const side = new Side(surface);
    const { triangles } = surface;
    const ofFaces = new Float32Array(triangles.length / 3);
    const mark = (face: number, distance: number) => (ofFaces[face] = Math.max(ofFaces[face], distance));
    const there = oneWay(side, this.#side);
    const back = oneWay(this.#side, side);
    for (const [i, face] of side.samples.faces.entries()) mark(face, there.ofSamples[i]);
    for (let i = 0; i < triangles.length; ++i) mark(Math.floor(i / 3), there.ofVertices[triangles[i]]);
    for (const [i, face] of back.nearest.entries()) mark(face, back.ofSamples[i]);
    return {
      rms: Math.max(there.rms, back.rms),
      largest: Math.max(there.largest, back.largest),
      diagonal: this.#diagonal,
      ofFaces,
    };
  }
}

/// Surface, its search tree, and its points for the search on the other surface.
class Side {
  readonly surface: Surface;
  readonly tree: MeshBVH;
  readonly samples: Samples;

  constructor(surface: Surface) {
    this.surface = surface;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(surface.positions, 3));
    geometry.setIndex(new BufferAttribute(surface.triangles, 1));
    this.tree = new MeshBVH(geometry, { indirect: true }); // keeps the order of triangles
    this.samples = samplesOf(surface, sampleCount);
  }
}

interface OneWay {
  rms: number;
  largest: number;
  /// [points of `from`] 0 for points without faces.
  ofVertices: Float64Array;
  /// [samples of `from`]
  ofSamples: Float64Array;
  /// [samples of `from`] the nearest face of `to`.
  nearest: Uint32Array;
}

function oneWay(from: Side, to: Side): OneWay {
  const { surface, samples } = from;
  const point = new Vector3();
  const found = { point: new Vector3(), distance: 0, faceIndex: 0 };
  const distanceTo = (of: ArrayLike<number>, i: number) => {
    to.tree.closestPointToPoint(point.fromArray(of as number[], 3 * i), found);
    return found.distance;
  };
  const ofVertices = new Float64Array(surface.positions.length / 3);
  for (const v of usedIn(surface)) ofVertices[v] = distanceTo(surface.positions, v);
  const ofSamples = new Float64Array(samples.faces.length);
  const nearest = new Uint32Array(samples.faces.length);
  let squares = 0;
  for (let i = 0; i < ofSamples.length; ++i) {
    ofSamples[i] = distanceTo(samples.points, i);
    nearest[i] = found.faceIndex;
    squares += ofSamples[i] ** 2;
  }
  const largest = [ofVertices, ofSamples].map((all) => all.reduce((a, b) => Math.max(a, b), 0));
  return {
    rms: Math.sqrt(squares / Math.max(1, ofSamples.length)),
    largest: Math.max(...largest),
    ofVertices,
    ofSamples,
    nearest,
  };
}

/// Returns the vertices that have faces.
function usedIn({ positions, triangles }: Surface): Uint32Array {
  const isUsed = new Uint8Array(positions.length / 3);
  for (const v of triangles) isUsed[v] = 1;
  return Uint32Array.from(isUsed.keys()).filter((v) => isUsed[v] === 1);
}

function diagonalOf(surface: Surface): number {
  const { positions } = surface;
  const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
  const point = new Vector3();
  for (const v of usedIn(surface)) {
    point.fromArray(positions as unknown as number[], 3 * v);
    low.min(point);
    high.max(point);
  }
  return low.distanceTo(high);
}
