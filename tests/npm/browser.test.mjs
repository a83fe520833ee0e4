// papilio/wasm in headless Chromium: workers, cancellation, and the same bits.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { after, before, test } from 'node:test';
import { launch } from '../web/browser.mjs';
import { startFiles } from './files.mjs';
import { meshes, nativeResults, randomNumbers, randomQuery, readMesh, sizeOf } from './requests.mjs';

let files;
let browser;
before(async () => {
  [files, browser] = await Promise.all([startFiles(), launch()]);
});
after(async () => {
  await browser.close();
  files.stop();
});

async function open(where = '') {
  const page = await browser.newPage();
  page.setDefaultTimeout(60_000);
  await page.goto(`${files.url}${where}/tests/page.html`);
  await page.waitForSelector('html[data-state=ready]', { state: 'attached' });
  return page;
}

const plain = ({ positions, triangles, attributes = [] }) => ({
  positions: [...positions],
  triangles: [...triangles],
  attributes: attributes.map((a) => ({ ...a, values: [...a.values] })),
});

function digest({ mesh }) {
  const hash = createHash('sha256');
  for (const array of [mesh.positions, mesh.triangles, ...mesh.attributes.map((a) => a.values)])
    hash.update(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
  return hash.digest('hex');
}

test('results in workers are bit-identical to the native library', async () => {
  const page = await open();
  let compared = 0;
  for (const [name, mesh] of meshes()) {
    const random = randomNumbers(1 + name.length);
    const queries = Array.from({ length: 22 }, () => randomQuery(random, sizeOf(mesh)));
    const expected = nativeResults(mesh, queries).map((one) => one.message ?? digest(one));
    const made = await page.evaluate(
      async ([coarse, asked]) => {
        window.refiner ??= await papilio.Refiner.start({ workers: 2 });
        const opened = window.refiner.open(meshOf(coarse));
        const results = await Promise.allSettled(asked.map((query) => window.refiner.refine(opened, query)));
        window.refiner.forget(opened);
        return Promise.all(results.map(({ value, reason }) => (value ? digest(value) : reason.message)));
      },
      [plain(mesh), queries],
    );
    assert.deepEqual(made, expected, name);
    compared += queries.length;
  }
  assert.ok(compared >= 300, `${compared}`);
  await page.close();
});

const elephant = plain(readMesh('elephant2000.obj'));

for (const where of ['', '/isolated'])
  test(`an aborted refinement ends${where && ', where memory is shared'}`, async () => {
    const page = await open(where);
    const seen = await page.evaluate(async (coarse) => {
      const refiner = await papilio.Refiner.start();
      const mesh = refiner.open(meshOf(coarse));
      await refiner.refine(mesh, { levels: 1 });
      const controller = new AbortController();
      const long = refiner.refine(mesh, { levels: 5, tolerance: 1e-7 }, { signal: controller.signal });
      const waiting = refiner.refine(mesh, { levels: 5, tolerance: 1e-7 }, { signal: controller.signal });
      const next = refiner.refine(mesh, { levels: 2 });
      setTimeout(() => controller.abort(new Error('enough')), 50);
      const [first, second, third] = await Promise.allSettled([long, waiting, next]);
      const tooLate = await refiner.refine(mesh, {}, { signal: controller.signal }).catch((error) => error.message);
      refiner.close();
      return {
        isIsolated: crossOriginIsolated,
        reasons: [first.reason?.message, second.reason?.message, tooLate],
        faces: third.value.mesh.triangles.length / 3,
        closed: await refiner.refine(mesh, {}).catch((error) => error.message),
      };
    }, elephant);
    assert.deepEqual(seen, {
      isIsolated: where !== '',
      reasons: ['enough', 'enough', 'enough'],
      faces: 32000,
      closed: 'The refiner was closed.',
    });
    await page.close();
  });

test('levels arrive one by one, and the page stays responsive', async () => {
  const page = await open();
  const seen = await page.evaluate(async (coarse) => {
    const refiner = await papilio.Refiner.start();
    const mesh = refiner.open(meshOf(coarse));
    let turns = 0;
    const timer = setInterval(() => ++turns, 1);
    const levels = [];
    const last = await refiner.refine(mesh, { levels: 4 }, { onLevel: (level) => levels.push(level.statistics.level) });
    clearInterval(timer);
    return { levels, last: last.statistics.level, faces: last.mesh.triangles.length / 3, turns };
  }, elephant);
  assert.deepEqual([seen.levels, seen.last, seen.faces], [[0, 1, 2, 3], 4, 512000]);
  assert.ok(seen.turns > 2, `${seen.turns}`);
  await page.close();
});

test('two workers run in parallel: short work does not wait for long work', async () => {
  const page = await open();
  const order = await page.evaluate(async (coarse) => {
    const order = async (workers) => {
      const refiner = await papilio.Refiner.start({ workers });
      const mesh = refiner.open(meshOf(coarse));
      const ended = [];
      const note = (name) => () => ended.push(name);
      const long = refiner.refine(mesh, { levels: 5, tolerance: 1e-5 }).then(note('long'));
      const short = refiner.refine(mesh, { levels: 1 }).then(note('short'));
      await Promise.all([long, short]);
      refiner.close();
      return ended;
    };
    return [await order(1), await order(2)];
  }, elephant);
  assert.deepEqual(order, [
    ['long', 'short'],
    ['short', 'long'],
  ]);
  await page.close();
});

test('faults have their text, and a missing module is reported', async () => {
  const page = await open();
  const seen = await page.evaluate(async (coarse) => {
    const refiner = await papilio.Refiner.start();
    const mesh = refiner.open(meshOf(coarse));
    const { fault, message, parameter, name } = await refiner.refine(mesh, { levels: 99 }).catch((error) => error);
    const missing = await papilio.Refiner.start({ wasm: fetch('/nothing.wasm') }).catch((error) => error);
    return { fault, message, parameter, name, isError: missing instanceof Error };
  }, elephant);
  assert.deepEqual(seen, {
    fault: 'bad-parameter',
    message: 'levels must be an integer in 0..10, not "99".',
    parameter: 'levels',
    name: 'KernelError',
    isError: true,
  });
  await page.close();
});
