// Worker with the decoder, started by packed_model.ts.

import { Problem } from '../client.js';
import { DetailDecoder } from './decoder.js';
import type { FromDecoder, Residuals, ToDecoder } from './messages.js';

let decoder: DetailDecoder;
let levels: Residuals[] = [];

function send(message: FromDecoder, transfer: ArrayBuffer[] = []): void {
  self.postMessage(message, { transfer });
}

function answer(data: ToDecoder): void {
  if (data.kind === 'open') {
    decoder = new DetailDecoder(data.module, data.base, data.curves);
    ({ levels } = data);
    send({ kind: 'opened', edges: decoder.countEdges() });
    return;
  }
  const triangles = decoder.decode(levels.slice(0, data.levels), undefined, data.normals);
  const transfer = Object.values(triangles).map(({ buffer }: Uint8Array<ArrayBuffer>) => buffer);
  send({ kind: 'decoded', request: data.request, triangles }, transfer);
}

self.onmessage = ({ data }: MessageEvent<ToDecoder>) => {
  try {
    answer(data);
  } catch (error) {
    const { code, message } =
      error instanceof Problem ? error : new Problem('internal', `The decoder failed: ${String(error)}.`);
    send({ kind: 'failed', request: data.kind === 'decode' ? data.request : null, code, message });
  }
};
