// papilio/client: typed calls of a papilio-server. Every path of its HTTP is here; errors are what its problem documents
// say.

import { queryOf, type Parameters } from './parameters.js';
import { boundaryOf, partsOf } from './multipart.js';

export type MediaType = 'application/x-draco' | 'model/gltf-binary';
export type Bytes = Uint8Array<ArrayBuffer>;

/// A mesh as Draco, or a scene as .glb.
export interface Encoded {
  type: MediaType;
  bytes: Bytes;
}

/// A mesh of one level, or a whole scene, and what the server says of it.
export interface EncodedLevel extends Encoded {
  level: number;
  vertices: number;
  faces: number;
  /// Milliseconds by stage: decode, refine (all levels up to this one) and encode.
  timing: Record<string, number>;
}

/// What the server says of the whole refinement.
export interface Summary {
  stop_reason: 'converged' | 'levels' | 'budget' | 'limits';
  /// Largest deviation left, as a share of the coarse mesh's diagonal.
  error: number;
  /// The same in pixels, where there is a view.
  error_pixels?: number;
  /// Targets that were not reached, and what to do, in words.
  unreached?: string;
  /// What the mesh was taken for, in words.
  shape?: string;
}

export interface Refined extends EncodedLevel {
  summary: Summary;
  /// Of a stored mesh's refinement: to ask with again.
  etag: string | null;
}

export interface StoredMesh {
  /// SHA-256 of the bytes, in hexadecimal.
  id: string;
  bytes: number;
  vertices: number;
  faces: number;
  /// Defects by name, and how many of each.
  found: Record<string, number>;
}

export interface Info {
  version: string;
  limits: Record<string, number>;
  schemes: string[];
  parameters: { name: string; type: string; description: string; [detail: string]: unknown }[];
  samples: { name: string; path: string; vertices: number; faces: number }[];
}

export interface Call {
  /// Gives up; the promise is rejected with the signal's reason.
  signal?: AbortSignal;
}

/// A refusal, in the server's words (RFC 9457), or why there is no answer (`unreachable`, `unexpected`).
export class Problem extends Error {
  override name = 'Problem';
  /// Of HTTP; 0 where there was no answer.
  readonly status: number;
  /// Seconds after which to try again; null where that would not help.
  readonly retryAfter: number | null;
  /// The parameter at fault; null where none is.
  readonly parameter: string | null;
  readonly requestId: string | null;

  /// `code`: stable, `mesh_too_large` for one; `message`: what is wrong and what to do.
  constructor(
    readonly code: string,
    message: string,
    details: Partial<Pick<Problem, 'status' | 'retryAfter' | 'parameter' | 'requestId'>> = {},
  ) {
    super(message);
    this.status = details.status ?? 0;
    this.retryAfter = details.retryAfter ?? null;
    this.parameter = details.parameter ?? null;
    this.requestId = details.requestId ?? null;
  }
}

export interface ClientOptions {
  /// Where the server is; left out: where the page is.
  base?: string | URL;
  /// The access key, or what gives it; left out: none.
  key?: string | (() => string);
}

/// The levels of a refinement, as they arrive: `for await (const level of levels)`. Read them once.
export class Levels implements AsyncIterable<EncodedLevel> {
  /// Comes after the last level.
  readonly summary: Promise<Summary>;
  readonly #levels: AsyncGenerator<EncodedLevel, Summary>;
  #settle!: { resolve: (summary: Summary) => void; reject: (reason: unknown) => void };

  constructor(levels: AsyncGenerator<EncodedLevel, Summary>) {
    this.#levels = levels;
    this.summary = new Promise((resolve, reject) => (this.#settle = { resolve, reject }));
    this.summary.catch(() => {}); // whoever reads the levels is told, too
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<EncodedLevel> {
    try {
      this.#settle.resolve(yield* this.#levels);
    } catch (error) {
      this.#settle.reject(error);
      throw error;
    }
  }
}

const anyMesh = 'application/x-draco, model/gltf-binary';

export class Client {
  readonly #base: string;
  readonly #key: () => string;

  constructor({ base = '', key = '' }: ClientOptions = {}) {
    this.#base = String(base).replace(/([^/])$/, '$1/');
    this.#key = typeof key === 'string' ? () => key : key;
  }

  async info(call: Call = {}): Promise<Info> {
    return (await this.#send('v1/info', {}, call)).json() as Promise<Info>;
  }

  /// The OpenAPI document.
  async openapi(call: Call = {}): Promise<Record<string, unknown>> {
    return (await this.#send('openapi.json', {}, call)).json() as Promise<Record<string, unknown>>;
  }

  /// Whether the server answers.
  async isAlive(call: Call = {}): Promise<boolean> {
    return this.#says('health', call);
  }

  /// Whether it takes work now.
  async isReady(call: Call = {}): Promise<boolean> {
    return this.#says('ready', call);
  }

  async sample(name: string, call: Call = {}): Promise<Encoded> {
    return encodedOf(await this.#send(`v1/samples/${encodeURIComponent(name)}`, {}, call), call);
  }

  /// Refines a mesh or a scene; the answer is of the same kind.
  async refine(mesh: Encoded, parameters: Parameters | string = {}, call: Call = {}): Promise<Refined> {
    const request = { method: 'POST', headers: { 'Content-Type': mesh.type, Accept: mesh.type }, body: mesh.bytes };
    return refinedOf(await this.#send(`v1/refine?${queryOf(parameters)}`, request, call), call);
  }

  /// The same, level by level, the coarse one first.
  levels(mesh: Encoded, parameters: Parameters | string = {}, call: Call = {}): Levels {
    const headers = { 'Content-Type': mesh.type, Accept: 'multipart/mixed' };
    const request = { method: 'POST', headers, body: mesh.bytes };
    return new Levels(levelsOf(this.#send(`v1/refine?${queryOf(parameters)}`, request, call), call));
  }

  /// Stores a mesh under its content; the same mesh has the same id.
  async store(mesh: Encoded, call: Call = {}): Promise<StoredMesh> {
    const request = { method: 'POST', headers: { 'Content-Type': mesh.type }, body: mesh.bytes };
    return (await this.#send('v1/meshes', request, call)).json() as Promise<StoredMesh>;
  }

  /// What is known of a stored mesh.
  async describe(id: string, call: Call = {}): Promise<StoredMesh> {
    const request = { headers: { Accept: 'application/json' } };
    return (await this.#send(pathOf(id), request, call)).json() as Promise<StoredMesh>;
  }

  /// The bytes that were stored.
  async stored(id: string, call: Call = {}): Promise<Encoded> {
    return encodedOf(await this.#send(pathOf(id), { headers: { Accept: anyMesh } }, call), call);
  }

  async delete(id: string, call: Call = {}): Promise<void> {
    await this.#send(pathOf(id), { method: 'DELETE' }, call);
  }

  /// Refines a stored mesh. `etag`: of an earlier answer; null comes back where that still holds.
  async refineStored(
    id: string,
    parameters: Parameters | string = {},
    { etag, ...call }: Call & { etag?: string } = {},
  ): Promise<Refined | null> {
    const headers: Record<string, string> = { Accept: anyMesh };
    if (etag !== undefined) headers['If-None-Match'] = etag;
    // Asked by hand, a 304 is handed over.
    const request: RequestInit = { headers, ...(etag !== undefined && { cache: 'no-store' }) };
    const answer = await this.#send(`${pathOf(id)}/refined?${queryOf(parameters)}`, request, call);
    return answer.status === 304 ? null : refinedOf(answer, call);
  }

  /// The same, level by level.
  levelsOfStored(id: string, parameters: Parameters | string = {}, call: Call = {}): Levels {
    const request: RequestInit = { headers: { Accept: 'multipart/mixed' }, cache: 'no-store' };
    return new Levels(levelsOf(this.#send(`${pathOf(id)}/refined?${queryOf(parameters)}`, request, call), call));
  }

  async #says(path: string, call: Call): Promise<boolean> {
    try {
      await this.#send(path, { cache: 'no-store' }, call);
      return true;
    } catch (error) {
      if (error instanceof Problem) return false;
      throw error;
    }
  }

  /// Rejects with a Problem, or with the signal's reason.
  async #send(path: string, request: RequestInit, { signal }: Call): Promise<Response> {
    const headers = new Headers(request.headers);
    const key = this.#key();
    if (key !== '') headers.set('Authorization', `Bearer ${key}`);
    const answer = await fetchPatiently(this.#base + path, { ...request, headers, ...(signal && { signal }) });
    if (answer.ok || answer.status === 304) return answer;
    const document: unknown = await answer.json().catch(() => ({ detail: `The server answers ${answer.status}.` }));
    const retryAfter = answer.headers.get('Retry-After');
    throw problemOf(document, answer.status, retryAfter === null ? null : Number(retryAfter));
  }
}

/// A mesh that is refined again and again: stored with the first refinement, so that later ones send parameters alone; where the server's store cannot take it, it
/// is sent each time.
export class RemoteMesh {
  #id: Promise<string | null> | null = null;

  constructor(
    readonly client: Client,
    readonly encoded: Encoded,
  ) {}

  /// Stores the mesh unless it is. Null where the server's store cannot take it. Rejects with a Problem where the server
  /// refuses the mesh, or cannot be asked now.
  get id(): Promise<string | null> {
    this.#id ??= this.client.store(this.encoded).then(
      ({ id }) => id,
      (error: unknown) => {
        if (error instanceof Problem && ['store_full', 'store_unavailable'].includes(error.code)) return null;
        this.#id = null; // the next time it is tried again
        throw error;
      },
    );
    return this.#id;
  }

  refine(parameters: Parameters | string, call: Call = {}): Promise<Refined> {
    return this.#asking(async (id) => {
      if (id === null) return this.client.refine(this.encoded, parameters, call);
      return (await this.client.refineStored(id, parameters, call))!; // null comes for an ETag alone
    }, call);
  }

  /// Hands over the levels as they come, and resolves with what `read` makes of them.
  levels<T>(parameters: Parameters | string, read: (levels: Levels) => Promise<T>, call: Call = {}): Promise<T> {
    return this.#asking((id) => {
      if (id === null) return read(this.client.levels(this.encoded, parameters, call));
      return read(this.client.levelsOfStored(id, parameters, call));
    }, call);
  }

  /// A mesh that the store has given up is stored again.
  async #asking<T>(work: (id: string | null) => Promise<T>, { signal }: Call): Promise<T> {
    for (let isAgain = false; ; isAgain = true) {
      const id = await this.id;
      signal?.throwIfAborted();
      try {
        return await work(id);
      } catch (error) {
        if (isAgain || !(error instanceof Problem) || error.code !== 'mesh_not_found') throw error;
        this.#id = null;
      }
    }
  }
}

/// Asks once more where there is no answer: a connection that was kept may have been closed meanwhile, and no call does
/// more when it is made twice.
async function fetchPatiently(url: string, request: RequestInit, isLast = false): Promise<Response> {
  try {
    return await fetch(url, request);
  } catch {
    if (request.signal?.aborted) throw request.signal.reason;
    if (isLast) throw new Problem('unreachable', 'The server cannot be reached. Is it running?', { retryAfter: 2 });
    return fetchPatiently(url, request, true);
  }
}

const pathOf = (id: string) => `v1/meshes/${encodeURIComponent(id)}`;

function problemOf(document: unknown, status: number, retryAfter: number | null): Problem {
  const { code, detail, title, parameter, request_id } = document as Record<string, string | undefined>;
  const words = detail ?? title ?? 'The server refuses, and does not say why.';
  return new Problem(code ?? 'unexpected', words, {
    status,
    retryAfter,
    parameter: parameter ?? null,
    requestId: request_id ?? null,
  });
}

const lost = () =>
  new Problem('unreachable', 'The connection was lost before the mesh was complete.', { retryAfter: 2 });

async function bytesOf(answer: Response, { signal }: Call): Promise<Bytes> {
  try {
    return new Uint8Array(await answer.arrayBuffer());
  } catch (error) {
    if (signal?.aborted) throw signal.reason;
    throw lost();
  }
}

async function encodedOf(answer: Response, call: Call): Promise<Encoded> {
  return { type: mediaTypeOf(answer.headers), bytes: await bytesOf(answer, call) };
}

function mediaTypeOf(headers: Headers): MediaType {
  const type = headers.get('Content-Type');
  if (type === 'application/x-draco' || type === 'model/gltf-binary') return type;
  throw new Problem('unexpected', 'The answer is no mesh.');
}

async function refinedOf(answer: Response, call: Call): Promise<Refined> {
  const { headers } = answer;
  const optional = (name: string) => headers.get(`Papilio-${name}`);
  const summary: Summary = {
    stop_reason: optional('Stop-Reason') as Summary['stop_reason'],
    error: Number(optional('Error')),
  };
  const [pixels, unreached, shape] = ['Error-Pixels', 'Unreached', 'Shape'].map(optional);
  if (pixels) summary.error_pixels = Number(pixels);
  if (unreached) summary.unreached = unreached;
  if (shape) summary.shape = shape;
  return { ...levelOf(headers, await bytesOf(answer, call)), summary, etag: headers.get('ETag') };
}

function levelOf(headers: Headers, bytes: Bytes): EncodedLevel {
  const timing: Record<string, number> = {};
  for (const [, name, duration] of (headers.get('Server-Timing') ?? '').matchAll(/([\w-]+);dur=([\d.]+)/g))
    timing[name!] = Number(duration);
  const [level, vertices, faces] = ['Levels', 'Vertices', 'Faces'].map((name) =>
    Number(headers.get(`Papilio-${name}`)),
  );
  return { type: mediaTypeOf(headers), bytes, level: level!, vertices: vertices!, faces: faces!, timing };
}

async function* levelsOf(sent: Promise<Response>, { signal }: Call): AsyncGenerator<EncodedLevel, Summary> {
  const answer = await sent;
  const boundary = boundaryOf(answer.headers.get('Content-Type') ?? '');
  if (boundary === null || answer.body === null) throw new Problem('unexpected', 'The answer is no stream of levels.');
  let summary: Summary | null = null;
  const parts = partsOf(answer.body, boundary);
  for (;;) {
    let next: IteratorResult<{ headers: Headers; body: Bytes }>;
    try {
      next = await parts.next();
    } catch (error) {
      if (signal?.aborted) throw signal.reason;
      throw lost();
    }
    if (next.done) break;
    const { headers, body } = next.value;
    if (headers.get('Content-Type')?.endsWith('json')) {
      const document: unknown = JSON.parse(new TextDecoder().decode(body));
      if (headers.get('Content-Type') === 'application/problem+json') throw problemOf(document, answer.status, null);
      summary = document as Summary;
    } else {
      yield levelOf(headers, body);
    }
  }
  if (summary === null) throw new Problem('unexpected', 'The answer ended without its summary.', { retryAfter: 2 });
  return summary;
}
