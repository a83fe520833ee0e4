// Real scenes before and after, drawn by three.js in headless Chromium: the pictures agree.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import { launch, meshes, root } from '../web/browser.mjs';
import { animated, compressible, hands, nameOf, pack, packings, papilio, refine, scenes } from './files.mjs';

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
const draw = async (name, time, frame) => {
  const found = await page.evaluate(
    ([url, at, box]) => window.draw(url, at, box),
    [`/${name}?${drawn++}`, time, frame],
  );
  return { ...found, pixels: Buffer.from(found.pixels, 'base64') };
};

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

/** Pictures of which nearly all is shown by both, in the same colours. */
function assertAgree(a, b, what) {
  const found = agreement(a.pixels, b.pixels);
  assert.ok(found.shown > 100, `${what}: nothing is shown`);
  assert.ok(found.outline > 0.95 && found.colours < 0.02, `${what}: ${JSON.stringify(found)}`);
}

/** Whether each pixel that only one of two pictures shows lies beside one that both do or the other shows alone. */
function outlinesTouch(a, b) {
  const width = Math.sqrt(a.length / 4);
  const shows = (pixels, x, y) =>
    x >= 0 && x < width && y >= 0 && y < width && !background(pixels, 4 * (y * width + x));
  const near = (pixels, x, y) => [-1, 0, 1].some((dy) => [-1, 0, 1].some((dx) => shows(pixels, x + dx, y + dy)));
  for (let y = 0; y < width; ++y)
    for (let x = 0; x < width; ++x)
      if ((shows(a, x, y) && !near(b, x, y)) || (shows(b, x, y) && !near(a, x, y))) return false;
  return true;
}

/** Pictures whose outlines lie within a pixel of each other, with the same colours. */
function assertSame(a, b, what) {
  assertAgree(a, b, what);
  assert.ok(outlinesTouch(a.pixels, b.pixels), `${what}: the outlines are apart`);
}

/** Puts a scene into the folder as in.glb. */
const take = (input) => execFileSync(papilio, ['convert', input, path.join(folder, 'in.glb')]);
/** Puts in.glb, refined, beside it as out.glb. */
const make = (flags) => refine(path.join(folder, 'in.glb'), path.join(folder, 'out.glb'), flags);

/** Refines a scene, and writes it anew without refining it: each looks like the scene. */
async function assertLooksAlike(input) {
  take(input);
  const coarse = await draw('in.glb', 0, null);
  const drawn = async (flags) => {
    make(flags);
    return draw('out.glb', 0, coarse.frame);
  };
  for (const compress of ['same', 'draco']) {
    const flags = ['--levels', '1', '--shape', 'mechanical', '--compress', compress];
    assertSame(coarse, await drawn(flags), compress);
  }
  for (const compress of ['none', 'draco', 'meshopt'])
    assertSame(coarse, await drawn(['--levels', '0', '--compress', compress]), `coarse, ${compress}`);
}

for (const input of scenes) test(`${nameOf(input)} looks alike once it is refined`, () => assertLooksAlike(input));

for (const options of packings)
  test(`what gltfpack ${options.join('')} makes looks alike once it is refined`, async () => {
    for (const input of compressible) {
      pack(input, path.join(folder, 'packed.glb'), options);
      await assertLooksAlike(path.join(folder, 'packed.glb'));
    }
  });

/** Refines a scene, and compares it at three times of its animation. */
async function assertMovesAlike(input) {
  take(input);
  make(['--levels', '2', '--shape', 'mechanical']);
  const frame = (await draw('in.glb', 0, null)).frame;
  const pictures = [];
  for (const time of [0.1, 0.4, 0.7]) {
    const coarse = await draw('in.glb', time, frame);
    assert.ok(coarse.animations > 0);
    assertAgree(coarse, await draw('out.glb', time, frame), `at ${time}`);
    pictures.push(coarse.pixels);
  }
  assert.ok(agreement(pictures[0], pictures[1]).outline < 0.98, 'it does move');
}

for (const input of animated) test(`${nameOf(input)} moves alike`, () => assertMovesAlike(input));

/** Writes a scene whose joints turn, each by so many radians about its x axis in a second. */
async function writeCurling(input, output, radians) {
  const io = new NodeIO();
  const document = await io.read(input);
  const animation = document.createAnimation();
  const buffer = document.getRoot().listBuffers()[0];
  const accessor = (type, numbers) =>
    document.createAccessor().setType(type).setArray(new Float32Array(numbers)).setBuffer(buffer);
  const times = accessor('SCALAR', [0, 1]);
  const [s, c] = [Math.sin(radians / 2), Math.cos(radians / 2)];
  for (const joint of document.getRoot().listSkins()[0].listJoints()) {
    const [x, y, z, w] = joint.getRotation();
    const turned = [w * s + x * c, y * c + z * s, z * c - y * s, w * c - x * s];
    const sampler = document
      .createAnimationSampler()
      .setInput(times)
      .setOutput(accessor('VEC4', [x, y, z, w, ...turned]));
    const channel = document
      .createAnimationChannel()
      .setTargetNode(joint)
      .setTargetPath('rotation')
      .setSampler(sampler);
    animation.addSampler(sampler).addChannel(channel);
  }
  await io.write(output, document);
}

for (const input of hands)
  test(`${nameOf(input)} curls alike`, async () => {
    await writeCurling(input, path.join(folder, 'curling.glb'), 0.6);
    await assertMovesAlike(path.join(folder, 'curling.glb'));
  });

test('pictures of different scenes do not agree', async () => {
  take(scenes[0]);
  const hand = await draw('in.glb', 0, null);
  take(scenes[8]);
  const controller = await draw('in.glb', 0, null);
  assert.throws(() => assertAgree(hand, controller, 'a hand and a controller'));
  assert.throws(() => assertSame(hand, controller, 'a hand and a controller'));
});

test('a packed model shows its base', async () => {
  const packed = path.join(folder, 'packed.glb');
  execFileSync(papilio, ['pack', path.join(meshes, 'bunny.obj'), '-o', packed, '--rms', '0.0007', '--no-simplify']);
  // A packed file's base has no normals: viewers that know only glTF shade its faces flat.
  execFileSync(papilio, ['unpack', packed, '-o', path.join(folder, 'base.glb'), '--levels', '0', '--normals', 'false']);
  const base = await draw('base.glb', 0, null);
  assertAgree(base, await draw('packed.glb', 0, base.frame), 'packed.glb');
});
