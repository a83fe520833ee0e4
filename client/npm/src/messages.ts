// What the page and its workers tell each other.

import type { Fault, Refined, Triangles } from './kernel.js';

export type ToWorker =
  /// `cancelled`: shared with the page where it may share memory; holds the number of the request to stop.
  | { kind: 'start'; module: WebAssembly.Module; cancelled: SharedArrayBuffer | null; mostBytes: number }
  | { kind: 'open'; mesh: number; triangles: Triangles }
  | { kind: 'close'; mesh: number }
  | { kind: 'refine'; request: number; mesh: number; query: string; wantsLevels: boolean; isSingle: boolean };

export type FromWorker =
  | { kind: 'level'; request: number; level: Refined }
  | { kind: 'done'; request: number; refined: Refined }
  | { kind: 'failed'; request: number; fault: Fault; message: string; parameter: string };
