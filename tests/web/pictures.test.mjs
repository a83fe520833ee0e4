// What is seen of a mesh, how the pointer moves it, and that nothing of the page is in its way.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import {
  compare,
  done,
  drag,
  drop,
  facesOf,
  meshes,
  openPage,
  picture,
  serverAndBrowser,
  shades,
  tasksOf,
} from './browser.mjs';
import { compressedCubeGlb, quantizedCubeGlb } from './mesh_files.mjs';

const shared = serverAndBrowser();
const open = (hash, options = {}) => openPage(shared.browser, shared.server.url, { hash, ...options });
const madeHere = (page) => page.locator('.panel[data-mode=view][data-by=here][data-state=done]').waitFor();
const quiet = (page) => page.waitForTimeout(700);

/// The elephant of 2,000 faces, refined here to at least so many.
async function openElephant(faces, look) {
  const values = 'view.edge_pixels=0&output.normals=true&view.error_pixels=0.5';
  const { page, faults } = await open(`mesh=knot&show=view&where=here&look=${look}&${values}`);
  await madeHere(page);
  await drop(page, 'elephant.obj', readFileSync(join(meshes, 'elephant2000.obj')));
  await page.waitForFunction(() => document.title.startsWith('elephant'));
  await madeHere(page);
  for (let pixels = 0.25; (await facesOf(page, 'view')) < faces && pixels > 1e-3; pixels /= 2) {
    await page.locator('[id="parameter-view.error_pixels"]').fill(String(pixels));
    await page.keyboard.press('Enter');
    await quiet(page);
    await madeHere(page);
  }
  assert.ok((await facesOf(page, 'view')) >= faces);
  return { page, faults };
}

test('a shaded surface is smooth: its shades are not one for each face', async () => {
  const stepsOf = async (where, normals) => {
    const view = `view.error_pixels=8&output.normals=${normals}`;
    const { page } = await open(`mesh=knot&show=view&look=shaded&where=${where}&${view}`);
    await page.locator(`.panel[data-mode=view][data-by=${where}][data-state=done]`).waitFor();
    return (await shades(page, await picture(page, 'view'))).steps;
  };
  const faceted = await stepsOf('server', false);
  for (const where of ['here', 'server']) {
    const smooth = await stepsOf(where, true);
    assert.ok(smooth < 0.6 * faceted, `${where}: ${smooth} and, with facets, ${faceted} of the pixels are at a step`);
  }
});

test('the edges of 70,000 faces leave the shades of the surface to be seen', async () => {
  const { page, faults } = await openElephant(70_000, 'wireframe');
  const edges = await shades(page, await picture(page, 'view'));
  await page.getByLabel('Shaded', { exact: true }).check();
  await quiet(page);
  const shaded = await shades(page, await picture(page, 'view'));
  assert.ok(edges.mean > 0.6 * shaded.mean, `lightness ${edges.mean}; without edges ${shaded.mean}`);
  assert.ok(edges.spread > 0.5 * shaded.spread, `spread ${edges.spread}; without edges ${shaded.spread}`);
  assert.deepEqual(faults, []);
});

test('no task of the page takes 50 ms of the processor while a mesh of 70,000 faces is turned and refined', async () => {
  for (const look of ['shaded', 'wireframe']) {
    const { page } = await openElephant(70_000, look);
    const before = await facesOf(page, 'view');
    const box = await page.locator('#stage').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 3];
    await shared.browser.startTracing(page, { categories: ['toplevel'] });
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let step = 1; step <= 20; ++step) {
      await page.mouse.move(x + 4 * step, y + step);
      await page.waitForTimeout(30);
    }
    await page.mouse.up();
    await madeHere(page);
    await quiet(page);
    const { processor } = tasksOf(await shared.browser.stopTracing());
    assert.ok(processor.length > 50, `${processor.length} tasks`);
    assert.deepEqual(
      processor.filter((milliseconds) => milliseconds > 50),
      [],
      look,
    );
    assert.notEqual(await facesOf(page, 'view'), before, 'it was refined anew');
    await page.context().close();
  }
});

test('each background is another picture', async () => {
  const { page } = await open('mesh=knot&show=view&where=here');
  await madeHere(page);
  const seen = [];
  for (const ground of ['Light', 'Dark', 'Studio']) {
    await page.getByLabel(ground, { exact: true }).check();
    const now = await picture(page, 'view');
    for (const before of seen) assert.ok((await compare(page, now, before)).differing > 0.3, ground);
    seen.push(now);
  }
});

test('the wheel zooms to the cursor: what is under it stays there', async () => {
  const { page } = await open('mesh=knot&show=view&where=here');
  await madeHere(page);
  await quiet(page);
  const cameraAfter = async (x, y) => {
    await page.mouse.move(x, y);
    for (let turn = 0; turn < 4; ++turn) await page.mouse.wheel(0, -200);
    await quiet(page);
    const camera = new URLSearchParams(new URL(page.url()).hash.slice(1)).get('camera').split(',').map(Number);
    return { eye: camera.slice(0, 3), target: camera.slice(3) };
  };
  const box = await page.locator('#stage').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const first = await cameraAfter(x, y);
  const second = await cameraAfter(x + box.width / 4, y);
  const distance = ([a, b, c], [d, e, f]) => Math.hypot(a - d, b - e, c - f);
  const before = distance(first.eye, first.target);
  assert.ok(distance(second.eye, second.target) < 0.9 * before);
  assert.ok(distance(first.target, second.target) > 0.02 * before, 'the target moves towards what is pointed at');
});

test('dragging turns the mesh, and selects no text', async () => {
  const { page } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const before = await picture(page, 'coarse');
  const head = await page.locator('.panel[data-mode=view] h2').boundingBox();
  await page.mouse.move(head.x + 2, head.y + head.height / 2);
  await page.mouse.down();
  for (let step = 1; step <= 5; ++step) await page.mouse.move(head.x + 40 * step, head.y + 20 * step);
  await page.mouse.up();
  assert.equal(await page.evaluate(() => String(getSelection())), '');
  await drag(page, 100, 20);
  assert.equal(await page.evaluate(() => String(getSelection())), '');
  assert.ok((await compare(page, before, await picture(page, 'coarse'))).differing > 0.01);
});

for (const width of [1000, 1440])
  test(`the figures of four meshes are seen whole at ${width} pixels`, async () => {
    const { page } = await openPage(shared.browser, shared.server.url, { viewport: { width, height: 900 } });
    await done(page);
    const cut = await page.evaluate(() =>
      ['#figures .scroll', 'aside'].map((name) => {
        const { scrollWidth, clientWidth } = document.querySelector(name);
        return scrollWidth - clientWidth;
      }),
    );
    assert.deepEqual(cut, [0, 0]);
  });

test('on a phone the mesh is turned by a finger, and buttons leave it uncovered', async () => {
  const { page } = await open('', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true });
  await madeHere(page);
  await quiet(page);
  const covered = await page.evaluate(() => {
    const stage = document.getElementById('panels').getBoundingClientRect();
    const middle = { top: stage.top + 0.25 * stage.height, bottom: stage.top + 0.8 * stage.height };
    const over = [...document.querySelectorAll('button, .button, select, input:not(#wipe), label')].filter(
      (control) => {
        const box = control.getBoundingClientRect();
        return control.checkVisibility() && box.height > 1 && box.bottom > middle.top && box.top < middle.bottom;
      },
    );
    return { over: over.map((control) => control.outerHTML.slice(0, 80)), share: stage.height / innerHeight };
  });
  assert.deepEqual(covered.over, []);
  assert.ok(covered.share > 0.3, `the picture has ${covered.share} of the screen`);
  const before = await picture(page, 'view');
  const finger = await page.context().newCDPSession(page);
  const box = await page.locator('#panels').boundingBox();
  const [x, y] = [box.x + 0.3 * box.width, box.y + 0.4 * box.height];
  const touch = (type, ...touchPoints) => finger.send('Input.dispatchTouchEvent', { type, touchPoints });
  await touch('touchStart', { x, y });
  for (let step = 1; step <= 5; ++step) await touch('touchMove', { x: x + 25 * step, y: y + 5 * step });
  await touch('touchEnd');
  await quiet(page);
  assert.ok((await compare(page, before, await picture(page, 'view'))).differing > 0.01, 'it was turned');
});

test('quantized and meshopt-compressed .glb files are opened and refined', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  for (const [name, bytes] of [
    ['quantized.glb', quantizedCubeGlb()],
    ['compressed.glb', await compressedCubeGlb()],
  ]) {
    await drop(page, name, bytes);
    await page.waitForFunction((title) => document.title === title, `${name} – Papilio`);
    await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
    await page.locator('.panel[data-mode=uniform][data-faces="768"][data-state=done]').waitFor();
    await done(page);
    assert.ok((await shades(page, await picture(page, 'uniform'))).drawn > 0.05, name);
    await page.locator('#sample').selectOption('wheel');
    await page.locator('.panel[data-mode=coarse][data-faces="290"]').waitFor();
    await done(page);
  }
  assert.deepEqual(faults, []);
});
