// Requests to the server, through the client of the npm package.

import { Client, type EncodedLevel, type Levels, Problem, type Summary } from 'papilio/client';

import { type Encoded, kindOf } from './model';
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

/// Result of one level.
export interface Level {
  encoded: Encoded;
  vertices: number;
  faces: number;
  /// Milliseconds by stage: decode, refine (all levels up to this one) and encode.
  timing: Record<string, number>;
}

/// Key sent with each request; empty: none.
let key = '';
export const client = new Client({ key: () => key });

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

/// Calls `onLevel` for each level, and resolves with the summary.
export async function read(levels: Levels, onLevel: (level: Level) => void): Promise<Summary> {
  for await (const level of levels) onLevel(levelOf(level));
  return levels.summary;
}

export function levelOf(level: EncodedLevel): Level {
  const { vertices, faces, timing } = level;
  return { encoded: encodedOf(level), vertices, faces, timing };
}

function encodedOf({ type, bytes }: { type: string; bytes: Encoded['bytes'] }): Encoded {
  return { kind: kindOf(type)!, bytes };
}
