// Packed models with texture coordinates and a material in the viewer: every level is shown with its texture.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

import { checkerPng, pack, unpack } from '../npm/packed.mjs';
import { compare, drop, facesOf, openPage, picture, serverAndBrowser } from './browser.mjs';

const shared = serverAndBrowser();
const folder = mkdtempSync(join(tmpdir(), 'papilio-packed-'));
after(() => rmSync(folder, { recursive: true }));
const { packed, original, report } = pack('cushion', folder, { isTextured: true });
const glb = readFileSync(packed);
const levels = [report.base, ...report.levels];
const last = levels.length - 1;

const slider = (page) => page.getByLabel('Levels of detail');
const faces = (page, level) =>
  page.locator(`.panel[data-mode=coarse][data-faces="${levels[level].faces}"][data-state=done]`).waitFor();

async function open() {
  const opened = await openPage(shared.browser, shared.server.url, { hash: '' });
  const { page } = opened;
  await page.locator('.panel[data-mode=view][data-by=here][data-state=done]').waitFor();
  await page.evaluate(() => (document.getElementById('advanced').open = false));
  await drop(page, 'cushion.glb', glb);
  await faces(page, last);
  return opened;
}

/// Shares of the pixels that are as orange or as blue as the texture's.
function shares(page, taken) {
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    const made = { orange: 0, blue: 0 };
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] > 1.5 * data[i + 2] + 20) made.orange += 4 / data.length;
      if (data[i + 2] > 2 * data[i] + 20) made.blue += 4 / data.length;
    }
    return made;
  }, taken.toString('base64'));
}

async function requireTexture(page, mode) {
  const { orange, blue } = await shares(page, await picture(page, mode));
  assert.ok(orange > 0.03 && blue > 0.03, `orange ${orange}, blue ${blue}`);
}

test('every level is shown with its texture, with the figures and bytes of the file', async () => {
  const { page, faults } = await open();
  await page.locator('#wipe').fill('1000'); // all of the picture is what was opened
  const rows = await page.locator('#packed tbody tr').allInnerTexts();
  assert.deepEqual(
    rows.slice(1).map((row) => row.split('\t')[1]),
    levels.slice(1).map(({ bytes, texcoords }) => `+ ${(bytes + (texcoords?.bytes ?? 0)).toLocaleString('en')}`),
  );
  const pictures = [];
  for (let level = 0; level <= last; ++level) {
    await slider(page).fill(String(level));
    await faces(page, level);
    await requireTexture(page, 'view');
    pictures.push(await picture(page, 'view'));
  }
  const { differing } = await compare(page, pictures[0], pictures[last]);
  assert.ok(differing > 0.01, `${differing}`);
  assert.deepEqual(faults, []);
});

test('a level refined in this browser keeps the texture', async () => {
  const { page, faults } = await open();
  await slider(page).fill('0');
  await faces(page, 0);
  await page.locator('#wipe').fill('0'); // all of the picture is what is refined
  await page.waitForFunction(
    (least) => Number(document.querySelector('.panel[data-mode=view][data-by=here]')?.dataset.faces) > least,
    levels[0].faces,
  );
  await requireTexture(page, 'coarse');
  assert.deepEqual(faults, []);
});

test('the server refines the visible level, as a scene with the texture', async () => {
  const { page, faults } = await open();
  await slider(page).fill('1');
  await faces(page, 1);
  await page.evaluate(() => (document.getElementById('advanced').open = true));
  await page.locator('input[name=mode][value=uniform]').check();
  await page.locator('#parameter-levels').fill('1');
  await page.locator('#parameter-levels').blur();
  const wanted = 4 * levels[1].faces;
  await page.locator(`.panel[data-mode=uniform][data-faces="${wanted}"][data-state=done][data-by=server]`).waitFor();
  await requireTexture(page, 'uniform');
  assert.deepEqual(faults, []);
});

test('Save writes a packed model of the visible levels, with its image', async () => {
  const { page } = await open();
  await slider(page).fill('1');
  await faces(page, 1);
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('.panel[data-mode=coarse] button', { hasText: 'Save' }).click({ force: true }),
  ]);
  const saved = join(folder, 'saved.glb');
  writeFileSync(saved, readFileSync(await download.path()));
  assert.ok(readFileSync(saved).includes(checkerPng()));
  assert.deepEqual(unpack(saved, 10), unpack(packed, 1));
});

test('colours by the distance to the original replace the texture, and restore it', async () => {
  const { page, faults } = await open();
  await page.locator('#wipe').fill('1000');
  const textured = await shares(page, await picture(page, 'view'));
  await page.getByLabel('Compare with the original…').setInputFiles(original);
  await page.locator('#compare-words').getByText('RMS distance').waitFor();
  const colour = page.getByLabel('Colour the model by this distance');
  await colour.check();
  await page.locator('.panel[data-mode=coarse] .legend').getByText('largest here').waitFor();
  const { orange } = await shares(page, await picture(page, 'view')); // some: the largest distances are yellow
  assert.ok(orange < textured.orange / 4, `${orange} of ${textured.orange}`);
  await colour.uncheck();
  await requireTexture(page, 'view');
  assert.deepEqual(faults, []);
});

test('a damaged image is reported, and the open mesh stays', async () => {
  const { page } = await open();
  const broken = Buffer.from(glb);
  broken.write('"index":7', broken.indexOf('"index":0'));
  await drop(page, 'broken.glb', broken);
  await page.locator('#alert-text').getByText('broken.glb cannot be read').waitFor();
  assert.equal(await facesOf(page, 'coarse'), levels[last].faces);
});
