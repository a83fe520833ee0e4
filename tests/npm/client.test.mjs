// papilio/client against the real server.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { cubeGlb } from '../web/mesh_files.mjs';
import { meshes, root, startServer } from '../web/browser.mjs';

const { Client, Problem } = await import(path.join(root, 'build/npm/dist/client.js'));

const bunny = { type: 'application/x-draco', bytes: readFileSync(path.join(meshes, 'bunny600.drc')) };
const cube = { type: 'model/gltf-binary', bytes: cubeGlb({ isTextured: true }) };
let server;
let client;
before(async () => {
  server = await startServer();
  client = new Client({ base: server.url });
});
after(() => server.stop());

const problemOf = async (promise) => {
  const error = await promise.then(
    () => assert.fail('nothing was refused'),
    (reason) => reason,
  );
  assert.ok(error instanceof Problem, String(error));
  return error;
};

async function read(levels) {
  const all = [];
  for await (const level of levels) all.push(level);
  return { all, summary: await levels.summary };
}

test('info describes the server', async () => {
  const info = await client.info();
  assert.match(info.version, /^\d+\.\d+\.\d+$/);
  assert.ok(info.parameters.some(({ name }) => name === 'tolerance'));
  assert.ok(info.schemes.includes('red-green'));
  assert.equal((await client.openapi()).openapi.slice(0, 4), '3.1.');
  assert.deepEqual([await client.isAlive(), await client.isReady()], [true, true]);
  const sample = await client.sample(info.samples[0].name);
  assert.equal(sample.type, 'application/x-draco');
});

test('a mesh and a scene are refined, each to its format', async () => {
  const fine = await client.refine(bunny, { levels: 2 });
  assert.deepEqual([fine.type, fine.level, fine.faces, fine.vertices], ['application/x-draco', 2, 9600, 4802]);
  assert.equal(fine.summary.stop_reason, 'levels');
  assert.ok(fine.summary.error > 0 && fine.timing.refine >= 0 && fine.bytes.length > 1000);
  assert.equal(fine.summary.error_pixels, undefined);
  const seen = await client.refine(bunny, { levels: 1, view: { error_pixels: 0.01 } });
  assert.ok(seen.summary.error_pixels > 0.01);
  assert.match(seen.summary.unreached, /view\.error_pixels/);
  const scene = await client.refine(cube, 'levels=2&shape=organic');
  assert.deepEqual([scene.type, scene.faces], ['model/gltf-binary', 192]);
});

test('levels arrive one by one, then the summary; the last equals the single answer', async () => {
  const { all, summary } = await read(client.levels(bunny, { levels: 3 }));
  assert.deepEqual(
    all.map(({ level }) => level),
    [0, 1, 2, 3],
  );
  assert.deepEqual(
    all.map(({ faces }) => faces),
    [600, 2400, 9600, 38400],
  );
  assert.equal(summary.stop_reason, 'levels');
  assert.deepEqual(Buffer.from(all[3].bytes), Buffer.from((await client.refine(bunny, { levels: 3 })).bytes));
  const scenes = await read(client.levels(cube, { levels: 1 }));
  assert.deepEqual(
    scenes.all.map(({ type, faces }) => [type, faces]),
    [
      ['model/gltf-binary', 12],
      ['model/gltf-binary', 48],
    ],
  );
});

test('a stored mesh is described, refined, revalidated, and deleted', async () => {
  const stored = await client.store(bunny);
  assert.match(stored.id, /^[0-9a-f]{64}$/);
  assert.equal((await client.describe(stored.id)).faces, 600);
  assert.deepEqual(Buffer.from((await client.stored(stored.id)).bytes), bunny.bytes);
  const fine = await client.refineStored(stored.id, { tolerance: 0.001, levels: 3 });
  assert.equal(fine.summary.stop_reason, 'converged');
  assert.equal(await client.refineStored(stored.id, { tolerance: 0.001, levels: 3 }, { etag: fine.etag }), null);
  const { all } = await read(client.levelsOfStored(stored.id, { tolerance: 0.001, levels: 3 }));
  assert.deepEqual(Buffer.from(all.at(-1).bytes), Buffer.from(fine.bytes));
  await client.delete(stored.id);
  const gone = await problemOf(client.describe(stored.id));
  assert.deepEqual([gone.code, gone.status], ['mesh_not_found', 404]);
});

test('refusals are problems with the parameter and the id of the request', async () => {
  const refused = await problemOf(client.refine(bunny, { levels: 99 }));
  assert.deepEqual([refused.code, refused.status, refused.parameter], ['bad_parameter', 400, 'levels']);
  assert.match(refused.message, /levels must be an integer in 0\.\.10/);
  assert.ok(refused.requestId);
  const levels = client.levels(bunny, { tolerence: 1 });
  assert.equal((await problemOf(read(levels))).code, 'unknown_parameter');
  assert.equal((await problemOf(levels.summary)).code, 'unknown_parameter');
  const absent = new Client({ base: 'http://127.0.0.1:9' });
  assert.deepEqual([(await problemOf(absent.info())).code, await absent.isAlive()], ['unreachable', false]);
});

test('an aborted refinement is cancelled', async () => {
  const reason = new Error('enough');
  const signal = AbortSignal.abort(reason);
  await assert.rejects(client.refine(bunny, { levels: 3 }, { signal }), reason);
  const controller = new AbortController();
  const levels = client.levels(bunny, { levels: 6, tolerance: 1e-6 }, { signal: controller.signal });
  await assert.rejects(async () => {
    for await (const level of levels) if (level.level === 1) controller.abort(reason);
  }, reason);
  await assert.rejects(levels.summary, reason);
});

test('each request sends the key', async () => {
  const key = '0123456789abcdef0123456789abcdef';
  const folder = mkdtempSync(path.join(tmpdir(), 'papilio-keys-'));
  writeFileSync(path.join(folder, 'keys'), `someone ${key}\n`);
  const guarded = await startServer('--keys', path.join(folder, 'keys'));
  try {
    const stranger = await problemOf(new Client({ base: guarded.url }).refine(bunny));
    assert.deepEqual([stranger.code, stranger.status], ['unauthorized', 401]);
    const friend = new Client({ base: guarded.url, key: () => key });
    assert.equal((await friend.refine(bunny, { levels: 1 })).faces, 2400);
  } finally {
    await guarded.stop();
    rmSync(folder, { recursive: true });
  }
});
