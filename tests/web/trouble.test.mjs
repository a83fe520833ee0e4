// What the viewer says and does when something goes wrong, and who can use it.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import {
  axeSource,
  done,
  drag,
  drop,
  facesOf,
  fourWays,
  meshes,
  openPage,
  run,
  serverAndBrowser,
  startServer,
} from './browser.mjs';

const shared = serverAndBrowser();

const message = (page, mode) => page.locator(`.panel[data-mode=${mode}] .message`);

// At once, unless the page has just tried again by itself, which takes the button away.
const tryAgain = (page) =>
  message(page, 'view')
    .getByRole('button')
    .click({ timeout: 1000 })
    .catch(() => {});

test('a result beyond a limit is refused in its panel, with the number; the others arrive', async () => {
  const small = await startServer('--max-output-faces', '10000', '--max-body-bytes', '1200');
  try {
    const { page, faults } = await openPage(shared.browser, small.url, {
      countRefusals: false,
    });
    await done(page, ['coarse', 'adaptive', 'view']);
    await message(page, 'uniform').filter({ hasText: '22016' }).waitFor();
    await page.locator('[id="parameter-levels"]').fill('2');
    await page.keyboard.press('Enter');
    await done(page);
    assert.equal(await message(page, 'uniform').innerText(), '');
    // A file beyond what the server takes is not sent at all.
    await drop(page, 'bunny.drc', readFileSync(join(meshes, 'bunny600.drc')));
    await page.locator('#alert-text', { hasText: '1543 bytes; this server takes 1200' }).waitFor();
    assert.equal(await facesOf(page, 'coarse'), 344);
    assert.deepEqual(faults, []);
  } finally {
    await small.stop();
  }
});

test('a busy server is retried automatically, and at once on request', async () => {
  const small = await startServer('--slots', '1', '--queue', '0');
  let isOver = false;
  const mesh = readFileSync(join(meshes, 'bunny600.drc'));
  const occupy = async () => {
    while (!isOver) {
      const headers = { 'Content-Type': 'application/x-draco' };
      const request = { method: 'POST', headers, body: mesh };
      // A connection that was kept may have been closed meanwhile.
      const answer = await fetch(`${small.url}v1/refine?levels=5`, request).catch(() => null);
      await answer?.arrayBuffer();
      if (answer?.status !== 200) await new Promise((resolve) => setTimeout(resolve, 20)); // the page needs a processor, too
    }
  };
  const { page } = await openPage(shared.browser, small.url, {
    countRefusals: false,
    hash: 'mesh=mug&show=coarse,view&levels=3',
  });
  await done(page, ['coarse', 'view']);
  const busy = Array.from({ length: 8 }, occupy);
  try {
    // Each new view may find the slot free by chance.
    let words = '';
    for (let tries = 0; tries < 60 && !words.includes('by itself in'); ++tries) {
      await drag(page, 40, 0);
      await page.waitForTimeout(700);
      words = await message(page, 'view').innerText();
    }
    assert.match(words, /.{40}.*Try again \(by itself in/s);
    assert.ok((await facesOf(page, 'view')) > 344, 'the last good mesh stays');
  } finally {
    isOver = true;
    await Promise.all(busy);
  }
  await tryAgain(page);
  await done(page, ['view']);
  await small.stop();
});

test('a server that is down is reported, and found again', async () => {
  const first = await startServer();
  const port = new URL(first.url).port;
  const { page } = await openPage(shared.browser, first.url, { countRefusals: false });
  await done(page);
  await first.stop();
  await drag(page, 60, 0);
  await message(page, 'view').filter({ hasText: 'cannot be reached' }).waitFor();
  const again = await startServer('--port', port);
  try {
    // Its store is a new one: the page stores the mesh again by itself.
    await tryAgain(page);
    await done(page);
  } finally {
    await again.stop();
  }
});

test('a mesh that could not be saved can be saved later', async () => {
  const first = await startServer();
  const port = new URL(first.url).port;
  const { page } = await openPage(shared.browser, first.url, { hash: '', countRefusals: false });
  await page.locator('.panel[data-mode=view][data-by=here][data-estimate=false]').waitFor();
  await first.stop();
  const save = page.locator('.panel[data-mode=view]').getByRole('button', { name: 'Save' });
  await save.click();
  const told = message(page, 'view').filter({ hasText: 'cannot be reached' });
  await told.waitFor();
  await page.waitForTimeout(3000); // longer than the pause of a refinement
  await told.waitFor();
  const again = await startServer('--port', port);
  try {
    const downloaded = page.waitForEvent('download');
    await told.getByRole('button', { name: 'Try again' }).click();
    assert.match((await downloaded).suggestedFilename(), /^knot-view\./);
    assert.equal(await message(page, 'view').innerText(), '');
  } finally {
    await again.stop();
  }
});

test('a mesh that the store has dropped is stored again', async () => {
  const { page } = await openPage(shared.browser, shared.server.url, {
    countRefusals: false,
  });
  await done(page);
  const command = await page.locator('.command[data-mode=coarse] pre').innerText();
  const address = /'([^']+)'/.exec(command)[1];
  assert.equal((await fetch(address, { method: 'DELETE' })).status, 204);
  await drag(page, 60, 0);
  await page.waitForResponse((response) => response.url().endsWith('/v1/meshes') && response.status() === 201);
  await done(page);
});

test('a server with keys makes the page request one, and the command has a placeholder for it', async () => {
  const key = '0123456789abcdef0123456789abcdef';
  const folder = mkdtempSync(join(tmpdir(), 'papilio-keys-'));
  const file = join(folder, 'keys');
  writeFileSync(file, `someone ${key}\n`);
  const keyed = await startServer('--keys', file);
  try {
    const { page } = await openPage(shared.browser, keyed.url, {
      countRefusals: false,
    });
    await page.locator('#alert', { hasText: /key/i }).waitFor();
    await page.getByRole('textbox', { name: 'Key' }).fill(key);
    await page.keyboard.press('Enter');
    await done(page);
    assert.ok(await page.locator('#alert').isHidden());
    const command = await page.locator('.command[data-mode=view] pre').innerText();
    assert.ok(!command.includes(key));
    assert.ok((await run(command, 'refined.drc', { PAPILIO_KEY: key })).length > 1000);
  } finally {
    await keyed.stop();
    rmSync(folder, { recursive: true });
  }
});

test('a server without info is reported, with a button to retry', async () => {
  const page = await shared.browser.newPage();
  const gone = /\/v1\/|\.wasm/;
  await page.route(gone, (route) => route.abort());
  await page.goto(`${shared.server.url}#${fourWays}`);
  await page.locator('#alert', { hasText: 'cannot be reached' }).waitFor();
  await page.unroute(gone);
  await page.getByRole('button', { name: 'Try again' }).click();
  await done(page);
  await page.close();
});

for (const [what, options] of [
  ['light', { colorScheme: 'light' }],
  ['dark', { colorScheme: 'dark' }],
  ['on a small screen', { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true }],
])
  test(`names, contrast and roles have no axe-core violations: ${what}`, async () => {
    const { page, context } = await openPage(shared.browser, shared.server.url, options);
    await done(page);
    await page.locator('[id="parameter-levels"]').focus();
    await page.evaluate(readFileSync(axeSource, 'utf8'));
    const found = await page.evaluate(async () => (await globalThis.axe.run()).violations);
    const told = found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' ')}`);
    assert.deepEqual(told, []);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${overflow} pixels wider than the screen`);
    await context.close();
  });

test('all of the page is usable by keys alone, and the focus is visible', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const reached = new Set();
  for (let i = 0; i < 80; ++i) {
    await page.keyboard.press('Tab');
    const at = await page.evaluate(() => {
      const element = document.activeElement;
      if (element === null || element === document.body) return null;
      const shown = element.id === 'file' ? element.previousElementSibling : element;
      return {
        id: element.id || element.name || element.textContent,
        outline: getComputedStyle(shown).outlineStyle,
      };
    });
    if (at === null) break;
    reached.add(at.id);
    assert.notEqual(at.outline, 'none', at.id);
  }
  for (const id of [
    'sample',
    'file',
    'reset-camera',
    'copy-link',
    'stage',
    'Enlarge',
    'Save',
    'mode',
    'look',
    'frozen',
    'parameter-levels',
    'parameter-output.normals',
    'Copy',
  ])
    assert.ok(reached.has(id), `${id} is not among ${[...reached].join(', ')}`);
  assert.deepEqual(faults, []);
});
