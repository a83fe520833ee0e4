// Messages between the page and its workers.

import type { Fault, Refined, Triangles } from './kernel.js';

export type ToWorker =
  /// `cancelled`: number of the request to stop, in memory shared with the page if that is permitted.
  | { kind: 'start'; module: WebAssembly.Module; cancelled: SharedArrayBuffer | null; mostBytes: number }
  | { kind: 'open'; mesh: number; triangles: Triangles }
  | { kind: 'close'; mesh: number }
  | { kind: 'refine'; request: number; mesh: number; query: string; wantsLevels: boolean; isSingle: boolean };

export type FromWorker =
  | { kind: 'level'; request: number; level: Refined }
  | { kind: 'done'; request: number; refined: Refined }
  | { kind: 'failed'; request: number; fault: Fault; message: string; parameter: string };
