// The package's README: each of its examples runs as it stands there, in a page that has what it takes for granted.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch, startServer } from '../web/browser.mjs';
import { bunnyGlb, page as pageOf, startFiles } from './files.mjs';
import { pack } from './packed.mjs';
import { cone, root } from './requests.mjs';

const readme = readFileSync(path.join(root, 'client/npm/README.md'), 'utf8');
const examples = [...readme.matchAll(/```js\n(.*?)```/gs)].map(([, code]) => code);

const folder = mkdtempSync(path.join(tmpdir(), 'papilio-readme-'));
const { packed, report } = pack('torus', folder);
const served = { '/model.glb': bunnyGlb(), '/packed.glb': readFileSync(packed) };
let server;
let files;
let browser;
before(async () => {
  [server, browser] = await Promise.all([startServer('--cors-origins', '*'), launch()]);
  files = await startFiles(served);
});
after(async () => {
  await browser.close();
  files.stop();
  await server.stop();
  rmSync(folder, { recursive: true });
});

/// Runs `before`, the example and `after` as one module of a page, and resolves with what `after` says.
async function run(example, beforeIt, afterIt) {
  const html = pageOf(
    `<script type="module">${beforeIt}\n${example}\n${afterIt}\ndocument.title = 'said: ' + JSON.stringify(said);</script>`,
  );
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  served['/example.html'] = html;
  await page.goto(`${files.url}/example.html`);
  await page.waitForFunction(() => document.title.startsWith('said: '), null, { timeout: 60_000 }).catch(() => {});
  assert.deepEqual(faults, []);
  const title = await page.title();
  await page.close();
  return JSON.parse(title.replace('said: ', ''));
}

test('the README has an example for each part of the package', () => {
  assert.deepEqual(
    examples.map((code) => /from '(.*?)'/.exec(code)[1]),
    ['papilio/three', 'papilio/wasm', 'papilio/files', 'papilio/client', 'papilio/detail'],
  );
});

test('papilio/three: a model in a rendered scene becomes finer', async () => {
  const faces = await run(
    examples[0],
    `import * as THREE from 'three';
     const scene = new THREE.Scene();
     const renderer = new THREE.WebGLRenderer();
     renderer.setSize(300, 300);
     const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
     camera.position.set(0, 5, 20);
     camera.lookAt(0, 5, 0);`,
    `renderer.render(scene, camera);
     await model.settled();
     const said = model.statistics.faces;`,
  );
  assert.ok(faces > 600, `${faces}`);
});

test('papilio/wasm: a geometry is refined in workers', async () => {
  const mesh = cone(6);
  const { triangles, error } = await run(
    examples[1],
    `import * as THREE from 'three';
     const geometry = new THREE.BufferGeometry();
     geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([${mesh.positions}]), 3));
     geometry.setIndex([${mesh.triangles}]);`,
    'const said = { triangles: fine.triangles.length, error: statistics.error };',
  );
  assert.ok(triangles > 3 * 6 && error <= 0.001, `${triangles}, ${error}`);
});

test('papilio/files: a file of smoothing groups is opened', async () => {
  const counts = await run(
    examples[2],
    `import { Refiner } from 'papilio/wasm';
     const refiner = await Refiner.start();
     const lines = ['v 0 0 0', 'v 1 0 0', 'v 1 1 0', 'v 0 1 1', 's 1', 'f 1 2 3', 's 2', 'f 1 3 4', ''];
     const file = new Blob([lines.join('\\n')]);`,
    'const said = [mesh.triangles.triangles.length / 3, groups.length];',
  );
  assert.deepEqual(counts, [2, 1]);
});

test('papilio/client: a scene arrives level by level', async () => {
  const faces = await run(
    examples[3].replace('https://refine.example.com/', server.url),
    `const file = await (await fetch('/model.glb')).blob();
     const { signal } = new AbortController();
     const said = [];
     const show = (bytes, faces) => said.push([bytes.length > 100, faces]);`,
    '',
  );
  assert.equal(faces[0][1], 600);
  assert.ok(faces.length > 1 && faces.every(([isLong]) => isLong), JSON.stringify(faces));
});

test('papilio/detail: a packed model returns all its faces', async () => {
  const faces = await run(
    examples[4],
    `import * as THREE from 'three';
     const mesh = new THREE.Mesh();`,
    'const said = mesh.geometry.index.count / 3;',
  );
  assert.equal(faces, report.levels.at(-1).faces);
});
