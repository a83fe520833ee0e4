// Base of a packed model: its primitives, decoded and joined.

import { Problem } from '../client.js';
import type { BaseTriangles, DecodedTriangles } from './decoder.js';
import type { PackedFile } from './packed_file.js';

type Base = PackedFile['base'];

/// Function that decodes the Draco stream of a primitive, by three.js's DRACOLoader or draco3d: positions, triangles,
/// and texture coordinates and colours if it has any, in the stream's order.
export type DracoDecoder = (draco: Uint8Array<ArrayBuffer>) => Promise<DecodedTriangles>;

/// Decodes the base for DetailDecoder. Rejects with Problem if it differs from the declaration, and with errors of
/// `decodeDraco`.
export async function decodeBase(base: Base, decodeDraco: DracoDecoder): Promise<BaseTriangles> {
  return joinPrimitives(base, await Promise.all(base.primitives.map(({ draco }) => decodeDraco(draco))));
}

/// Joins the primitives of a base in their order; several get part numbers. Throws Problem if they differ from the
/// declaration.
export function joinPrimitives(base: Base, decoded: readonly DecodedTriangles[]): BaseTriangles {
  for (const [p, primitive] of decoded.entries()) requireAsDeclared(primitive, base, p);
  if (decoded.length === 1) return decoded[0]!;
  const joined: BaseTriangles & { parts: Uint32Array<ArrayBuffer> } = {
    positions: new Float32Array(3 * base.vertices),
    triangles: new Uint32Array(3 * base.faces),
    parts: new Uint32Array(base.vertices),
    ...(base.hasTexcoords && { texcoords: new Float32Array(2 * base.vertices) }),
    ...(base.hasColours && { colours: new Uint8Array(3 * base.vertices) }),
  };
  let [points, corners] = [0, 0];
  for (const [p, { positions, triangles, texcoords, colours }] of decoded.entries()) {
    const { vertices, part } = base.primitives[p]!;
    joined.positions.set(positions, 3 * points);
    if (texcoords) joined.texcoords?.set(texcoords, 2 * points);
    if (colours) joined.colours?.set(colours, 3 * points);
    joined.parts.fill(part, points, points + vertices);
    for (const corner of triangles) joined.triangles[corners++] = points + corner;
    points += vertices;
  }
  return joined;
}

function requireAsDeclared(
  { positions, triangles, texcoords, colours }: DecodedTriangles,
  base: Base,
  p: number,
): void {
  const refuse = (what: string): never => {
    throw new Problem('mesh_not_gltf', `${what} Pack the model again.`);
  };
  const { vertices, faces } = base.primitives[p]!;
  if (positions.length !== 3 * vertices || triangles.length !== 3 * faces)
    refuse('The base declares other counts than its Draco stream has.');
  for (const [name, isThere, components, values] of [
    ['texture coordinates', base.hasTexcoords, 2, texcoords],
    ['colours', base.hasColours, 3, colours],
  ] as const)
    if ((values?.length ?? 0) !== (isThere ? components * vertices : 0))
      refuse(`The base declares ${isThere ? '' : 'no '}${name}, unlike its Draco stream.`);
}
