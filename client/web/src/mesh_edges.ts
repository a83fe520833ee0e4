// Edges of a mesh, for drawing as lines.

/// Returns the ends of each edge; `corners` [faces * 3] are vertices below `vertices`. An edge of two faces appears
/// once if they traverse it in opposite directions, as on an oriented surface; an edge between two boundary vertices
/// may appear twice. O(F), without a table of edges: inside a surface, each neighbour of a vertex is reached by one
/// outgoing and one incoming side, so that their marks cancel.
export function edgesOf(corners: ArrayLike<number>, vertices: number): Uint32Array<ArrayBuffer> {
  const marks = new Int32Array(vertices); // sums; 0 inside
  const whole = corners.length - (corners.length % 3);
  for (let i = 0; i < whole; i += 3) {
    const a = corners[i];
    const b = corners[i + 1];
    const c = corners[i + 2];
    const [ofA, ofB, ofC] = [markOf(a), markOf(b), markOf(c)];
    marks[a] += ofB - ofC;
    marks[b] += ofC - ofA;
    marks[c] += ofA - ofB;
  }
  const ends = new Uint32Array(2 * whole); // enough for all sides; unwritten pages take no memory
  let count = 0;
  for (let i = 0; i < whole; i += 3)
    for (let side = 0; side < 3; ++side) {
      const a = corners[i + side];
      const b = corners[side < 2 ? i + side + 1 : i];
      if (a > b && (marks[a] === 0 || marks[b] === 0)) continue;
      ends[count++] = a;
      ends[count++] = b;
    }
  return ends.subarray(0, count);
}

/// Returns a mark that is unique to the vertex and unrelated to its number, so that sums of different marks are not 0
/// by chance.
function markOf(vertex: number): number {
  const mixed = Math.imul(vertex + 1, 0x9e3779b1);
  return Math.imul(mixed ^ (mixed >>> 15), 0x85ebca6b);
}
