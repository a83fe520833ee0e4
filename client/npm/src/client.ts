// papilio/client: typed calls of a papilio-server, one for each path of its HTTP. Errors carry its problem documents.

import { queryOf, type Parameters } from './parameters.js';
import { boundaryOf, partsOf } from './multipart.js';

export type MediaType = 'application/x-draco' | 'model/gltf-binary';
export type Bytes = Uint8Array<ArrayBuffer>;

/// Mesh as Draco, or scene as .glb.
export interface Encoded {
  type: MediaType;
  bytes: Bytes;
}

/// Mesh of one level, or whole scene, with its statistics.
export interface EncodedLevel extends Encoded {
  level: number;
  vertices: number;
  faces: number;
  /// Milliseconds by stage: decode, refine (all levels up to this one) and encode.
  timing: Record<string, number>;
}

/// Statistics of a whole refinement.
export interface Summary {
  stop_reason: 'converged' | 'levels' | 'budget' | 'limits';
  /// Largest deviation left, as a share of the coarse mesh's diagonal.
  error: number;
  /// Largest deviation left in pixels, with a view.
  error_pixels?: number;
  /// Description of targets that were not reached, and the remedy.
  unreached?: string;
  /// Description of the shapes found on the mesh.
  shape?: string;
}

export interface Refined extends EncodedLevel {
  summary: Summary;
  /// Entity tag of a stored mesh's refinement, for a later conditional request.
  etag: string | null;
}

export interface StoredMesh {
  /// SHA-256 of the bytes, in hexadecimal.
  id: string;
  bytes: number;
  vertices: number;
  faces: number;
  /// Number of defects by name.
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
  /// Signal that aborts the call; the promise is rejected with its reason.
  signal?: AbortSignal;
}

/// Refusal by the server (RFC 9457), or the cause of a missing answer (`unreachable`, `unexpected`).
export class Problem extends Error {
  override name = 'Problem';
  /// HTTP status; 0 without an answer.
  readonly status: number;
  /// Seconds after which to retry; null if that would not help.
  readonly retryAfter: number | null;
  /// Parameter at fault, or null.
  readonly parameter: string | null;
  readonly requestId: string | null;

  /// `code`: stable code, such as `mesh_too_large`. `message`: the problem and its remedy.
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
  /// URL of the server; default: the origin of the page.
  base?: string | URL;
  /// Access key, or a function that returns it; default: none.
  key?: string | (() => string);
}

/// Levels of a refinement as they arrive: `for await (const level of levels)`. They can be read once.
export class Levels implements AsyncIterable<EncodedLevel> {
  /// Summary, resolved after the last level.
  readonly summary: Promise<Summary>;
  readonly #levels: AsyncGenerator<EncodedLevel, Summary>;
  #settle!: { resolve: (summary: Summary) => void; reject: (reason: unknown) => void };

  constructor(levels: AsyncGenerator<EncodedLevel, Summary>) {
    this.#levels = levels;
    this.summary = new Promise((resolve, reject) => (this.#settle = { resolve, reject }));
    this.summary.catch(() => {}); // the reader of the levels gets the error, too
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

  /// Returns the OpenAPI document.
  async openapi(call: Call = {}): Promise<Record<string, unknown>> {
    return (await this.#send('openapi.json', {}, call)).json() as Promise<Record<string, unknown>>;
  }

  /// Returns whether the server answers.
  async isAlive(call: Call = {}): Promise<boolean> {
    return this.#says('health', call);
  }

  /// Returns whether the server accepts work now.
  async isReady(call: Call = {}): Promise<boolean> {
    return this.#says('ready', call);
  }

  async sample(name: string, call: Call = {}): Promise<Encoded> {
    return encodedOf(await this.#send(`v1/samples/${encodeURIComponent(name)}`, {}, call), call);
  }

  /// Refines a mesh or a scene, and returns one of its kind.
  async refine(mesh: Encoded, parameters: Parameters | string = {}, call: Call = {}): Promise<Refined> {
    const request = { method: 'POST', headers: { 'Content-Type': mesh.type, Accept: mesh.type }, body: mesh.bytes };
    return refinedOf(await this.#send(`v1/refine?${queryOf(parameters)}`, request, call), call);
  }

  /// Refines a mesh or a scene level by level, the coarse one first.
  levels(mesh: Encoded, parameters: Parameters | string = {}, call: Call = {}): Levels {
    const headers = { 'Content-Type': mesh.type, Accept: 'multipart/mixed' };
    const request = { method: 'POST', headers, body: mesh.bytes };
    return new Levels(levelsOf(this.#send(`v1/refine?${queryOf(parameters)}`, request, call), call));
  }

  /// Stores a mesh under its SHA-256; equal meshes have equal ids.
  async store(mesh: Encoded, call: Call = {}): Promise<StoredMesh> {
    const request = { method: 'POST', headers: { 'Content-Type': mesh.type }, body: mesh.bytes };
    return (await this.#send('v1/meshes', request, call)).json() as Promise<StoredMesh>;
  }

  /// Returns the description of a stored mesh.
  async describe(id: string, call: Call = {}): Promise<StoredMesh> {
    const request = { headers: { Accept: 'application/json' } };
    return (await this.#send(pathOf(id), request, call)).json() as Promise<StoredMesh>;
  }

  /// Returns the stored bytes.
  async stored(id: string, call: Call = {}): Promise<Encoded> {
    return encodedOf(await this.#send(pathOf(id), { headers: { Accept: anyMesh } }, call), call);
  }

  async delete(id: string, call: Call = {}): Promise<void> {
    await this.#send(pathOf(id), { method: 'DELETE' }, call);
  }

  /// Refines a stored mesh. `etag`: entity tag of an earlier answer; returns null if that is still valid.
  async refineStored(
    id: string,
    parameters: Parameters | string = {},
    { etag, ...call }: Call & { etag?: string } = {},
  ): Promise<Refined | null> {
    const headers: Record<string, string> = { Accept: anyMesh };
    if (etag !== undefined) headers['If-None-Match'] = etag;
    // With `no-store`, a 304 is passed on.
    const request: RequestInit = { headers, ...(etag !== undefined && { cache: 'no-store' }) };
    const answer = await this.#send(`${pathOf(id)}/refined?${queryOf(parameters)}`, request, call);
    return answer.status === 304 ? null : refinedOf(answer, call);
  }

  /// Refines a stored mesh level by level.
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

  /// Sends a request. Rejects with a Problem, or with the signal's reason.
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

/// Mesh to be refined repeatedly: it is stored with the first refinement, so that later ones send only parameters. If
/// the server's store cannot take it, it is sent each time.
export class RemoteMesh {
  #id: Promise<string | null> | null = null;

  constructor(
    readonly client: Client,
    readonly encoded: Encoded,
  ) {}

  /// Stores the mesh unless it is stored, and returns its id; null if the server's store cannot take it. Rejects with a
  /// Problem if the server refuses the mesh, or does not answer.
  get id(): Promise<string | null> {
    this.#id ??= this.client.store(this.encoded).then(
      ({ id }) => id,
      (error: unknown) => {
        if (error instanceof Problem && ['store_full', 'store_unavailable'].includes(error.code)) return null;
        this.#id = null; // the next call retries
        throw error;
      },
    );
    return this.#id;
  }

  refine(parameters: Parameters | string, call: Call = {}): Promise<Refined> {
    return this.#asking(async (id) => {
      if (id === null) return this.client.refine(this.encoded, parameters, call);
      return (await this.client.refineStored(id, parameters, call))!; // null only with an ETag
    }, call);
  }

  /// Passes the levels to `read` as they arrive, and resolves with its result.
  levels<T>(parameters: Parameters | string, read: (levels: Levels) => Promise<T>, call: Call = {}): Promise<T> {
    return this.#asking((id) => {
      if (id === null) return read(this.client.levels(this.encoded, parameters, call));
      return read(this.client.levelsOfStored(id, parameters, call));
    }, call);
  }

  /// Stores the mesh again if the store has evicted it.
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

/// Repeats a call without an answer once: a kept connection may have been closed meanwhile, and all calls are
/// idempotent.
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
