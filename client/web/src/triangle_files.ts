// Formats of triangles only, which the package's readers read, in the page and in workers.

import { Problem } from 'papilio/client';
import { readTriangleFile, type TriangleFile, type TriangleFormat } from 'papilio/files';

import type { Surface } from './surface_samples';

/// Extensions of the formats.
export const triangleFormats: readonly string[] = ['.obj', '.ply', '.stl', '.off'];

/// Reads a file of one of these extensions. Rejects with a Problem.
export async function readFile(name: string, extension: string, bytes: ArrayBuffer): Promise<TriangleFile> {
  const format = extension.slice(1) as TriangleFormat;
  let file: TriangleFile;
  try {
    file = await readTriangleFile(format, new Uint8Array(bytes));
  } catch (error) {
    if (!(error instanceof Problem))
      throw new Problem('unreachable', 'The reader of files cannot be fetched.', { retryAfter: 2 });
    if (error.code !== 'mesh_unusable') throw new Problem(error.code, `${name}: ${error.message}`);
    const remedy = `export the mesh again, or check that its format is ${format}`;
    throw new Problem('damaged', `${name}: ${error.message}; ${remedy}.`);
  }
  if (!file.positions.every(Number.isFinite))
    throw new Problem('mesh_unusable', `${name} has positions that are no numbers.`);
  return file;
}

/// Returns a file's triangles with points of equal position merged: many formats repeat points in each triangle.
/// Triangles that then have less than three points are left out.
export function welded({ positions, triangles }: TriangleFile): Surface {
  const numbers = new Map<string, number>();
  const kept: number[] = [];
  const numberOf = Uint32Array.from({ length: positions.length / 3 }, (_, p) => {
    const point = positions.subarray(3 * p, 3 * p + 3);
    const at = point.join();
    let number = numbers.get(at);
    if (number === undefined) {
      numbers.set(at, (number = numbers.size));
      kept.push(...point);
    }
    return number;
  });
  const corners: number[] = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => numberOf[triangles[i + k]]);
    if (a !== b && b !== c && c !== a) corners.push(a, b, c);
  }
  return { positions: new Float32Array(kept), triangles: new Uint32Array(corners) };
}
