// What the page asks of the server.

import { boundaryOf, partsOf } from './multipart';
import type { ParameterKind } from './parameters';

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

type Bytes = Uint8Array<ArrayBuffer>;

/// A refusal, in the server's words or in ours.
export class Problem extends Error {
  constructor(
    readonly code: string,
    message: string,
    /// Seconds after which to try again; null where that would not help.
    readonly retryAfter: number | null = null,
    /// The parameter at fault; null where none is.
    readonly parameter: string | null = null,
  ) {
    super(message);
  }
}

/// What came of one level.
export interface Level {
  draco: Bytes;
  vertices: number;
  faces: number;
  /// Milliseconds by stage: decode, refine (all levels up to this one) and encode.
  timing: Record<string, number>;
}

/// What the server says of the whole.
export interface Summary {
  stop_reason: string;
  error: number;
  error_pixels?: number;
  /// Targets that were not reached, in words.
  unreached?: string;
}

/// The key that is sent with each request; empty: none.
let key = '';

export function setKey(text: string): void {
  key = text;
}

export function hasKey(): boolean {
  return key !== '';
}

export async function fetchInfo(): Promise<Info> {
  return (await (await send('v1/info')).json()) as Info;
}

export async function fetchSample(name: string): Promise<Bytes> {
  return bytesOf(await send(`v1/samples/${encodeURIComponent(name)}`));
}

export async function fetchStored(id: string): Promise<Bytes> {
  return bytesOf(await send(`v1/meshes/${encodeURIComponent(id)}`, { headers: { Accept: 'application/x-draco' } }));
}

/// Stores the mesh; resolves with its id.
export async function store(draco: Bytes): Promise<string> {
  const answer = await send('v1/meshes', {
    method: 'POST',
    headers: { 'Content-Type': 'application/x-draco' },
    body: draco,
  });
  return ((await answer.json()) as { id: string }).id;
}

/// Refines a stored mesh (or, where the server could not store it, the bytes); calls onLevel for each level as it comes,
/// the coarse mesh first. Rejects with a Problem, or with an AbortError once the signal says so.
export async function refine(
  mesh: { id: string } | { draco: Bytes },
  query: string,
  onLevel: (level: Level) => void,
  signal: AbortSignal,
): Promise<Summary> {
  const headers = { Accept: 'multipart/mixed' };
  const answer = await send(
    'id' in mesh ? `v1/meshes/${mesh.id}/refined?${query}` : `v1/refine?${query}`,
    'id' in mesh
      ? { headers, signal, cache: 'no-store' }
      : { method: 'POST', headers: { ...headers, 'Content-Type': 'application/x-draco' }, body: mesh.draco, signal },
  );
  const boundary = boundaryOf(answer.headers.get('Content-Type') ?? '');
  if (boundary === null || answer.body === null) throw new Problem('unexpected', 'The answer is no stream of levels.');
  let summary: Summary | null = null;
  try {
    for await (const part of partsOf(answer.body, boundary)) {
      const type = part.headers.get('Content-Type');
      if (type === 'application/x-draco') {
        onLevel({
          draco: part.body,
          vertices: Number(part.headers.get('Papilio-Vertices')),
          faces: Number(part.headers.get('Papilio-Faces')),
          timing: timingOf(part.headers.get('Server-Timing') ?? ''),
        });
        continue;
      }
      const document: unknown = JSON.parse(new TextDecoder().decode(part.body));
      if (type === 'application/problem+json') throw toProblem(document, null);
      summary = document as Summary;
    }
  } catch (error) {
    if (signal.aborted || error instanceof Problem) throw error;
    throw new Problem('unreachable', 'The connection was lost before the mesh was complete.', 2);
  }
  if (summary === null) throw new Problem('unexpected', 'The answer ended without its summary.', 2);
  return summary;
}

function timingOf(text: string): Record<string, number> {
  const timing: Record<string, number> = {};
  for (const [, name, duration] of text.matchAll(/([\w-]+);dur=([\d.]+)/g)) timing[name] = Number(duration);
  return timing;
}

async function bytesOf(answer: Response): Promise<Bytes> {
  return new Uint8Array(await answer.arrayBuffer());
}

function toProblem(document: unknown, retryAfter: number | null): Problem {
  const { code, detail, title, parameter } = document as Record<string, string | undefined>;
  const words = detail ?? title ?? 'The server refuses, and does not say why.';
  return new Problem(code ?? 'unexpected', words, retryAfter, parameter ?? null);
}

async function send(path: string, request: RequestInit = {}): Promise<Response> {
  let answer: Response;
  try {
    const headers = new Headers(request.headers);
    if (key !== '') headers.set('Authorization', `Bearer ${key}`);
    answer = await fetch(path, { ...request, headers });
  } catch (error) {
    if (request.signal?.aborted) throw error;
    throw new Problem('unreachable', 'The server cannot be reached. Is it running?', 2);
  }
  if (answer.ok) return answer;
  const retryAfter = answer.headers.get('Retry-After');
  const document: unknown = await answer.json().catch(() => ({ detail: `The server answers ${answer.status}.` }));
  throw toProblem(document, retryAfter === null ? null : Number(retryAfter));
}
