// Worker that reads an original and measures distances to it; original.ts starts it.

import { readFile, welded } from './triangle_files';
import { MeasuredOriginal, type Surface, type TwoSided } from './two_sided';

/// Message; the first is the original, as a file of one of triangleFormats or decoded. Each is answered.
export type ToMeasurer =
  | { kind: 'file'; name: string; extension: string; bytes: ArrayBuffer }
  | { kind: 'original' | 'measure'; surface: Surface };
export type FromMeasurer = { measured: TwoSided | null } | { fault: string };

let original: MeasuredOriginal;

async function answerTo(message: ToMeasurer): Promise<TwoSided | null> {
  if (message.kind === 'measure') return original.measure(message.surface);
  original = new MeasuredOriginal(
    'surface' in message ? message.surface : welded(await readFile(message.name, message.extension, message.bytes)),
  );
  return null;
}

function answer(message: FromMeasurer, transfer: ArrayBuffer[] = []): void {
  self.postMessage(message, { transfer });
}

self.onmessage = ({ data }: MessageEvent<ToMeasurer>) =>
  void answerTo(data).then(
    (measured) => answer({ measured }, measured ? [measured.ofFaces.buffer] : []),
    (error: unknown) => answer({ fault: error instanceof Error ? error.message : String(error) }),
  );
