// OBJ files with their material libraries and images in the viewer.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

import { build, done, drop, dropAll, openPage, picture, redShare, serverAndBrowser } from './browser.mjs';
import { cubeGltf, cubeObj } from './mesh_files.mjs';

const shared = serverAndBrowser();

const redPng = cubeGltf()[2][1];

/// A cube whose first three sides have an image, and the others a colour.
function paintedCube() {
  const [places, sides] = cubeObj()
    .split(/(?=^f )/m)
    .reduce(([first, rest], part) => (part.startsWith('f') ? [first, [...rest, part.trim()]] : [part, rest]), ['', []]);
  const textured = sides.map((side) => side.replace(/(\d+)/g, '$1/1'));
  return [
    `mtllib paint of cubes.mtl\n${places}vt 0.5 0.5`,
    'usemtl image',
    ...textured.slice(0, 3),
    'usemtl two words',
    ...textured.slice(3),
    '',
  ].join('\n');
}

const library = `# by hand
newmtl image
Kd 1 1 1
map_Kd -s 2 2 -clamp on textures\\red.png
newmtl two words
Kd 0.8 0 0
Ke 3 0 0
Ns 96
newmtl unused
d 0.5
`;

/// Materials of a .glb file by name, with glTF's defaults, and their images.
function materialsOf(glb) {
  const json = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)));
  const imageOf = (texture) => {
    if (texture === undefined) return null;
    const { byteOffset = 0, byteLength } =
      json.bufferViews[json.images[json.textures[texture.index].source].bufferView];
    const begin = 28 + glb.readUInt32LE(12) + byteOffset;
    return glb.subarray(begin, begin + byteLength).toString('base64');
  };
  const entries = json.materials.map(({ name, pbrMetallicRoughness: pbr, ...rest }) => [
    name,
    {
      colour: pbr.baseColorFactor ?? [1, 1, 1, 1],
      metallic: pbr.metallicFactor ?? 1,
      roughness: (pbr.roughnessFactor ?? 1).toPrecision(5),
      emissive: rest.emissiveFactor ?? [0, 0, 0],
      strength: rest.extensions?.KHR_materials_emissive_strength.emissiveStrength ?? 1,
      alpha: rest.alphaMode ?? 'OPAQUE',
      image: imageOf(pbr.baseColorTexture),
    },
  ]);
  return Object.fromEntries(entries.sort(([a], [b]) => (a < b ? -1 : 1)));
}

/// What the command line makes of the same files.
function convertedByCli(files) {
  const folder = mkdtempSync(join(tmpdir(), 'papilio-web-'));
  try {
    for (const [name, bytes] of files) writeFileSync(join(folder, name), bytes);
    execFileSync(join(build, 'papilio'), ['convert', 'cube.obj', 'cube.glb'], { cwd: folder });
    return readFileSync(join(folder, 'cube.glb'));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test('an .obj file with its .mtl and images has the materials of the command line, coarse and refined', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const files = [
    ['paint of cubes.mtl', library],
    ['red.png', redPng],
    ['cube.obj', paintedCube()],
  ];
  await dropAll(page, files);
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  await done(page);
  assert.ok(await page.locator('#alert').isHidden());
  await page.getByLabel('Shaded').check();
  // The parts are named as the file and its materials.
  assert.deepEqual(
    await page.locator('#parts label').allInnerTexts(),
    ['cube', 'image', 'two words'].map((n) => ` ${n}`),
  );
  for (const mode of ['coarse', 'uniform']) {
    const { red, drawn } = await redShare(page, await picture(page, mode));
    assert.ok(drawn > 0.1 && red > 0.9 * drawn, `${mode}: ${red} of ${drawn} are red`);
  }
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('.panel[data-mode=coarse] button', { hasText: 'Save' }).click(),
  ]);
  assert.equal(download.suggestedFilename(), 'cube-coarse.glb');
  const seen = materialsOf(readFileSync(await download.path()));
  assert.equal(Object.keys(seen).length, 2);
  assert.equal(seen.image.image, redPng.toString('base64'));
  assert.deepEqual(seen, materialsOf(convertedByCli(files)));
  assert.deepEqual(faults, []);
});

test('a library or an image that was not dropped with its .obj file is named', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await drop(page, 'cube.obj', paintedCube());
  await page.locator('#alert-text', { hasText: /materials in paint of cubes\.mtl: drop or pick the files/ }).waitFor();
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  await dropAll(page, [
    ['cube.obj', paintedCube()],
    ['paint of cubes.mtl', library],
  ]);
  await page.locator('#alert-text', { hasText: /cube\.obj has no textures\/red\.png inside/ }).waitFor();
  await done(page);
  await dropAll(page, [['cube.obj', cubeObj()]]);
  await page.locator('#alert').waitFor({ state: 'hidden' });
  assert.deepEqual(faults, []);
});

/// Sends a file through the page, and returns what the page stores on the server.
async function storedOf(page, name, text) {
  const [stored] = await Promise.all([
    page.waitForRequest((request) => request.url().endsWith('/v1/meshes')),
    drop(page, name, text),
  ]);
  await done(page);
  return stored.postDataBuffer();
}

test('polygons and smoothing groups are those of the command line', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  // An L as one face, whose fan around the first corner would leave it, and a pyramid of two smoothing groups.
  const l = 'v 0 0 0\nv 0 2 0\nv -1 2 0\nv -1 -1 0\nv 2 -1 0\nv 2 0 0\nv 0 0 1\nf 1 2 3 4 5 6\nf 1 2 7\n';
  const corners = 'v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 0.5\n';
  const groups = `${corners}s 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\ns off\nf 4 3 2 1\n`;
  const folder = mkdtempSync(join(tmpdir(), 'papilio-web-'));
  const papilio = (...words) => execFileSync(join(build, 'papilio'), words, { cwd: folder, encoding: 'utf8' });
  try {
    for (const [name, text, sent] of [
      ['l.obj', l, 'l.drc'],
      ['groups.obj', groups, 'groups.glb'],
    ]) {
      writeFileSync(join(folder, name), text);
      writeFileSync(join(folder, sent), await storedOf(page, name, text));
      for (const file of [name, sent])
        papilio('refine', file, '-o', `${file}.ply`, '--levels', '3', '--shape', 'organic');
      const { hausdorff, diagonal } = JSON.parse(papilio('compare', '--json', `${name}.ply`, `${sent}.ply`));
      assert.ok(hausdorff < 2e-4 * diagonal, `${name}: ${hausdorff}`);
    }
    // The uniform picture of the page is the command line's, too.
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator('.panel[data-mode=uniform] button', { hasText: 'Save' }).click(),
    ]);
    await download.saveAs(join(folder, 'uniform.glb'));
    papilio('refine', 'groups.obj', '-o', 'here.ply', '--levels', '3');
    const { hausdorff, diagonal } = JSON.parse(papilio('compare', '--json', 'here.ply', 'uniform.glb'));
    assert.ok(hausdorff < 2e-4 * diagonal, `${hausdorff}`);
  } finally {
    rmSync(folder, { recursive: true });
  }
  assert.deepEqual(faults, []);
});
