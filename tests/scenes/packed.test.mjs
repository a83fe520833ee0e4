// Packed models of the command line: others' readers see a sound scene, and the base.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import validator from 'gltf-validator';
import { papilio } from './files.mjs';

const meshes = process.env.PAPILIO_MESHES ?? new URL('../../build/deps/meshes', import.meta.url).pathname;
const original = path.join(meshes, 'bunny.obj');
const run = (...words) => execFileSync(papilio, words, { stdio: 'pipe', encoding: 'utf8' });

let folder;
let model;
let report;

before(() => {
  folder = mkdtempSync(path.join(tmpdir(), 'packed-'));
  model = path.join(folder, 'model.glb');
  report = JSON.parse(run('pack', original, '-o', model, '--rms', '0.0007', '--no-simplify', '--json'));
});
after(() => rmSync(folder, { recursive: true }));

test('the validator finds nothing wrong with a packed model', async () => {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(model)), { maxIssues: 0 });
  assert.equal(report.format, 'packed');
  assert.equal(issues.numErrors + issues.numWarnings, 0, JSON.stringify(issues.messages));
});

test('a reader that does not know the extension decodes the base', async () => {
  const io = new NodeIO()
    .registerExtensions(ALL_EXTENSIONS)
    .registerDependencies({ 'draco3d.decoder': await draco3d.createDecoderModule() });
  const [mesh, ...others] = (await io.read(model)).getRoot().listMeshes();
  const [primitive] = mesh.listPrimitives();
  assert.equal(others.length, 0);
  assert.equal(primitive.getIndices().getCount(), 3 * report.base.faces);
  const positions = primitive.getAttribute('POSITION');
  assert.equal(positions.getCount(), report.base.vertices);

  // To the bit what papilio decodes.
  const base = path.join(folder, 'base.obj');
  run('unpack', model, '-o', base, '--levels', '0');
  const lines = readFileSync(base, 'utf8').split('\n');
  const vertices = lines
    .filter((line) => line.startsWith('v '))
    .map((line) => line.split(' ').slice(1).map(Math.fround));
  const seen = vertices.map((_, i) => Array.from(positions.getArray().slice(3 * i, 3 * i + 3)));
  const sorted = (points) => points.map((point) => point.join()).sort();
  assert.deepEqual(sorted(seen), sorted(vertices));
});
