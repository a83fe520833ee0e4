// Large meshes in the viewer: how long its main thread is busy at a time, by the browser's own trace.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import {
  build,
  carry,
  drop,
  dropCarried,
  facesOf,
  meshes,
  openPage,
  run,
  serverAndBrowser,
  tasksOf,
} from './browser.mjs';

const shared = serverAndBrowser();
const open = (hash) => openPage(shared.browser, shared.server.url, { hash });
/// Milliseconds of a task: half as much again as the goal of 16, for busy machines, where the least of several runs counts.
const longest = 24;
const done = (page, mode) => page.locator(`.panel[data-mode=${mode}][data-state=done]`).waitFor();

/// Number of tasks of the page's main thread during `work`, and 2 s after it, that take more than `most` milliseconds of
/// processor time: the least of up to `runs` runs, as the same task takes longer with others on the machine.
async function longTasks(page, most, runs, work) {
  const counts = [];
  for (let i = 0; i < runs && counts.at(-1) !== 0; ++i) {
    await shared.browser.startTracing(page, { categories: ['toplevel'] });
    await work(i);
    await page.waitForTimeout(2000);
    const { processor } = tasksOf(await shared.browser.stopTracing());
    assert.ok(processor.length > 20, `${processor.length} tasks`);
    counts.push(processor.filter((milliseconds) => milliseconds > most).length);
  }
  return Math.min(...counts);
}

test('no task takes long while a mesh of 355,712 faces is opened', async () => {
  const command = `${join(build, 'papilio')} refine ${join(meshes, 'elephant89k.drc')} -o fine.drc --levels 1`;
  const bytes = await run(command, 'fine.drc');
  const { page, faults } = await open('mesh=knot&show=coarse&where=here&look=shaded');
  await done(page, 'coarse');
  const [most, runs] = [longest, 6];
  const carried = await Promise.all([...Array(runs).keys()].map((i) => carry(page, [[`fine${i}.drc`, bytes]])));
  const long = await longTasks(page, most, runs, async (i) => {
    await dropCarried(page, carried[i]);
    await page.waitForFunction((name) => document.title.startsWith(name), `fine${i}`);
    await done(page, 'coarse');
  });
  assert.equal(await facesOf(page, 'coarse'), 355_712);
  assert.equal(long, 0);
  assert.deepEqual(faults, []);
});

test('no task takes long when the edges of such a mesh are first drawn', async () => {
  const command = `${join(build, 'papilio')} refine ${join(meshes, 'elephant89k.drc')} -o fine.drc --levels 1`;
  const bytes = await run(command, 'fine.drc');
  const [counts, runs] = [[], 4];
  for (let i = 0; i < runs && counts.at(-1) !== 0; ++i) {
    const { page, faults, context } = await open('mesh=knot&show=coarse&where=here&look=shaded');
    await done(page, 'coarse');
    await drop(page, 'fine.drc', bytes);
    await page.waitForFunction(() => document.title.startsWith('fine'));
    await done(page, 'coarse');
    await page.waitForTimeout(2000); // shaders are compiled in advance
    const long = await longTasks(page, longest, 1, () => page.locator('input[name=look][value=wireframe]').check());
    counts.push(long);
    assert.equal(await facesOf(page, 'coarse'), 355_712);
    assert.deepEqual(faults, []);
    await context.close();
  }
  assert.equal(Math.min(...counts), 0);
});

test('distances are measured in a worker', async () => {
  const values = 'levels=3&view.error_pixels=0.1&view.edge_pixels=0';
  const { page, faults } = await open(`mesh=knot&show=uniform,view&as=panels&look=shaded&${values}`);
  await done(page, 'uniform');
  await drop(page, 'elephant.obj', readFileSync(join(meshes, 'elephant2000.obj')));
  await page.waitForFunction(() => document.title.startsWith('elephant'));
  for (const mode of ['uniform', 'view']) await done(page, mode);
  assert.equal(await facesOf(page, 'uniform'), 128_000);
  const names = [];
  page.on('worker', (worker) => names.push(worker.url()));
  const long = await longTasks(page, longest, 4, async () => {
    await page.locator('input[name=look][value=shaded]').check();
    await page.locator('input[name=look][value=distance]').check();
    await page.locator('.panel[data-mode=view] .legend', { hasText: 'largest here' }).waitFor();
  });
  assert.equal(names.filter((name) => /distance_worker/.test(name)).length, 1, 'measured once, in a worker');
  assert.equal(long, 0);
  assert.deepEqual(faults, []);
});
