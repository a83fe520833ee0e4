// The distance of a packed model's level to an original that the user has, in the viewer.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';

import { pack } from '../npm/packed.mjs';
import { axeSource, build, compare, drop, facesOf, openPage, picture, serverAndBrowser } from './browser.mjs';
import { cubeObj } from './mesh_files.mjs';

const shared = serverAndBrowser();
const folder = mkdtempSync(join(tmpdir(), 'papilio-original-'));
after(() => rmSync(folder, { recursive: true }));
const { packed, original, report } = pack('cushion', folder);
const glb = readFileSync(packed);
const levels = [report.base, ...report.levels];
const last = levels.length - 1;

const slider = (page) => page.getByLabel('Levels of detail');
const faces = (page, level) =>
  page.locator(`.panel[data-mode=coarse][data-faces="${levels[level].faces}"][data-state=done]`).waitFor();
const words = (page) => page.locator('#compare-words');
const measured = (page) => words(page).getByText('Between this level and').waitFor();

/// The page with the packed model.
async function open(options = {}) {
  const opened = await openPage(shared.browser, shared.server.url, { hash: '', ...options });
  const { page } = opened;
  await page.locator('.panel[data-mode=view][data-state=done]').waitFor();
  await page.evaluate(() => (document.getElementById('advanced').open = false));
  await drop(page, 'cushion.glb', glb);
  await faces(page, last);
  return opened;
}

const choose = (page, file) => page.getByLabel('Compare with the original…').setInputFiles(file);

/// What `papilio compare` says of a level and an original.
function compared(level, to = original) {
  const file = join(folder, 'level.ply');
  execFileSync(join(build, 'papilio'), ['unpack', packed, '-o', file, '--levels', level], { stdio: 'pipe' });
  return JSON.parse(execFileSync(join(build, 'papilio'), ['compare', '--json', to, file]));
}

/// Shares of the diagonal and distances, as the page says them.
function numbersIn(text) {
  const match = /RMS distance (\S+) % of the original's diagonal \((\S+) in .* file\), largest (\S+) % \((\S+)\)/.exec(
    text,
  );
  assert.ok(match, text);
  return match.slice(1).map(Number);
}

function assertClose(made, expected, what) {
  assert.ok(Math.abs(made - expected) <= 0.03 * expected, `${what}: ${made}, papilio compare says ${expected}`);
}

function assertAsCompared(text, { rms, hausdorff, diagonal }) {
  assert.ok(rms > 0 && hausdorff > rms);
  const made = numbersIn(text);
  for (const [i, distance] of [rms, hausdorff].entries()) {
    assertClose(made[2 * i], (100 * distance) / diagonal, 'share of the diagonal');
    assertClose(made[2 * i + 1], distance, 'distance');
  }
}

test('the distance of each level equals the result of papilio compare', async () => {
  const { page, faults } = await open();
  await choose(page, original);
  for (const level of [last, 0, 1]) {
    await slider(page).fill(String(level));
    await faces(page, level);
    await measured(page);
    assertAsCompared(await words(page).innerText(), compared(level));
    assert.ok((await words(page).innerText()).includes(basename(original)));
  }
  assert.deepEqual(faults, []);
});

test('an original of any format is measured, also dropped beside the levels', async () => {
  const { page, faults } = await open();
  const expected = compared(last);
  for (const extension of ['ply', 'stl', 'glb', 'off']) {
    const file = join(folder, `original.${extension}`);
    execFileSync(join(build, 'papilio'), ['convert', original, file], { stdio: 'pipe' });
    await dropOn(page, '#packed', `original.${extension}`, readFileSync(file));
    await words(page).getByText(`Between this level and original.${extension},`).waitFor();
    assertAsCompared(await words(page).innerText(), expected);
  }
  assert.equal(await facesOf(page, 'coarse'), levels[last].faces);
  assert.ok(await page.locator('#drop-hint').isHidden());
  assert.deepEqual(faults, []);
});

/// Drops a file on an element.
async function dropOn(page, selector, name, bytes) {
  const transfer = await page.evaluateHandle(
    ([name, text]) => {
      const data = new DataTransfer();
      data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
      return data;
    },
    [name, bytes.toString('base64')],
  );
  for (const event of ['dragover', 'drop']) await page.dispatchEvent(selector, event, { dataTransfer: transfer });
}

test('the visible level is coloured by its distance, also after a switch of levels', async () => {
  const { page, faults } = await open();
  await page.locator('#wipe').fill('1000'); // all of the picture is what was opened
  await slider(page).fill('0');
  await faces(page, 0);
  await choose(page, original);
  await measured(page);
  const plain = await picture(page, 'coarse');
  const colour = page.getByLabel('Colour the model by this distance');
  await colour.check();
  const legend = page.locator('.panel[data-mode=coarse] .legend');
  await legend.getByText('largest here').waitFor();
  const { hausdorff, diagonal } = compared(0);
  assertClose(
    parseFloat(/largest here (\S+) %/.exec(await legend.innerText())[1]),
    (100 * hausdorff) / diagonal,
    'legend',
  );
  const first = await picture(page, 'coarse');
  assert.ok((await compare(page, plain, first)).differing > 0.1);
  await slider(page).fill('1');
  await faces(page, 1);
  await measured(page);
  await legend.getByText('largest here').waitFor();
  assert.ok((await compare(page, first, await picture(page, 'coarse'))).differing > 0.01);
  await slider(page).fill('0');
  await faces(page, 0);
  await measured(page);
  await colour.uncheck();
  assert.equal(await legend.innerText(), '');
  assert.ok((await compare(page, plain, await picture(page, 'coarse'))).differing < 0.001);
  assert.deepEqual(faults, []);
});

test('a file that is not a mesh is reported, and the measured original stays', async () => {
  const { page } = await open();
  await choose(page, original);
  await measured(page);
  const before = await words(page).innerText();
  const tell = page.locator('#alert-text');
  await choose(page, { name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('x') });
  await tell.getByText('notes.txt is no mesh file').waitFor();
  await choose(page, { name: 'empty.obj', mimeType: 'text/plain', buffer: Buffer.from('v 0 0 0\n') });
  await tell.getByText('empty.obj: holds no triangles').waitFor();
  await choose(page, { name: 'broken.glb', mimeType: 'model/gltf-binary', buffer: glb.subarray(0, 300) });
  await tell.getByText('broken.glb cannot be read').waitFor();
  assert.equal(await words(page).innerText(), before);
  await page.getByRole('button', { name: 'Stop comparing' }).click();
  assert.equal(await words(page).innerText(), '');
  await choose(page, original);
  await measured(page);
});

test('only packed models are compared, each with its own original', async () => {
  const { page } = await open();
  await choose(page, original);
  await measured(page);
  await drop(page, 'again.glb', glb);
  await page.waitForFunction(() => document.getElementById('compare-words').textContent === '');
  await drop(page, 'cube.obj', cubeObj());
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  assert.ok(await page.locator('#compare').isHidden());
});

for (const [what, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a phone', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true }],
])
  test(`the page of a comparison has no axe-core violations: ${what}`, async () => {
    const { page } = await open(options);
    await choose(page, original);
    await measured(page);
    await page.getByLabel('Colour the model by this distance').check();
    await page.locator('.panel[data-mode=coarse] .legend').getByText('largest here').waitFor();
    await page.evaluate(readFileSync(axeSource, 'utf8'));
    const found = await page.evaluate(async () => (await globalThis.axe.run()).violations);
    assert.deepEqual(
      found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' ')}`),
      [],
    );
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${overflow} pixels wider than the screen`);
  });
