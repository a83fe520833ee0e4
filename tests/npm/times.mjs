// times.mjs [MODULE]: the WebAssembly module in node beside the same functions compiled for this machine, both in
// processes that stay, one thread each, in turns. A line for each request: its name, the median milliseconds of the
// module (its result copied out), those of the native library, and the median of the ratios. For `./dev bench wasm`.

import { readFileSync } from 'node:fs';
import path from 'node:path';
import { nativeClock, readMesh, root, sizeOf } from './requests.mjs';

const { Kernel } = await import(path.join(root, 'build/npm/dist/wasm.js'));
const module = process.argv[2] ?? path.join(root, 'build/npm/dist/papilio.wasm');
const kernel = new Kernel(await Kernel.compile(readFileSync(module)));

const warmingMilliseconds = 1000; // until the engine has compiled the module for speed
const leastTurns = 15;
const measuringMilliseconds = 2000; // at least: single runs differ by half where processors are shared
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

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
  const native = nativeClock(mesh);
  const timeOfModule = (query) => {
    const opened = kernel.open(mesh);
    const began = performance.now();
    kernel.refine(opened, query);
    const took = performance.now() - began;
    kernel.close(opened);
    return took;
  };
  for (const [name, query] of Object.entries(requests)) {
    const warm = performance.now() + warmingMilliseconds;
    const pairs = [];
    while (pairs.length < leastTurns || performance.now() < warm + measuringMilliseconds) {
      const isWarm = performance.now() > warm;
      const pair = [timeOfModule(query), await native.time(query)];
      if (isWarm) pairs.push(pair);
    }
    const figures = [0, 1].map((i) => median(pairs.map((pair) => pair[i])));
    const ratio = median(pairs.map(([ours, peer]) => ours / peer));
    console.log(`wasm/${path.basename(file, path.extname(file))}/${name}`, ...figures, ratio);
  }
  native.stop();
}
