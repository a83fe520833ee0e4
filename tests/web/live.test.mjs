// The page as it opens: one picture, refined in the browser while the camera moves, and the few settings that most need.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import {
  axeSource,
  compare,
  done,
  drag,
  drop,
  facesOf,
  meshes,
  openPage,
  picture,
  redShare,
  refinements,
  serverAndBrowser,
} from './browser.mjs';
import { cubeObj, skinnedGlb, twoCubesGlb } from './mesh_files.mjs';

const shared = serverAndBrowser();
const open = (options = {}) => openPage(shared.browser, shared.server.url, { hash: '', ...options });
const quiet = (page) => page.waitForTimeout(700);

/// Resolves once the kernel here has made what the camera sees.
const madeHere = (page) =>
  page.locator('.panel[data-mode=view][data-by=here][data-state=done][data-estimate=false]').waitFor();

/// The faces of what was made here, whenever they change from now on.
async function watchFaces(page) {
  await page.evaluate(() => {
    window.seen = [];
    const panel = document.querySelector('.panel[data-mode=view]');
    new MutationObserver(() => window.seen.push(panel.dataset.faces)).observe(panel, {
      attributeFilter: ['data-faces'],
    });
  });
  return () => page.evaluate(() => window.seen.map(Number));
}

test('the page opens on a model, before and after in one picture, refined without a request', async () => {
  const context = await shared.browser.newContext();
  const page = await context.newPage();
  const [posts, faults] = [[], []];
  page.on('request', (request) => request.method() === 'POST' && posts.push(request.url()));
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.goto(shared.server.url);
  await madeHere(page);
  await quiet(page);
  assert.equal(await page.locator('#sample').inputValue(), 'knot');
  assert.equal(await page.locator('.panel').count(), 2);
  assert.ok((await facesOf(page, 'view')) > 4 * (await facesOf(page, 'coarse')));
  assert.match(
    await page.locator('#cost').innerText(),
    /432 → [\d,]+ faces.*0 bytes sent: refined here.*ms.*within .* px/s,
  );
  // Left and right of the line are not the same, and the line can be moved by keys.
  const middle = await picture(page, 'view');
  const wipe = page.locator('#wipe');
  await wipe.fill('1000');
  const coarse = await picture(page, 'view');
  await wipe.fill('0');
  const fine = await picture(page, 'view');
  assert.ok((await compare(page, coarse, fine)).differing > 0.02);
  assert.ok((await compare(page, coarse, middle)).differing > 0.01);
  assert.ok((await compare(page, middle, fine)).differing > 0.01);
  assert.deepEqual([posts, faults], [[], []]);
});

test('the page refines while the camera moves, without a request', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await quiet(page);
  const made = refinements(page);
  const seen = await watchFaces(page);
  const box = await page.locator('#stage').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 20; ++step) {
    await page.mouse.move(x + 12 * step, y + 4 * step);
    await page.waitForTimeout(50);
  }
  const whileHeld = await seen();
  await page.mouse.up();
  await madeHere(page);
  assert.ok(whileHeld.length >= 3, `${whileHeld}`);
  assert.deepEqual(made, []);
  // Nearer, more of what is left is large.
  const words = await page.locator('#cost').innerText();
  assert.ok(Number(/within ([\d.]+) px/.exec(words)[1]) <= 0.5, words);
  assert.deepEqual(faults, []);
});

test('a picture at rest is compared with the uniform surface, as by the server', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  const cost = page.locator('#cost');
  assert.match(await cost.innerText(), /within [\d.]+ px/);
  const { x, y } = await page.locator('#stage').boundingBox();
  await page.mouse.move(x + 300, y + 300);
  await page.mouse.down();
  await page.mouse.move(x + 400, y + 320, { steps: 5 });
  const moving = page.locator('.panel[data-mode=view][data-state=done][data-estimate=true]');
  await moving.waitFor();
  assert.match(await cost.innerText(), /about [\d.]+ px/);
  const passing = await facesOf(page, 'view');
  await page.mouse.up();
  await madeHere(page);
  assert.match(await cost.innerText(), /within [\d.]+ px/);
  const faces = await facesOf(page, 'view');
  assert.ok(faces > passing, `${faces} faces at rest, ${passing} before`);
  const viewport = page.viewportSize();
  const hash = new URL(page.url()).hash.slice(1).replace('where=here', 'where=server');
  const other = await open({ hash, viewport });
  await other.page.locator('#cost', { hasText: 'bytes from the server' }).waitFor();
  await other.page.locator('.panel[data-mode=view][data-by=server][data-state=done]').waitFor();
  await quiet(other.page);
  assert.equal(await facesOf(other.page, 'view'), faces);
  assert.deepEqual([faults, other.faults], [[], []]);
});

test('the picture follows the slider of detail while it is dragged', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await quiet(page);
  const made = refinements(page);
  const seen = await watchFaces(page);
  await page.evaluate(() => {
    const slider = document.getElementById('detail');
    let step = 0;
    const drag = () => {
      slider.value = String(20 + (++step % 60));
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    };
    window.dragging = setInterval(drag, 50);
  });
  const began = Date.now();
  while ((await seen()).length < 3 && Date.now() - began < 30_000) await page.waitForTimeout(100);
  const whileDragged = await seen();
  assert.ok(whileDragged.length >= 3, `${whileDragged}`);
  assert.match(await page.locator('#cost').innerText(), /about [\d.]+ px/);
  await page.evaluate(() => clearInterval(window.dragging));
  await madeHere(page);
  assert.match(await page.locator('#cost').innerText(), /within [\d.]+ px/);
  assert.deepEqual(made, []);
  assert.deepEqual(faults, []);
});

test('figures and the camera in the form follow the rotation, in existing elements', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await quiet(page);
  const texts = () =>
    page.evaluate(() => [
      document.querySelector('#figures table').innerText.match(/^faces.*$/m)[0],
      document.getElementById('parameter-view.eye').placeholder,
    ]);
  const before = await texts();
  assert.equal(before[0].split('\t').at(-1), (await facesOf(page, 'view')).toLocaleString('en'));
  await page.evaluate(() => (window.table = document.querySelector('#figures table')));
  await drag(page, 200, 40);
  await madeHere(page);
  await quiet(page);
  const after = await texts();
  assert.equal(after[0].split('\t').at(-1), (await facesOf(page, 'view')).toLocaleString('en'));
  assert.ok(
    after.every((text, i) => text !== before[i]),
    `${before} ${after}`,
  );
  assert.ok(await page.evaluate(() => window.table.isConnected));
  // A panel more is a column more.
  await page.locator('#modes input[value=uniform]').check();
  await done(page, ['uniform']);
  await quiet(page);
  assert.equal(await page.locator('#figures thead th').count(), await page.locator('.panel').count());
  assert.deepEqual(faults, []);
});

test('a frozen view keeps its refinement in this browser', async () => {
  const { page } = await open();
  await madeHere(page);
  await page.getByLabel(/Freeze the view/).check();
  await madeHere(page);
  const faces = await facesOf(page, 'view');
  const seen = await watchFaces(page);
  await drag(page, 200, 40);
  await quiet(page);
  assert.deepEqual(await seen(), []);
  assert.equal(await facesOf(page, 'view'), faces);
});

test('the frustum of a frozen view is drawn', async () => {
  const { page } = await open();
  await madeHere(page);
  await page.locator('#stage').focus();
  for (let i = 0; i < 12; ++i) await page.keyboard.press('-');
  const orange = async () => (await redShare(page, await picture(page, 'view'))).orange;
  const withoutOne = await orange();
  await page.getByLabel(/Freeze the view/).check();
  await drag(page, 150, 40); // it is seen from elsewhere
  for (let i = 0; i < 12; ++i) await page.keyboard.press('-');
  await quiet(page);
  const share = await orange();
  assert.ok(withoutOne < 1e-4 && share > 3e-4, `${withoutOne}, then ${share}`);
  await page.getByLabel(/Freeze the view/).uncheck();
  await quiet(page);
  assert.ok((await orange()) < 1e-4);
});

test('detail is one slider, and hard edges are kept or rounded', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await drop(page, 'cube.obj', cubeObj());
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  await madeHere(page);
  // A cube is mechanical: nothing to refine, until its edges are to be round.
  await page.locator('.panel[data-mode=view][data-faces="12"]').waitFor();
  assert.match(await page.locator('#cost').innerText(), /looks mechanical/);
  await page.getByLabel('round', { exact: true }).check();
  await page.waitForFunction(() => document.querySelector('.panel[data-mode=view]').dataset.faces > 100);
  await madeHere(page);
  const slider = page.getByLabel('Detail', { exact: true });
  const faces = [];
  for (const [value, words] of [
    ['0', 'within 16 pixels'],
    ['57.142857', 'within 1 pixel'],
    ['100', 'within 0.13 pixels'],
  ]) {
    await slider.fill(value);
    assert.equal(await page.locator('#detail-words').innerText(), words);
    await quiet(page);
    await madeHere(page);
    faces.push(await facesOf(page, 'view'));
  }
  assert.ok(faces[0] < faces[1] && faces[1] < faces[2], `${faces}`);
  assert.match(page.url(), /shape=organic/);
  assert.deepEqual(faults, []);
});

test('the server refines on request, and its costs are shown', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  const faces = await facesOf(page, 'view');
  await Promise.all([page.waitForRequest(/refined\?/), page.getByLabel('on the server').check()]);
  await page.locator('.panel[data-mode=view][data-by=server][data-state=done]').waitFor();
  assert.match(await page.locator('#cost').innerText(), /[\d,]+ bytes from the server/);
  // The same request: the same faces.
  assert.equal(await facesOf(page, 'view'), faces);
  await page.getByLabel('in this browser').check();
  await madeHere(page);
  assert.equal(await facesOf(page, 'view'), faces);
  // The other looks and arrangements, and back.
  await page.getByLabel('Side by side').check();
  await done(page);
  assert.equal(await page.locator('.panel').count(), 4);
  await page.getByLabel('One picture, before and after').check();
  await madeHere(page);
  assert.equal(await page.locator('.panel').count(), 2);
  assert.deepEqual(faults, []);
});

test('faces are counted as drawn, coarse and refined, here and by the server', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  // Two nodes show one cube, of which one more face has no area.
  const glb = twoCubesGlb((json) => {
    json.bufferViews[1].byteLength += 6; // the indices 0, 0, 0
    json.accessors[1].count += 3;
  });
  await drop(page, 'two.glb', glb);
  await page.locator('.panel[data-mode=coarse][data-faces="24"]').waitFor();
  await page.getByLabel('keep', { exact: true }).check();
  await page.locator('.panel[data-mode=view][data-by=here][data-faces="24"]').waitFor();
  await page.getByLabel('Side by side').check();
  await done(page);
  const uniform = await page.locator('.panel[data-mode=uniform]').evaluate(({ dataset }) => ({ ...dataset }));
  assert.equal(uniform.by, 'server');
  assert.ok(Number.isInteger(Math.log2(uniform.faces / 24) / 2), uniform.faces);
  assert.deepEqual(faults, []);
});

test('a scene is refined in this browser part by part, and its parts can be hidden', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await drop(page, 'two.glb', twoCubesGlb());
  await page.locator('.panel[data-mode=coarse][data-faces="24"]').waitFor();
  await page.getByLabel('round', { exact: true }).check();
  await page.waitForFunction(() => document.querySelector('.panel[data-mode=view]').dataset.faces > 200);
  await madeHere(page);
  const names = await page.locator('#parts label').allInnerTexts();
  assert.deepEqual(
    names.map((name) => name.trim()),
    ['first', 'second'],
  );
  await page.locator('#wipe').fill('1000');
  await page.getByLabel('Dark', { exact: true }).check();
  await quiet(page);
  const before = await picture(page, 'coarse');
  assert.ok((await compare(page, before, before)).drawn > 0.1, 'before is drawn, too');
  await page.locator('#wipe').fill('0');
  await quiet(page);
  const both = await picture(page, 'view');
  await page.getByLabel('second', { exact: true }).uncheck();
  const one = await picture(page, 'view');
  const { drawn } = await compare(page, both, one);
  const left = await compare(page, one, both);
  assert.ok(left.drawn < 0.7 * drawn, `${left.drawn} of ${drawn}`);
  // It stays hidden in what is refined next.
  await drag(page, 60, 10);
  await madeHere(page);
  assert.ok((await compare(page, await picture(page, 'view'), both)).drawn < 0.7 * drawn);
  await page.getByLabel('second', { exact: true }).check();
  // So are its edges.
  await page.getByLabel('Edges', { exact: true }).check();
  await quiet(page);
  const bothEdged = await picture(page, 'view');
  await page.getByLabel('second', { exact: true }).uncheck();
  await quiet(page);
  const oneEdged = await picture(page, 'view');
  const [drawnEdged, leftEdged] = [
    (await compare(page, bothEdged, oneEdged)).drawn,
    (await compare(page, oneEdged, bothEdged)).drawn,
  ];
  assert.ok(leftEdged < 0.7 * drawnEdged, `${leftEdged} of ${drawnEdged} with edges`);
  assert.deepEqual(faults, []);
});

test('the server refines what the kernel cannot', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  const asked = page.waitForRequest(/refined\?/);
  await drop(page, 'skinned.glb', skinnedGlb());
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  await asked;
  await page.locator('.panel[data-mode=view][data-by=server][data-state=done]').waitFor();
  assert.deepEqual(faults, []);
});

test('a double click moves the camera towards the point', async () => {
  const { page } = await open();
  await madeHere(page);
  await quiet(page);
  const distance = async () => {
    const [ex, ey, ez, tx, ty, tz] = new URLSearchParams(new URL(page.url()).hash.slice(1))
      .get('camera')
      .split(',')
      .map(Number);
    return Math.hypot(ex - tx, ey - ty, ez - tz);
  };
  await drag(page, 5, 0); // the link has the camera once it has moved
  await quiet(page);
  const before = await distance();
  // Where the knot is: it is not drawn in its middle.
  const box = await page.locator('#stage').boundingBox();
  for (let x = box.x + 0.3 * box.width; x < box.x + 0.7 * box.width; x += 25) {
    await page.mouse.dblclick(x, box.y + box.height / 2);
    await quiet(page);
    // The link follows the camera a while later; a second click would go nearer still.
    for (let i = 0; i < 10 && (await distance()) > 0.9 * before; ++i) await page.waitForTimeout(100);
    if ((await distance()) < 0.9 * before) break;
  }
  // On its way the camera is anywhere between.
  const isThere = async () => Math.abs((await distance()) / before - 0.5) < 0.01;
  for (let i = 0; i < 100 && !(await isThere()); ++i) await page.waitForTimeout(100);
  const after = await distance();
  assert.ok(Math.abs(after / before - 0.5) < 0.01, `${after} of ${before}`);
});

test('the point under the cursor stays while the wheel zooms', async () => {
  const { page } = await open();
  await madeHere(page);
  await drag(page, 5, 0); // the link has the camera once it has moved
  await quiet(page);
  const box = await page.locator('.panel[data-mode=view]').boundingBox();
  const camera = () => {
    const numbers = new URLSearchParams(new URL(page.url()).hash.slice(1)).get('camera').split(',').map(Number);
    const [eye, target] = [numbers.slice(0, 3), numbers.slice(3)];
    return { eye, forward: between(eye, target) };
  };
  const between = (from, to) => to.map((x, i) => x - from[i]);
  const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
  const angle = (a, b) => Math.acos(Math.min(1, dot(a, b) / Math.sqrt(dot(a, a) * dot(b, b))));
  const ways = [];
  for (const [x, y] of [
    [-0.6, 0.3],
    [0.6, 0.3],
    [0, -0.5],
  ]) {
    const before = camera();
    await page.mouse.move(box.x + (0.5 + x / 2) * box.width, box.y + (0.5 - y / 2) * box.height);
    for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, -120);
    for (let i = 0; i < 50 && angle(before.eye, camera().eye) === 0; ++i) await page.waitForTimeout(100);
    await quiet(page);
    const after = camera();
    // The camera goes along the ray through the cursor, and does not turn.
    const way = between(before.eye, after.eye);
    const tangent = Math.tan(Math.PI / 8); // of half the angle of view
    const ofCursor = Math.atan(Math.hypot((x * box.width) / box.height, y) * tangent);
    assert.ok(Math.abs(angle(way, before.forward) - ofCursor) < 0.02, `${angle(way, before.forward)}, not ${ofCursor}`);
    assert.ok(angle(before.forward, after.forward) < 0.01);
    assert.ok(dot(way, way) > 0.01 * dot(before.forward, before.forward));
    ways.push(way);
  }
  assert.ok(angle(ways[0], ways[1]) > 0.3 && angle(ways[0], ways[2]) > 0.3);
});

test('a fine mesh is refined for the picture, not to millions of faces', async () => {
  const { page, faults } = await open();
  await madeHere(page);
  await drop(page, 'elephant.obj', readFileSync(join(meshes, 'elephant2000.obj')));
  await page.waitForFunction(() => document.title.startsWith('elephant'));
  await madeHere(page);
  const faces = await facesOf(page, 'view');
  assert.ok(faces > 4000 && faces < 64_000, `${faces}`);
  assert.deepEqual(faults, []);
});

for (const [what, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a phone', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true }],
])
  test(`the initial page has no axe-core violations: ${what}`, async () => {
    const { page } = await open(options);
    await madeHere(page);
    await page.evaluate(readFileSync(axeSource, 'utf8'));
    for (const ground of ['Plain', 'Light', 'Dark', 'Studio']) {
      await page.getByLabel(ground, { exact: true }).check();
      const found = await page.evaluate(async () => (await globalThis.axe.run()).violations);
      const told = found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' ')}`);
      assert.deepEqual(told, [], ground);
    }
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${overflow} pixels wider than the screen`);
  });
