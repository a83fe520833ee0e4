// Messages between the page and the worker that decodes a packed model.

import type { BaseTriangles, DecodedTriangles, NormalStyle } from './decoder.js';
import type { PackedLevel } from './packed_file.js';

export type Residuals = Pick<PackedLevel, 'step' | 'residuals' | 'texcoordStep' | 'texcoordBytes' | 'pieces'>;

export type ToDecoder =
  | { kind: 'open'; module: WebAssembly.Module; base: BaseTriangles; curves: Uint8Array; levels: Residuals[] }
  | { kind: 'decode'; request: number; levels: number; normals: NormalStyle };

/// The answer to `open` counts the edges of the base.
export type FromDecoder =
  | { kind: 'opened'; edges: number }
  | { kind: 'decoded'; request: number; triangles: DecodedTriangles }
  | { kind: 'failed'; request: number | null; code: string; message: string };
