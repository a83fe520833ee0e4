// Packed models in the viewer: levels, distances, and what is refined of them.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

import { pack, unpack } from '../npm/packed.mjs';
import {
  axeSource,
  compare,
  done,
  drop,
  facesOf,
  openPage,
  picture,
  refinements,
  serverAndBrowser,
} from './browser.mjs';
import { cubeObj } from './mesh_files.mjs';

const shared = serverAndBrowser();
const folder = mkdtempSync(join(tmpdir(), 'papilio-packed-'));
after(() => rmSync(folder, { recursive: true }));
const { packed, report } = pack('cushion', folder);
const glb = readFileSync(packed);
const levels = [report.base, ...report.levels];
const last = levels.length - 1;

const number = (n) => n.toLocaleString('en');
const percent = (share) => `${Number((100 * share).toPrecision(2))} %`;
const madeHere = (page) =>
  page.locator('.panel[data-mode=view][data-by=here][data-state=done][data-estimate=false]').waitFor();
const slider = (page) => page.getByLabel('Levels of detail');

/// The page with the packed model; settings under Advanced are closed, so that nothing is stored for its commands.
async function open(options = {}) {
  const opened = await openPage(shared.browser, shared.server.url, { hash: '', ...options });
  const { page } = opened;
  await madeHere(page);
  await page.evaluate(() => (document.getElementById('advanced').open = false));
  await drop(page, 'cushion.glb', glb);
  await faces(page, last);
  return opened;
}

/// Resolves once this level is shown.
const faces = (page, level) =>
  page.locator(`.panel[data-mode=coarse][data-faces="${levels[level].faces}"][data-state=done]`).waitFor();

test('a packed model opens with all its levels, and shows their sizes and distances', async () => {
  const { page, faults } = await open();
  const rows = await page.locator('#packed tbody tr').allInnerTexts();
  assert.deepEqual(
    rows.map((row) => row.split('\t')),
    levels.map(({ faces, bytes, rms, largest }, l) => [
      l === 0 ? 'base' : `level ${l}`,
      l === 0 ? number(bytes + curveBytes()) : `+ ${number(bytes)}`,
      number(faces),
      percent(rms),
      percent(largest),
    ]),
  );
  assert.equal(await slider(page).inputValue(), String(last));
  assert.equal(await page.locator('#packed output').innerText(), `${last} of ${last}`);
  const words = await page.locator('#packed-words').innerText();
  assert.ok(words.startsWith(`${number(levels[last].faces)} faces from `), words);
  assert.ok(words.includes(`of ${number(glb.length)} in the file`), words);
  assert.ok(words.includes(`RMS distance to the original ${percent(levels[last].rms)} of the diagonal`), words);
  await madeHere(page);
  assert.deepEqual(faults, []);
});

/// Where the table of its levels begins (proto/detail.md).
function tableBegin() {
  const jsonEnd = 20 + glb.readUInt32LE(12);
  const { bufferViews, meshes } = JSON.parse(glb.toString('utf8', 20, jsonEnd));
  return jsonEnd + 8 + bufferViews[meshes[0].primitives[0].extensions.PAPILIO_detail.bufferView].byteOffset;
}

/// Of the packed model, whose report counts them in its container.
const curveBytes = () => glb.readUInt32LE(tableBegin() + 6);

test('the decoder of packed models is fetched with the first one', async () => {
  const context = await shared.browser.newContext();
  const page = await context.newPage();
  const fetched = [];
  page.on('request', (request) => fetched.push(new URL(request.url()).pathname));
  const modules = () => fetched.filter((name) => /papilio-detail.*\.wasm$/.test(name)).length;
  await page.goto(shared.server.url);
  await madeHere(page);
  assert.equal(modules(), 0);
  await drop(page, 'cushion.glb', glb);
  await faces(page, last);
  await slider(page).fill('0');
  await faces(page, 0);
  await drop(page, 'again.glb', glb);
  await faces(page, last);
  assert.equal(modules(), 1);
});

test('the slider shows each level, from the base to the last, and the picture follows', async () => {
  const { page, faults } = await open();
  await page.locator('#wipe').fill('1000'); // all of the picture is what was opened
  const pictures = [];
  await slider(page).focus();
  await page.keyboard.press('Home');
  for (let level = 0; level <= last; ++level) {
    await faces(page, level);
    assert.equal(await page.locator('#packed output').innerText(), `${level} of ${last}`);
    const current = page.locator('#packed [aria-current]');
    assert.ok((await current.innerText()).startsWith(level === 0 ? 'base' : `level ${level}`));
    assert.ok((await page.locator('#packed-words').innerText()).startsWith(`${number(levels[level].faces)} faces`));
    pictures.push(await picture(page, 'view'));
    await page.keyboard.press('ArrowRight');
  }
  const { drawn, differing } = await compare(page, pictures[0], pictures[last]);
  assert.ok(drawn > 0.1 && differing > 0.01, `${drawn}, ${differing}`);
  // Moved at once to and fro, it shows where it came to rest.
  for (const value of ['0', '2', '1', '0', '1']) await slider(page).fill(value);
  await faces(page, 1);
  await page.waitForTimeout(300);
  assert.equal(await facesOf(page, 'coarse'), levels[1].faces);
  assert.deepEqual(faults, []);
});

test('this browser refines the visible level', async () => {
  const { page } = await open();
  const asked = refinements(page);
  const posts = [];
  page.on('request', (request) => request.method() === 'POST' && posts.push(request.url()));
  await slider(page).fill('0');
  await faces(page, 0);
  await page.waitForFunction(
    (text) => document.getElementById('cost').textContent.startsWith(text),
    `${number(levels[0].faces)} → `,
  );
  await madeHere(page);
  const refined = await facesOf(page, 'view');
  assert.ok(refined > levels[0].faces, `${refined}`);
  await page.locator('#detail').fill('0');
  await page.waitForFunction(
    (most) => Number(document.querySelector('.panel[data-mode=view]').dataset.faces) < most,
    refined,
  );
  assert.deepEqual([asked, posts], [[], []]);
});

test('the server refines the visible level', async () => {
  const { page, faults } = await open();
  await slider(page).fill('1');
  await faces(page, 1);
  await page.evaluate(() => (document.getElementById('advanced').open = true));
  await page.locator('input[name=mode][value=uniform]').check();
  await page.locator('#parameter-levels').fill('1');
  await page.locator('#parameter-levels').blur();
  await page
    .locator(`.panel[data-mode=uniform][data-faces="${4 * levels[1].faces}"][data-state=done][data-by=server]`)
    .waitFor();
  assert.deepEqual(faults, []);
});

/// The packed model with further levels to so many, without residuals.
function withMoreLevels(count) {
  const jsonEnd = 20 + glb.readUInt32LE(12);
  const json = JSON.parse(glb.toString('utf8', 20, jsonEnd));
  const begin = tableBegin();
  const more = Buffer.alloc(16 * (count - glb[begin]));
  for (let at = 0; at < more.length; at += 16)
    for (const [i, number] of [1e-30, 0.001, 0.01].entries()) more.writeFloatLE(number, at + 4 * i);
  const rowsEnd = begin + 18 + 16 * glb[begin];
  const binary = Buffer.concat([glb.subarray(jsonEnd + 8, rowsEnd), more, glb.subarray(rowsEnd)]);
  binary[begin - jsonEnd - 8] = count;
  json.bufferViews[1].byteLength += more.length;
  json.buffers[0].byteLength += more.length;
  const text = JSON.stringify(json);
  const padded = text.padEnd(Math.ceil(text.length / 4) * 4);
  const made = Buffer.concat([glb.subarray(0, 20), Buffer.from(padded), glb.subarray(jsonEnd, jsonEnd + 8), binary]);
  made.writeUInt32LE(made.length, 8);
  made.writeUInt32LE(padded.length, 12);
  made.writeUInt32LE(binary.length, 20 + padded.length);
  return made;
}

test('a model with very many faces opens at a level that browsers show smoothly', async () => {
  const { page } = await open();
  const most = Math.floor(Math.log(300_000 / levels[0].faces) / Math.log(4));
  assert.ok(most > last);
  await drop(page, 'many.glb', withMoreLevels(most + 1));
  await page.locator(`.panel[data-mode=coarse][data-faces="${levels[0].faces * 4 ** most}"]`).waitFor();
  assert.equal(await page.locator('#packed output').innerText(), `${most} of ${most + 1}`);
});

test('Save writes a packed model of the visible levels', async () => {
  const { page } = await open();
  await slider(page).fill('1');
  await faces(page, 1);
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('.panel[data-mode=coarse] button', { hasText: 'Save' }).click({ force: true }),
  ]);
  assert.equal(download.suggestedFilename(), 'cushion-coarse.glb');
  const saved = join(folder, 'saved.glb');
  writeFileSync(saved, readFileSync(await download.path()));
  const [made, expected] = [unpack(saved, 10), unpack(packed, 1)];
  assert.deepEqual([made.positions, made.triangles], [expected.positions, expected.triangles]);
});

test('other files hide the levels, and damaged ones leave the open mesh', async () => {
  const { page } = await open();
  const tell = page.locator('#alert-text');
  const broken = Buffer.from(glb);
  broken.write('"version":7', broken.indexOf('"version":3'));
  await drop(page, 'later.glb', broken);
  await tell.getByText('PAPILIO_detail has version 7; version 3 is supported').waitFor();
  const cut = glb.subarray(0, glb.length - 4);
  await drop(page, 'cut.glb', cut);
  await tell.getByText('The .glb header declares').waitFor();
  assert.equal(await facesOf(page, 'coarse'), levels[last].faces);
  assert.ok(await slider(page).isVisible());
  await drop(page, 'cube.obj', cubeObj());
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  assert.ok(!(await slider(page).isVisible()));
  await drop(page, 'cushion.glb', glb);
  await faces(page, last);
  assert.ok(await slider(page).isVisible());
});

for (const [what, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a phone', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true }],
])
  test(`the page of a packed model has no axe-core violations: ${what}`, async () => {
    const { page } = await open(options);
    await madeHere(page);
    await page.evaluate(readFileSync(axeSource, 'utf8'));
    for (const level of [last, 0]) {
      await slider(page).fill(String(level));
      await faces(page, level);
      const found = await page.evaluate(async () => (await globalThis.axe.run()).violations);
      const told = found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' ')}`);
      assert.deepEqual(told, []);
    }
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${overflow} pixels wider than the screen`);
  });
