// Real scenes through the command line: what comes back is judged by others' readers.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, KHRDracoMeshCompression } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import validator from 'gltf-validator';
import { MeshoptDecoder } from 'meshoptimizer';
import { compressible, models, nameOf, objects, pack, packings, papilio, refine, scenes } from './files.mjs';

const broken = [
  'IndexOutOfRange/IndexOutOfRange.gltf',
  'IncorrectVertexArrays/Cube.gltf',
  'RecursiveNodes/RecursiveNodes.gltf',
  'MissingBin/BoxTextured.gltf',
  'BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb',
  'wrongTypes/badArray.gltf',
];
let folder;
let io;

before(async () => {
  folder = mkdtempSync(path.join(tmpdir(), 'scenes-'));
  io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'draco3d.encoder': await draco3d.createEncoderModule(),
    'meshopt.decoder': MeshoptDecoder,
  });
});
after(() => rmSync(folder, { recursive: true }));

/** Codes of the errors and warnings of a file, each with its first message. */
async function issues(file) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
    maxIssues: 0,
    externalResourceFunction: (uri) =>
      Promise.resolve(new Uint8Array(readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))))),
  });
  const serious = report.issues.messages.filter(({ severity }) => severity < 2);
  return new Map(serious.map(({ code, message, pointer }) => [code, `${code}: ${message} ${pointer}`]));
}

/** The validator does not decode Draco: what gltf-transform decodes is checked in its place. */
async function decoded(file) {
  const document = await io.read(file);
  const plain = path.join(folder, 'plain.glb');
  for (const extension of document.getRoot().listExtensionsUsed())
    if (/draco|meshopt/.test(extension.extensionName)) extension.dispose();
  await io.write(plain, document);
  return { document, plain };
}

function trianglesOf(document) {
  let triangles = 0;
  for (const mesh of document.getRoot().listMeshes())
    for (const primitive of mesh.listPrimitives()) {
      if (primitive.getMode() < 4) continue;
      const corners = (primitive.getIndices() ?? primitive.getAttribute('POSITION')).getCount();
      triangles += primitive.getMode() === 4 ? corners / 3 : corners - 2;
    }
  return triangles;
}

function countsOf(document) {
  const root = document.getRoot();
  return {
    nodes: root.listNodes().length,
    meshes: root.listMeshes().length,
    primitives: root.listMeshes().map((mesh) => mesh.listPrimitives().length),
    targets: root.listMeshes().map((mesh) => mesh.listPrimitives().map((p) => p.listTargets().length)),
    joints: root.listSkins().map((skin) => skin.listJoints().length),
    channels: root.listAnimations().map((animation) => animation.listChannels().length),
    keys: root
      .listAnimations()
      .map((animation) => animation.listSamplers().map((s) => s.getOutput().getArray().join())),
    materials: root.listMaterials().length,
    images: root.listTextures().map((texture) => Buffer.from(texture.getImage() ?? []).toString('base64')),
  };
}

const json = (file) => JSON.parse(readFileSync(file).subarray(20, 20 + readFileSync(file).readUInt32LE(12)));

/** Bytes of the binary chunk of a .glb file that no view holds, beyond what aligns views. */
function deadBytes(file) {
  const { buffers = [], bufferViews = [] } = json(file);
  const dead = new Uint8Array(buffers[0]?.byteLength ?? 0).fill(1);
  for (const view of bufferViews)
    for (const { buffer, byteOffset = 0, byteLength } of [view, view.extensions?.EXT_meshopt_compression ?? view])
      if (buffer === 0) dead.fill(0, byteOffset, byteOffset + byteLength);
  return Math.max(0, dead.reduce((sum, byte) => sum + byte, 0) - 8 * bufferViews.length);
}

async function check(input, flags) {
  const output = path.join(folder, 'out.glb');
  const summary = refine(input, output, flags);
  const known = new Set((await issues(input)).keys());
  if (input.endsWith('.glb')) for (const code of (await issues((await decoded(input)).plain)).keys()) known.add(code);
  for (const [code, text] of await issues(output)) assert.ok(known.has(code), `${input} ${flags}: ${text}`);
  const { document, plain } = await decoded(output);
  if (flags.includes('draco'))
    for (const [code, text] of await issues(plain)) assert.ok(known.has(code), `${input} ${flags}: ${text}`);
  assert.deepEqual(countsOf(document), countsOf(await io.read(input)), input);
  assert.ok(deadBytes(output) <= (input.endsWith('.glb') ? deadBytes(input) : 0), `${input} ${flags}: dead bytes`);
  return { document, summary };
}

test('there are at least twenty real scenes', () => assert.ok(scenes.length >= 20));

for (const input of scenes) {
  test(`${nameOf(input)} comes back sound and finer`, async () => {
    const coarse = trianglesOf(await io.read(input));
    for (const flags of [[], ['--compress', 'draco'], ['--compress', 'meshopt']]) {
      const { document, summary } = await check(input, ['--levels', '1', ...flags]);
      assert.equal(trianglesOf(document), summary.faces);
      assert.ok(summary.faces > 3 * coarse, `${summary.faces} of ${coarse}`);
    }
  });
}

for (const [name, materials, images, known] of objects) {
  test(`${path.basename(name)} becomes a sound scene with its materials, and goes back`, async () => {
    const scene = path.join(folder, 'object.glb');
    const convert = (from, to) => execFileSync(papilio, ['convert', from, to], { stdio: 'pipe' });
    const counts = (document) => [document.getRoot().listMaterials().length, document.getRoot().listTextures().length];
    convert(name, scene);
    assert.deepEqual([...(await issues(scene)).keys()], known);
    const before = await io.read(scene);
    assert.deepEqual(counts(before), [materials, images]);
    convert(scene, path.join(folder, 'back.obj'));
    convert(path.join(folder, 'back.obj'), scene);
    assert.deepEqual([...(await issues(scene)).keys()], known);
    const after = await io.read(scene);
    assert.deepEqual(countsOf(after).images.sort(), countsOf(before).images.sort());
    assert.deepEqual(counts(after), [materials, images]);
    assert.equal(trianglesOf(after), trianglesOf(before));
  });
}

for (const options of packings) {
  test(`what gltfpack ${options.join('')} makes comes back compressed alike`, async () => {
    for (const input of compressible) {
      const packed = path.join(folder, 'packed.glb');
      pack(input, packed, options);
      await check(packed, ['--levels', '1']);
      assert.deepEqual(json(path.join(folder, 'out.glb')).extensionsRequired, json(packed).extensionsRequired);
    }
  });
}

test('what gltf-transform compresses by Draco comes back so, or as asked for', async () => {
  const draco = 'KHR_draco_mesh_compression';
  for (const input of compressible) {
    const packed = path.join(folder, 'packed.glb');
    const document = await io.read(input);
    document.createExtension(KHRDracoMeshCompression).setRequired(true);
    await io.write(packed, document);
    assert.ok(json(packed).extensionsRequired.includes(draco));
    for (const [compress, required] of [
      ['same', [draco]],
      ['draco', [draco]],
      ['meshopt', ['EXT_meshopt_compression']],
      ['none', undefined],
    ]) {
      await check(packed, ['--levels', '1', '--compress', compress]);
      assert.deepEqual(json(path.join(folder, 'out.glb')).extensionsRequired, required, compress);
    }
  }
});

for (const name of broken) {
  test(`${name} is refused`, () => {
    const input = path.join(models, name);
    assert.throws(
      () => refine(input, path.join(folder, 'out.glb'), []),
      ({ status, stderr }) => status === 1 && String(stderr).startsWith('papilio: ') && stderr.length > 60,
    );
  });
}
