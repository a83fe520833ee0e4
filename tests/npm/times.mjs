// Times of the WebAssembly module in node and of the same functions compiled for this machine, in turns: a line each of
// name, milliseconds of the module (its result copied out), milliseconds of the native library. For `./dev bench wasm`.

import { readFileSync } from 'node:fs';
import path from 'node:path';
import { nativeResults, readMesh, root, sizeOf } from './requests.mjs';

const { Kernel } = await import(path.join(root, 'build/npm/dist/wasm.js'));
const kernel = new Kernel(await Kernel.compile(readFileSync(path.join(root, 'build/npm/dist/papilio.wasm'))));

const turns = 9;
const median = (values) => [...values].sort((a, b) => a - b)[turns >> 1];

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
    view: `levels=${levels}&${eye}&view.error_pixels=0.5`,
  };
  for (const [name, query] of Object.entries(requests)) {
    const once = () => {
      const opened = kernel.open(mesh);
      const began = performance.now();
      kernel.refine(opened, query);
      const took = performance.now() - began;
      kernel.close(opened);
      return took;
    };
    for (let warm = 0; warm < 3; ++warm) once(); // until the engine has compiled it for speed
    const [ours, peer] = [[], []];
    for (let turn = 0; turn < turns; ++turn) {
      ours.push(once());
      peer.push(1000 * nativeResults(mesh, [query], 3)[0].seconds);
    }
    console.log(`wasm/${path.basename(file, path.extname(file))}/${name} ${median(ours)} ${median(peer)}`);
  }
}
