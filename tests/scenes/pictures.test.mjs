// Real scenes before and after, drawn by three.js in headless Chromium: the pictures agree.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch, root } from '../web/browser.mjs';
import { animated, nameOf, papilio, refine, scenes } from './files.mjs';

const types = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.wasm': 'application/wasm',
  '.glb': 'model/gltf-binary',
};
const three = path.join(root, 'client/web/node_modules/three');

let folder;
let server;
let browser;
let page;

before(async () => {
  folder = mkdtempSync(path.join(tmpdir(), 'pictures-'));
  server = createServer((request, response) => {
    const name = request.url.split('?')[0];
    const file = name.startsWith('/three/') ? path.join(three, name.slice(7)) : path.join(folder, name);
    try {
      const bytes = readFileSync(name === '/page.html' ? path.join(root, 'tests/scenes/page.html') : file);
      response.writeHead(200, { 'Content-Type': types[path.extname(name)] ?? 'application/octet-stream' }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  browser = await launch();
  page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/page.html`);
  await page.waitForSelector('html[data-state=ready]', { state: 'attached' });
});
after(async () => {
  await browser.close();
  server.close();
  rmSync(folder, { recursive: true });
});

let drawn = 0;
const draw = (name, time, frame) =>
  page.evaluate(([url, at, box]) => window.draw(url, at, box), [`/${name}?${drawn++}`, time, frame]);

const background = (pixels, i) => pixels[i] === 0 && pixels[i + 1] === 0 && pixels[i + 2] === 255;

/** What two pictures share of all that either shows, and the mean difference of colours there, 0 to 1. */
function agreement(a, b) {
  let either = 0;
  let both = 0;
  let difference = 0;
  for (let i = 0; i < a.length; i += 4) {
    const [inA, inB] = [!background(a, i), !background(b, i)];
    if (inA || inB) either += 1;
    if (!inA || !inB) continue;
    both += 1;
    for (let c = 0; c < 3; ++c) difference += Math.abs(a[i + c] - b[i + c]) / 3 / 255;
  }
  return { shown: either, outline: both / either, colours: difference / both };
}

function assertAgree(a, b, what) {
  const found = agreement(a.pixels, b.pixels);
  assert.ok(found.shown > 100, `${what}: nothing is shown`);
  assert.ok(found.outline > 0.93 && found.colours < 0.06, `${what}: ${JSON.stringify(found)}`);
}

/** Puts a scene into the folder as in.glb, and refined as out.glb. */
function prepare(input, flags) {
  execFileSync(papilio, ['convert', input, path.join(folder, 'in.glb')]);
  refine(path.join(folder, 'in.glb'), path.join(folder, 'out.glb'), flags);
}

for (const input of scenes) {
  test(`${nameOf(input)} looks alike once it is refined`, async () => {
    for (const flags of [[], ['--compress', 'draco']]) {
      prepare(input, ['--levels', '1', '--shape', 'mechanical', ...flags]);
      const coarse = await draw('in.glb', 0, null);
      assertAgree(coarse, await draw('out.glb', 0, coarse.frame), flags.join(' '));
    }
  });
}

for (const input of animated) {
  test(`${nameOf(input)} moves alike`, async () => {
    prepare(input, ['--levels', '2', '--shape', 'mechanical']);
    const frame = (await draw('in.glb', 0, null)).frame;
    const pictures = [];
    for (const time of [0.1, 0.4, 0.7]) {
      const coarse = await draw('in.glb', time, frame);
      assert.ok(coarse.animations > 0);
      assertAgree(coarse, await draw('out.glb', time, frame), `at ${time}`);
      pictures.push(coarse.pixels);
    }
    assert.ok(agreement(pictures[0], pictures[1]).outline < 0.98, 'it does move');
  });
}

test('pictures of different scenes do not agree', async () => {
  prepare(scenes[0], ['--levels', '0']);
  const hand = await draw('in.glb', 0, null);
  prepare(scenes[8], ['--levels', '0']);
  const controller = await draw('in.glb', 0, null);
  assert.throws(() => assertAgree(hand, controller, 'a hand and a controller'));
});
