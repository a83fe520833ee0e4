// Packed models of two materials, and with colours of vertices, in the viewer: every level is shown with them.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

import { pack, unpack } from '../npm/packed.mjs';
import { build, compare, drop, openPage, picture, serverAndBrowser } from './browser.mjs';

const shared = serverAndBrowser();
const folder = mkdtempSync(join(tmpdir(), 'papilio-materials-'));
after(() => rmSync(folder, { recursive: true }));

const models = {
  parted: { ...pack('cushion', folder, { isParted: true }), colours: ['red', 'blue'] },
  coloured: { ...pack('waves', folder, { isColoured: true }), colours: ['green', 'blue'] },
};

const papilio = (...words) => execFileSync(join(build, 'papilio'), words, { encoding: 'utf8', stdio: 'pipe' });
const slider = (page) => page.getByLabel('Levels of detail');
const facesAt = ({ report }, level) => [report.base, ...report.levels][level].faces;
const shows = (page, model, level) =>
  page.locator(`.panel[data-mode=coarse][data-faces="${facesAt(model, level)}"][data-state=done]`).waitFor();

async function open(model, level) {
  const opened = await openPage(shared.browser, shared.server.url, { hash: '' });
  const { page } = opened;
  await page.locator('.panel[data-mode=view][data-by=here][data-state=done]').waitFor();
  await page.evaluate(() => (document.getElementById('advanced').open = false));
  await drop(page, 'model.glb', readFileSync(model.packed));
  await shows(page, model, model.report.levels.length);
  await slider(page).fill(String(level));
  await shows(page, model, level);
  return opened;
}

/// Each of the model's colours is in the picture: pixels that have clearly more of it than of the one at the other end.
async function requireColours(page, { colours }, taken) {
  const shares = await page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    const made = { red: 0, green: 0, blue: 0 };
    for (let i = 0; i < data.length; i += 4) {
      const [red, green, blue] = data.subarray(i, i + 3);
      if (red > 1.5 * blue + 20) made.red += 4 / data.length;
      if (green > 1.5 * blue + 20) made.green += 4 / data.length;
      if (blue > 1.5 * Math.min(red, green) + 20) made.blue += 4 / data.length;
    }
    return made;
  }, taken.toString('base64'));
  for (const name of colours) assert.ok(shares[name] > 0.01, `${name}: ${JSON.stringify(shares)}`);
}

for (const [name, model] of Object.entries(models)) {
  const last = model.report.levels.length;

  test(`${name}: every level is shown with its colours`, async () => {
    const { page, faults } = await open(model, 0);
    await page.locator('#wipe').fill('1000'); // all of the picture is what was opened
    const pictures = [];
    for (let level = 0; level <= last; ++level) {
      await slider(page).fill(String(level));
      await shows(page, model, level);
      pictures.push(await picture(page, 'view'));
      await requireColours(page, model, pictures.at(-1));
    }
    const { differing } = await compare(page, pictures[0], pictures[last]);
    assert.ok(differing > 0.005, `${differing}`);
    assert.deepEqual(faults, []);
    if (process.env.PAPILIO_SHOTS)
      for (const level of [0, last])
        writeFileSync(join(process.env.PAPILIO_SHOTS, `${name}-${level}.png`), pictures[level]);
  });

  test(`${name}: a level refined in this browser keeps its colours`, async () => {
    const { page, faults } = await open(model, 0);
    await page.locator('#wipe').fill('0'); // all of the picture is what is refined
    await page.waitForFunction(
      (least) => Number(document.querySelector('.panel[data-mode=view][data-by=here]')?.dataset.faces) > least,
      facesAt(model, 0),
    );
    await requireColours(page, model, await picture(page, 'view'));
    assert.deepEqual(faults, []);
  });

  test(`${name}: the server refines the visible level with its colours, from a mesh without gaps`, async () => {
    const { page, faults } = await open(model, 1);
    const sent = [];
    page.on('request', (request) => {
      const body = request.postDataBuffer();
      if (body?.toString('latin1', 0, 4) === 'glTF') sent.push(body);
    });
    await page.evaluate(() => (document.getElementById('advanced').open = true));
    await page.locator('input[name=mode][value=uniform]').check();
    await page.locator('#parameter-levels').fill('1');
    await page.locator('#parameter-levels').blur();
    const wanted = 4 * facesAt(model, 1);
    await page.locator(`.panel[data-mode=uniform][data-faces="${wanted}"][data-state=done][data-by=server]`).waitFor();
    await requireColours(page, model, await picture(page, 'uniform'));
    const [scene, welded, level] = ['sent.glb', 'sent.obj', 'level.obj'].map((file) => join(folder, file));
    writeFileSync(scene, sent[0]);
    papilio('convert', scene, welded);
    papilio('unpack', model.packed, '-o', level, '--levels', '1');
    const edges = (file) => {
      const { faces, boundary_edges, closed } = JSON.parse(papilio('info', '--json', file));
      return { faces, boundary_edges, closed };
    };
    assert.deepEqual(edges(welded), edges(level));
    assert.deepEqual(faults, []);
  });

  test(`${name}: Save writes a packed model of the visible levels`, async () => {
    const { page } = await open(model, 1);
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator('.panel[data-mode=coarse] button', { hasText: 'Save' }).click({ force: true }),
    ]);
    const saved = join(folder, 'saved.glb');
    writeFileSync(saved, readFileSync(await download.path()));
    assert.deepEqual(unpack(saved, 10), unpack(model.packed, 1));
  });
}
