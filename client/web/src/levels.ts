// Level in which each vertex first appears. All positions of a request lie on one grid, so that they stay
// bit-identical.

import type { BufferGeometry } from 'three';

export class LevelsOfVertices {
  #first = new Map<string, number>();

  /// Adds the next level; the coarse mesh comes first.
  add(mesh: BufferGeometry, level: number): void {
    const position = mesh.getAttribute('position');
    for (let v = 0; v < position.count; ++v) {
      const at = place(position, v);
      if (!this.#first.has(at)) this.#first.set(at, level);
    }
  }

  /// Returns [faces] the level of the newest of the three corners, which is the level of the face.
  ofFaces(mesh: BufferGeometry): Uint8Array {
    const position = mesh.getAttribute('position');
    const corners = mesh.index!.array;
    const ofVertices = new Uint8Array(position.count);
    for (let v = 0; v < position.count; ++v) ofVertices[v] = this.#first.get(place(position, v)) ?? 0;
    const ofFaces = new Uint8Array(corners.length / 3);
    for (let f = 0; f < ofFaces.length; ++f)
      ofFaces[f] = Math.max(ofVertices[corners[3 * f]], ofVertices[corners[3 * f + 1]], ofVertices[corners[3 * f + 2]]);
    return ofFaces;
  }
}

function place(position: { getX(i: number): number; getY(i: number): number; getZ(i: number): number }, v: number) {
  return `${position.getX(v)},${position.getY(v)},${position.getZ(v)}`;
}
