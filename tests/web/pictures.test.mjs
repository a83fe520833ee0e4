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
import { compressedCubeGlb, cubeObj, quantizedCubeGlb } from './mesh_files.mjs';

const shared = serverAndBrowser();
const open = (hash, options = {}) => openPage(shared.browser, shared.server.url, { hash, ...options });
const madeHere = (page) =>
  page.locator('.panel[data-mode=view][data-by=here][data-state=done][data-estimate=false]').waitFor();
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

test('a smooth surface has fewer steps of shade than a faceted one', async () => {
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

test('the edges of 70,000 faces leave the shading visible', async () => {
  const { page, faults } = await openElephant(70_000, 'wireframe');
  const edges = await shades(page, await picture(page, 'view'));
  await page.getByLabel('Shaded', { exact: true }).check();
  await quiet(page);
  const shaded = await shades(page, await picture(page, 'view'));
  assert.ok(edges.mean > 0.6 * shaded.mean, `lightness ${edges.mean}; without edges ${shaded.mean}`);
  assert.ok(edges.spread > 0.5 * shaded.spread, `spread ${edges.spread}; without edges ${shaded.spread}`);
  assert.deepEqual(faults, []);
});

test('edges are found in a worker; without it the surface is drawn, and the reason is shown', async () => {
  const { page, faults } = await open('mesh=knot&show=coarse,view&as=wipe&where=here&look=wireframe');
  await madeHere(page);
  const finders = () => page.workers().filter((worker) => /edges_worker/.test(worker.url())).length;
  assert.equal(finders(), 1);
  await quiet(page);
  const edges = await picture(page, 'view');
  await page.getByLabel('Shaded', { exact: true }).check();
  await quiet(page);
  const shaded = await picture(page, 'view');
  assert.ok((await compare(page, edges, shaded)).differing > 0.05, 'edges are drawn');
  assert.deepEqual(faults, []);
  const other = await shared.browser.newContext({ viewport: { width: 1000, height: 700 } });
  const without = await other.newPage();
  await without.route(/edges_worker/, (route) => route.abort());
  await without.goto(`${shared.server.url}#mesh=knot&show=coarse,view&as=wipe&where=here&look=wireframe`);
  await without.getByText('Edges cannot be drawn').waitFor();
  await madeHere(without);
  await without.evaluate(() => (document.getElementById('advanced').open = true));
  await quiet(without);
  assert.ok((await compare(without, await picture(without, 'view'), edges)).drawn > 0.05, 'the surface is drawn');
});

test('no task takes 50 ms of processor time while a mesh of 70,000 faces is rotated and refined', async () => {
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

test('each background changes the picture', async () => {
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

for (const colorScheme of ['light', 'dark'])
  test(`text is readable on each background: ${colorScheme}`, async () => {
    const { page } = await open('mesh=knot&show=coarse,view&as=wipe&where=here', { colorScheme });
    await madeHere(page);
    for (const ground of ['Plain', 'Light', 'Dark', 'Studio']) {
      await page.getByLabel(ground, { exact: true }).check();
      const contrasts = await page.evaluate(() => {
        const canvas = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
        const lightness = (...layers) => {
          for (const layer of layers) {
            canvas.fillStyle = layer;
            canvas.fillRect(0, 0, 1, 1);
          }
          const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map((value) => {
            const share = value / 255;
            return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
          });
          return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const ground = getComputedStyle(document.getElementById('stage')).backgroundColor;
        const page = getComputedStyle(document.documentElement).backgroundColor;
        return [...document.querySelectorAll('.panel-head h2, .panel-head .caption')].map((text) => {
          const { color, backgroundColor } = getComputedStyle(text);
          // On the mesh as well, which is grey.
          return Math.min(
            ...[ground, '#8f9ba8'].map((behind) => {
              const [ink, under] = [lightness(color), lightness(page, behind, backgroundColor)];
              return (Math.max(ink, under) + 0.05) / (Math.min(ink, under) + 0.05);
            }),
          );
        });
      });
      assert.equal(contrasts.length, 4);
      for (const contrast of contrasts) assert.ok(contrast >= 4.5, `${ground}: ${contrasts.join(', ')}`);
    }
  });

test('the wheel zooms to the cursor: the point under it stays', async () => {
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

test('dragging rotates the mesh, and selects no text', async () => {
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
  test(`the figures of four meshes are fully visible at ${width} pixels`, async () => {
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

test('on a phone a finger rotates the mesh, and buttons leave it uncovered', async () => {
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

test('on a phone four meshes side by side are below their captions, also after they were one', async () => {
  const { page } = await open('', { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  await madeHere(page);
  await page.getByRole('radio', { name: 'Side by side' }).check();
  await done(page);
  await quiet(page);
  const heads = await page.locator('.panel-head').all();
  assert.equal(heads.length, 4);
  const boxes = await Promise.all(heads.map((head) => head.boundingBox()));
  await page.evaluate(() => {
    for (const over of document.querySelectorAll('.panel, #wipe, #wipe-line')) over.style.visibility = 'hidden';
  });
  for (const { x, y, width, height } of boxes) {
    const below = await page.screenshot({ clip: { x: x + 2, y: y + 2, width: width - 4, height: height - 4 } });
    assert.ok((await compare(page, below, below)).drawn < 0.01, `at ${x}, ${y}`);
  }
});

test('on a phone in landscape the mesh is below its captions', async () => {
  const { page } = await open('', { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true });
  await madeHere(page);
  await quiet(page);
  const { x, y, width } = await page.locator('#panels').boundingBox();
  const heads = await page.locator('.panel-head').all();
  const bottoms = await Promise.all(heads.map(async (head) => head.boundingBox()));
  const height = Math.max(...bottoms.map((box) => box.y + box.height)) - y;
  await page.evaluate(() => {
    for (const over of document.querySelectorAll('.panel, #wipe, #wipe-line')) over.style.visibility = 'hidden';
  });
  const beside = await page.screenshot({ clip: { x: x + 2, y: y + 2, width: width - 4, height: height - 2 } });
  assert.ok((await compare(page, beside, beside)).drawn < 0.01);
});

test('the handle of the wipe is above all messages below the picture', async () => {
  const { page } = await open('', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true });
  await madeHere(page);
  await drop(page, 'cube.obj', cubeObj());
  await page.getByText('This looks mechanical').waitFor();
  const [handle, strip] = [await page.locator('#wipe').boundingBox(), await page.locator('#cost').boundingBox()];
  assert.ok(handle.y + handle.height <= strip.y, `${handle.y + handle.height} is below ${strip.y}`);
});

test('labels of a slider are at its ends', async () => {
  const { page } = await open('');
  await madeHere(page);
  const slider = await page.locator('#detail').boundingBox();
  const [coarse, fine] = [page.getByText('coarse', { exact: true }), page.getByText('fine', { exact: true })];
  const edges = await page.evaluate(
    (texts) =>
      texts.map((text) => {
        const range = document.createRange();
        range.selectNodeContents(text);
        const { left, right } = range.getBoundingClientRect();
        return { left, right };
      }),
    await Promise.all([coarse, fine].map((text) => text.elementHandle())),
  );
  assert.ok(Math.abs(edges[0].left - slider.x) < 4, `${edges[0].left}`);
  assert.ok(Math.abs(edges[1].right - slider.x - slider.width) < 4, `${edges[1].right}`);
});

test('quantized and meshopt-compressed .glb files open and are refined', async () => {
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
