// The package as others get it: packed, installed in a new project, used as it is by node and bundled by Vite.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch, root } from '../web/browser.mjs';
import { bunnyGlb } from './files.mjs';
import { cone } from './requests.mjs';

const vite = createRequire(path.join(root, 'client/web/package.json')).resolve('vite/package.json');
let folder;

const run = (program, ...args) => execFileSync(program, args, { cwd: folder, encoding: 'utf8' });

before(() => {
  folder = mkdtempSync(path.join(tmpdir(), 'papilio-package-'));
  const [{ filename }] = JSON.parse(run('npm', 'pack', '--json', path.join(root, 'build/npm')));
  writeFileSync(path.join(folder, 'package.json'), '{ "name": "project", "private": true, "type": "module" }');
  run('npm', 'install', '--offline', '--no-audit', '--no-fund', `./${filename}`);
  mkdirSync(path.join(folder, 'node_modules/@types'));
  for (const name of ['three', '@types/three'])
    symlinkSync(path.join(root, 'client/web/node_modules', name), path.join(folder, 'node_modules', name));
});
after(() => rmSync(folder, { recursive: true }));

test('the package contains its exports with types, and nothing else', () => {
  const installed = path.join(folder, 'node_modules/papilio');
  const { exports } = JSON.parse(readFileSync(path.join(installed, 'package.json'), 'utf8'));
  const named = Object.values(exports).flatMap((to) => (typeof to === 'string' ? [to] : Object.values(to)));
  for (const file of named) assert.ok(readFileSync(path.join(installed, file)).length > 0, file);
  assert.deepEqual(readdirSync(installed).sort(), ['LICENSE', 'README.md', 'dist', 'package.json']);
  for (const file of readdirSync(path.join(installed, 'dist'), { recursive: true }))
    assert.match(file, /(\.d\.ts|\.js|\.wasm|^three|^detail)$/);
});

test('Node.js imports the package without a bundler', () => {
  const mesh = cone(6);
  writeFileSync(
    path.join(folder, 'use.js'),
    `import { readFileSync } from 'node:fs';
     import { createRequire } from 'node:module';
     import { Client } from 'papilio/client';
     import { compileDecoder, DetailDecoder, isPacked } from 'papilio/detail';
     import { readTriangleFile } from 'papilio/files';
     import { Kernel } from 'papilio/wasm';
     const file = createRequire(import.meta.url).resolve('papilio/papilio.wasm');
     const kernel = new Kernel(await Kernel.compile(readFileSync(file)));
     const mesh = kernel.open({ positions: new Float32Array([${mesh.positions}]), triangles: new Uint32Array([${mesh.triangles}]) });
     console.log(kernel.refine(mesh, { levels: 2 }).mesh.triangles.length / 3, typeof new Client().refine);
     const module = await compileDecoder(readFileSync(file.replace('papilio.wasm', 'papilio-detail.wasm')));
     const positions = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
     const triangle = { positions, triangles: new Uint32Array([0, 1, 2]) };
     console.log(new DetailDecoder(module, triangle, new Uint8Array()).countEdges(), isPacked(new Uint8Array()));
     const wasm = readFileSync(file.replace('papilio.wasm', 'papilio-files.wasm'));
     const off = new TextEncoder().encode('OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n');
     console.log((await readTriangleFile('off', off, { wasm })).triangles.length);`,
  );
  assert.equal(run(process.execPath, 'use.js'), '96 function\n3 false\n3\n');
});

test('TypeScript finds the types of the package', () => {
  writeFileSync(
    path.join(folder, 'use.ts'),
    `import { Client, type Refined } from 'papilio/client';
     import { type LevelInfo, openPacked, type PackedModel } from 'papilio/detail';
     import { readTriangleFile, type TriangleFile } from 'papilio/files';
     import { PapilioLoader, type RefinedModel } from 'papilio/three';
     import { Refiner } from 'papilio/wasm';
     export const load = (url: string): Promise<RefinedModel> => new PapilioLoader({ server: '/' }).loadAsync(url);
     export async function unpack(bytes: Uint8Array<ArrayBuffer>): Promise<[LevelInfo, Float32Array]> {
       const model: PackedModel = await openPacked(bytes, { decodeDraco: () => Promise.reject(new Error()), mayBeCut: true });
       return [model.levels[0]!, (await model.decode(1, { signal: new AbortController().signal })).positions];
     }
     export const read = (bytes: Uint8Array): Promise<TriangleFile> => readTriangleFile('ply', bytes);
     export async function use(bytes: Uint8Array<ArrayBuffer>): Promise<number> {
       const fine: Refined = await new Client().refine({ type: 'application/x-draco', bytes }, { view: { eye: [0, 0, 3] } });
       const refiner = await Refiner.start();
       const mesh = refiner.open({ positions: new Float32Array(), triangles: new Uint32Array() });
       return fine.faces + (await refiner.refine(mesh)).mesh.triangles.length;
     }`,
  );
  const tsc = path.join(root, 'client/web/node_modules/typescript/bin/tsc');
  const options = ['--strict', '--target', 'es2022', '--lib', 'es2022,dom', '--module', 'nodenext', '--skipLibCheck'];
  run(process.execPath, tsc, '--noEmit', ...options, 'use.ts');
});

test('Vite bundles the package, its workers and its module, and the page refines', async () => {
  const mesh = cone(6);
  mkdirSync(path.join(folder, 'src'));
  writeFileSync(
    path.join(folder, 'index.html'),
    '<title>page</title><script type="module" src="/src/main.js"></script>',
  );
  writeFileSync(
    path.join(folder, 'src/main.js'),
    `import { PapilioLoader } from 'papilio/three';
     import { Refiner } from 'papilio/wasm';
     import { PerspectiveCamera, Scene, WebGLRenderer } from 'three';
     const refiner = await Refiner.start();
     const mesh = refiner.open({ positions: new Float32Array([${mesh.positions}]), triangles: new Uint32Array([${mesh.triangles}]) });
     const [renderer, scene, camera] = [new WebGLRenderer(), new Scene(), new PerspectiveCamera()];
     camera.position.set(0, 5, 20);
     camera.lookAt(0, 5, 0);
     renderer.setSize(600, 600);
     const model = await new PapilioLoader({ parameters: { view: { error_pixels: 0.25 } } }).loadAsync('./model.glb');
     scene.add(model);
     renderer.render(scene, camera);
     await model.settled();
     const { faces } = model.statistics;
     document.title = 'faces: ' + [(await refiner.refine(mesh, { levels: 3 })).mesh.triangles.length / 3, faces > 600];`,
  );
  mkdirSync(path.join(folder, 'public'));
  writeFileSync(path.join(folder, 'public/model.glb'), bunnyGlb());
  run(
    process.execPath,
    path.join(path.dirname(vite), 'bin/vite.js'),
    'build',
    '--logLevel',
    'warn',
    '--target',
    'es2022',
  );
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };
  const server = createServer((request, response) => {
    try {
      const name = request.url === '/' ? 'index.html' : request.url;
      const bytes = readFileSync(path.join(folder, 'dist', name));
      response.setHeader('Content-Type', types[path.extname(name)] ?? 'application/octet-stream').end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const browser = await launch();
  try {
    const page = await browser.newPage();
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.waitForFunction(() => document.title.startsWith('faces: '), null, { timeout: 60_000 });
    assert.equal(await page.title(), 'faces: 384,true');
  } finally {
    await browser.close();
    server.close();
  }
});
