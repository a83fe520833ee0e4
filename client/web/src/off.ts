// Object File Format: positions and polygons as text.

import { BufferGeometry, Float32BufferAttribute } from 'three';

/// Reads a mesh; ignores colours and other numbers after a vertex or face. Throws an Error that states the fault.
export function readOff(text: string): BufferGeometry {
  const lines = text
    .replace(/^\uFEFF/, '')
    .split(/\r?\n/)
    .map((line) => line.replace(/#.*/, '').trim())
    .filter((line) => line !== '');
  const head = /^(?:ST|C|N)*OFF\b/.exec(lines[0] ?? '')?.[0];
  if (head === undefined) throw new Error('it does not begin with OFF.');
  const rest = lines[0].slice(head.length).trim();
  const rows = rest === '' ? lines.slice(1) : [rest, ...lines.slice(1)];
  const numbersIn = (row: string | undefined) => (row ?? '').split(/\s+/).map(Number);
  const [vertices, faces] = numbersIn(rows[0]);
  if (!Number.isInteger(vertices) || !Number.isInteger(faces) || rows.length < 1 + vertices + faces)
    throw new Error('it has fewer vertices and faces than it says.');
  const positions: number[] = [];
  for (const row of rows.slice(1, 1 + vertices)) positions.push(...numbersIn(row).slice(0, 3));
  if (positions.length !== 3 * vertices) throw new Error('a vertex has fewer than three coordinates.');
  const triangles: number[] = [];
  for (const row of rows.slice(1 + vertices, 1 + vertices + faces)) {
    const [count, ...corners] = numbersIn(row);
    const face = corners.slice(0, count);
    if (face.length !== count || face.some((v) => !(v >= 0 && v < vertices)))
      throw new Error('a face names a vertex that is not there.');
    for (let i = 2; i < count; ++i) triangles.push(face[0], face[i - 1], face[i]);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setIndex(triangles);
  return geometry;
}
