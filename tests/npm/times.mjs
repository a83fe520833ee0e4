// times.mjs [MODULE]: the WebAssembly module in node beside the same functions compiled for this machine, both in
// processes that stay, one thread each, in turns. A line for each request: its name, the milliseconds of the module with
// its result read in place, as the native library's is; with its result copied out; and of the native library. For
// `./dev bench wasm`.
//
// A mesh is opened, which copies it in, refined and closed. The time is that of the processor in the thread, of the
// quickest of several batches: others who are busy only add to it. Ratios agree to a few percent; by the clock they
// differ by half.

import { readFileSync } from 'node:fs';
import path from 'node:path';
import { nativeProcess, readMesh, root, sizeOf } from './requests.mjs';

const { Kernel } = await import(path.join(root, 'build/npm/dist/wasm.js'));
const module = process.argv[2] ?? path.join(root, 'build/npm/dist/papilio.wasm');
const kernel = new Kernel(await Kernel.compile(readFileSync(module)));

const batchMilliseconds = 150; // of the native library: the kernel counts a thread's time every few milliseconds
const warmingBatches = 4; // until the engine has compiled the module for speed
const batches = 9;
const settled = () => new Promise((resolve) => setTimeout(resolve, 10)); // a thread that waits has been counted

/// Milliseconds of the processor that a process's first thread has had.
const processorTime = (pid) => Number(readFileSync(`/proc/${pid}/schedstat`, 'utf8').split(' ')[0]) / 1e6;

async function timed(pid, work, times) {
  await settled();
  const began = processorTime(pid);
  await work();
  await settled();
  return (processorTime(pid) - began) / times;
}

for (const [file, levels] of [
  ['bunny600.obj', 3],
  ['elephant2000.obj', 3],
  ['cgal/bear_bis.off', 2],
]) {
  const mesh = readMesh(file);
  const eye = `view.eye=0,0,${3 * sizeOf(mesh)}`;
  const requests = {
    uniform: `levels=${levels}`,
    tolerance: `levels=${levels}&tolerance=0.001`,
    flatness: `levels=${levels}&flatness=0.97`,
    view: `levels=${levels}&${eye}&view.error_pixels=0.5&view.verify=false`,
  };
  const native = nativeProcess(mesh);
  const refineHere = (query, times, inPlace) => {
    for (let i = 0; i < times; ++i) {
      const opened = kernel.open(mesh);
      kernel.refine(opened, query, { inPlace });
      kernel.close(opened);
    }
  };
  for (const [name, query] of Object.entries(requests)) {
    const quickest = Math.min(await native.refine(query), await native.refine(query), await native.refine(query));
    const times = Math.ceil(batchMilliseconds / quickest);
    const rounds = [];
    for (let batch = 0; batch < warmingBatches + batches; ++batch) {
      const inPlace = await timed(process.pid, () => refineHere(query, times, true), times);
      const copied = await timed(process.pid, () => refineHere(query, times, false), times);
      const peer = await timed(native.pid, () => native.refine(query, times), times);
      if (batch >= warmingBatches) rounds.push([inPlace, copied, peer]);
    }
    const quickestOf = [0, 1, 2].map((i) => Math.min(...rounds.map((round) => round[i])));
    console.log(`wasm/${path.basename(file, path.extname(file))}/${name}`, ...quickestOf);
  }
  native.stop();
}
