// Edges of geometries, found in a worker: the edges of a large mesh take longer than a frame.

import type { BufferGeometry } from 'three';

import type { FromEdgeFinder, ToEdgeFinder } from './edges_worker';

interface Search {
  /// Edges as edgesOf of mesh_edges.ts returns them; null: not found yet.
  ends: Uint32Array | null;
  done: Promise<void>;
}

const searches = new WeakMap<BufferGeometry, Search>();
/// Searches to be answered in their order.
let waiting: { resolve: (ends: Uint32Array) => void; reject: (reason: Error) => void }[] = [];
let worker: Worker | null = null;

/// Returns the ends of each edge of an indexed geometry; null: not found yet.
export function foundEdges(geometry: BufferGeometry): Uint32Array | null {
  return searches.get(geometry)?.ends ?? null;
}

/// Finds edges; once resolved, foundEdges returns them.
export function findEdges(geometry: BufferGeometry): Promise<void> {
  const known = searches.get(geometry);
  if (known !== undefined) return known.done;
  const search: Search = { ends: null, done: Promise.resolve() };
  search.done = ask({ corners: geometry.index!.array, vertices: geometry.getAttribute('position').count }).then(
    (ends) => void (search.ends = ends),
  );
  search.done.catch(() => searches.delete(geometry)); // the next picture retries
  searches.set(geometry, search);
  return search.done;
}

function ask(message: ToEdgeFinder): Promise<Uint32Array> {
  worker ??= start();
  worker.postMessage(message);
  return new Promise((resolve, reject) => waiting.push({ resolve, reject }));
}

function start(): Worker {
  const made = new Worker(new URL('./edges_worker.ts', import.meta.url), { type: 'module', name: 'papilio-edges' });
  made.onmessage = ({ data }: MessageEvent<FromEdgeFinder>) => waiting.shift()!.resolve(data);
  made.onerror = ({ message }) => {
    const error = new Error(
      `Edges cannot be drawn: ${message || 'their script could not be loaded'}. Reload the page.`,
    );
    for (const { reject } of waiting) reject(error);
    waiting = [];
    worker = null;
    made.terminate();
  };
  return made;
}
