// What the page asks of the server.

import { type Bytes, type Encoded, kindOf, mediaTypes } from './model';
import { boundaryOf, partsOf } from '../../npm/src/multipart';
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
  encoded: Encoded;
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

export async function fetchSample(name: string): Promise<Encoded> {
  return encodedOf(await send(`v1/samples/${encodeURIComponent(name)}`));
}

export async function fetchStored(id: string): Promise<Encoded> {
  const headers = { Accept: `${mediaTypes.draco}, ${mediaTypes.scene}` };
  return encodedOf(await send(`v1/meshes/${encodeURIComponent(id)}`, { headers }));
}

/// Stores the mesh; resolves with its id.
export async function store({ kind, bytes }: Encoded): Promise<string> {
  const answer = await send('v1/meshes', {
    method: 'POST',
    headers: { 'Content-Type': mediaTypes[kind] },
    body: bytes,
  });
  return ((await answer.json()) as { id: string }).id;
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
  const headers = { Accept: kind === 'scene' ? mediaTypes.scene : 'multipart/mixed' };
  const answer = await send(
    id === null ? `v1/refine?${query}` : `v1/meshes/${id}/refined?${query}`,
    id === null
      ? { method: 'POST', headers: { ...headers, 'Content-Type': mediaTypes[kind] }, body: bytes, signal }
      : { headers, signal, cache: 'no-store' },
  );
  if (kind === 'scene') {
    onLevel(levelOf({ kind, bytes: await bytesOf(answer, signal) }, answer.headers));
    return summaryOf(answer.headers);
  }
  const boundary = boundaryOf(answer.headers.get('Content-Type') ?? '');
  if (boundary === null || answer.body === null) throw new Problem('unexpected', 'The answer is no stream of levels.');
  let summary: Summary | null = null;
  try {
    for await (const part of partsOf(answer.body, boundary)) {
      const type = part.headers.get('Content-Type');
      if (type === 'application/x-draco') {
        onLevel(levelOf({ kind, bytes: part.body }, part.headers));
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

function levelOf(encoded: Encoded, headers: Headers): Level {
  return {
    encoded,
    vertices: Number(headers.get('Papilio-Vertices')),
    faces: Number(headers.get('Papilio-Faces')),
    timing: timingOf(headers.get('Server-Timing') ?? ''),
  };
}

function summaryOf(headers: Headers): Summary {
  const pixels = headers.get('Papilio-Error-Pixels');
  return {
    stop_reason: headers.get('Papilio-Stop-Reason') ?? '',
    error: Number(headers.get('Papilio-Error')),
    error_pixels: pixels === null ? undefined : Number(pixels),
    unreached: headers.get('Papilio-Unreached') ?? undefined,
  };
}

function timingOf(text: string): Record<string, number> {
  const timing: Record<string, number> = {};
  for (const [, name, duration] of text.matchAll(/([\w-]+);dur=([\d.]+)/g)) timing[name] = Number(duration);
  return timing;
}

async function encodedOf(answer: Response): Promise<Encoded> {
  const kind = kindOf(answer.headers.get('Content-Type'));
  if (kind === null) throw new Problem('unexpected', 'The answer is no mesh.');
  return { kind, bytes: await bytesOf(answer) };
}

async function bytesOf(answer: Response, signal?: AbortSignal): Promise<Bytes> {
  try {
    return new Uint8Array(await answer.arrayBuffer());
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new Problem('unreachable', 'The connection was lost before the mesh was complete.', 2);
  }
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
