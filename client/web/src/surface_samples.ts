// Points spread evenly over a surface, as in `papilio compare`.

/// Indexed triangles: [points * 3], [faces * 3].
export interface Surface {
  positions: Float32Array;
  triangles: Uint32Array;
}

export interface Samples {
  /// [samples * 3]
  points: Float64Array;
  /// [samples] the face that contains each.
  faces: Uint32Array;
}

// Martin Roberts' R2 sequence (2018): steps 1/g and 1/g^2 with g^3 = g + 1.
const step = 0.7548776662466927;
const spread = (i: number, of: number) => (0.5 + i * of) % 1;

/// Returns `count` points, each for an equal share of the area; none if there is no area.
export function samplesOf(surface: Surface, count: number): Samples {
  const { triangles } = surface;
  const areas = new Float64Array(triangles.length / 3);
  let total = 0;
  for (let f = 0; f < areas.length; ++f) total += areas[f] = areaOf(surface, f);
  const samples = { points: new Float64Array(3 * count), faces: new Uint32Array(count) };
  let made = 0;
  let passed = 0;
  for (let f = 0; f < areas.length; ++f) {
    passed += areas[f];
    for (; made < count && ((made + 0.5) / count) * total < passed; ++made) {
      samples.faces[made] = f;
      putPoint(surface, f, made, samples.points);
    }
  }
  return { points: samples.points.subarray(0, 3 * made), faces: samples.faces.subarray(0, made) };
}

function areaOf({ positions, triangles }: Surface, face: number): number {
  const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * face + k]);
  const [ux, uy, uz] = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
  const [vx, vy, vz] = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
  return Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
}

/// Puts a point of the unit square, folded onto the triangle.
function putPoint({ positions, triangles }: Surface, face: number, sample: number, points: Float64Array): void {
  let [u, v] = [spread(sample, step), spread(sample, step * step)];
  if (u + v > 1) [u, v] = [1 - u, 1 - v];
  const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * face + k]);
  for (let k = 0; k < 3; ++k) {
    const from = positions[a + k];
    points[3 * sample + k] = from + u * (positions[b + k] - from) + v * (positions[c + k] - from);
  }
}
