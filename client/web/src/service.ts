// What the page asks of the server, by the client of the npm package.

import { Client, type EncodedLevel, Problem, type Summary } from '../../npm/src/client';
import { type Encoded, kindOf, mediaTypes } from './model';
import type { ParameterKind } from './parameters';

export { Problem, type Summary };

export interface Sample {
  name: string;
  path: string;
  vertices: number;
  faces: number;
}

export interface Info {
  version: string;
  limits: Record<string, number>;
  parameters: ParameterKind[];
  samples: Sample[];
}

/// What came of one level.
export interface Level {
  encoded: Encoded;
  vertices: number;
  faces: number;
  /// Milliseconds by stage: decode, refine (all levels up to this one) and encode.
  timing: Record<string, number>;
}

/// The key that is sent with each request; empty: none.
let key = '';
const client = new Client({ key: () => key });

export function setKey(text: string): void {
  key = text;
}

export function hasKey(): boolean {
  return key !== '';
}

export async function fetchInfo(): Promise<Info> {
  return (await client.info()) as unknown as Info;
}

export async function fetchSample(name: string): Promise<Encoded> {
  return encodedOf(await client.sample(name));
}

export async function fetchStored(id: string): Promise<Encoded> {
  return encodedOf(await client.stored(id));
}

/// Stores the mesh; resolves with its id.
export async function store({ kind, bytes }: Encoded): Promise<string> {
  return (await client.store({ type: mediaTypes[kind], bytes })).id;
}

/// Refines a mesh or a scene: the stored one of this id, or where the server could not store it (null) the bytes. Calls
/// onLevel for each level of a mesh as it comes, the coarse mesh first; for a scene, whose levels would each bring its
/// images again, with the result alone. Rejects with a Problem, or with an AbortError once the signal says so.
export async function refine(
  { kind, bytes }: Encoded,
  id: string | null,
  query: string,
  onLevel: (level: Level) => void,
  signal: AbortSignal,
): Promise<Summary> {
  const mesh = { type: mediaTypes[kind], bytes };
  if (kind === 'scene') {
    const fine = await (id === null
      ? client.refine(mesh, query, { signal })
      : client.refineStored(id, query, { signal }));
    onLevel(levelOf(fine!));
    return fine!.summary;
  }
  const levels = id === null ? client.levels(mesh, query, { signal }) : client.levelsOfStored(id, query, { signal });
  for await (const level of levels) onLevel(levelOf(level));
  return levels.summary;
}

function levelOf(level: EncodedLevel): Level {
  const { vertices, faces, timing } = level;
  return { encoded: encodedOf(level), vertices, faces, timing };
}

function encodedOf({ type, bytes }: { type: string; bytes: Encoded['bytes'] }): Encoded {
  return { kind: kindOf(type)!, bytes };
}
