// Worker with the kernel, started by refiner.ts.

import { CoarseMesh, Kernel, KernelError, type Refined } from './kernel.js';
import type { FromWorker, ToWorker } from './messages.js';

const meshes = new Map<number, CoarseMesh>();
let kernel: Kernel;
let cancelled: Int32Array | null = null;

function send(message: FromWorker, level?: Refined): void {
  const arrays = level
    ? [level.mesh.positions, level.mesh.triangles, ...level.mesh.attributes.map((a) => a.values)]
    : [];
  self.postMessage(message, { transfer: arrays.map((array) => array.buffer as ArrayBuffer) });
}

function refine({ request, mesh, query, wantsLevels, isSingle }: ToWorker & { kind: 'refine' }): void {
  try {
    const refined = kernel.refine(meshes.get(mesh)!, query, {
      ...(wantsLevels && {
        onLevel: (level) => {
          if (!level.statistics.isLast) send({ kind: 'level', request, level }, level);
        },
      }),
      ...(cancelled && { cancelled: () => Atomics.load(cancelled!, 0) === request }),
      singlePrecision: isSingle,
    });
    send({ kind: 'done', request, refined }, refined);
  } catch (error) {
    const { fault, message, parameter } =
      error instanceof KernelError ? error : new KernelError('internal', `The kernel failed: ${String(error)}.`);
    send({ kind: 'failed', request, fault, message, parameter });
  }
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  switch (data.kind) {
    case 'start':
      kernel = new Kernel(data.module, data.mostBytes);
      cancelled = data.cancelled && new Int32Array(data.cancelled);
      return;
    case 'open':
      meshes.set(data.mesh, new CoarseMesh(data.triangles));
      return;
    case 'close':
      kernel.close(meshes.get(data.mesh)!);
      meshes.delete(data.mesh);
      return;
    case 'refine':
      return refine(data);
  }
};
