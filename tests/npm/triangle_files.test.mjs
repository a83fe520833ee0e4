// papilio/files in node: files are read to the bits of the command line, and damaged ones refused in its words.

import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { brotliCompressSync, constants } from 'node:zlib';
import { meshes } from '../web/browser.mjs';
import { build, root } from './requests.mjs';

const { readTriangleFile } = await import(path.join(root, 'build/npm/dist/files.js'));
const wasm = readFileSync(path.join(root, 'build/npm/dist/papilio-files.wasm'));
const folder = mkdtempSync(path.join(tmpdir(), 'papilio-files-'));
after(() => rmSync(folder, { recursive: true }));
let module;
before(async () => {
  module = await WebAssembly.compile(wasm);
});

const papilio = path.join(build, 'papilio');
const formatOf = (file) => path.extname(file).slice(1).toLowerCase();
const read = (format, bytes) => readTriangleFile(format, new Uint8Array(Buffer.from(bytes)), { wasm: module });

/// Returns a file as the command line reads it: the accessors of its only primitive, each as its bytes.
function asConverted(file) {
  const glb = path.join(folder, 'converted.glb');
  execFileSync(papilio, ['convert', file, glb], { stdio: 'pipe' });
  const bytes = readFileSync(glb);
  const length = bytes.readUInt32LE(12);
  const { meshes, accessors, bufferViews } = JSON.parse(bytes.subarray(20, 20 + length).toString());
  const bytesOf = (accessor) => {
    const { byteOffset = 0, byteLength } = bufferViews[accessors[accessor].bufferView];
    return bytes.subarray(28 + length + byteOffset, 28 + length + byteOffset + byteLength);
  };
  assert.equal(meshes[0].primitives.length, 1, file);
  const { attributes, indices } = meshes[0].primitives[0];
  return {
    indices: bytesOf(indices),
    ...Object.fromEntries(Object.entries(attributes).map(([k, a]) => [k, bytesOf(a)])),
  };
}

const semantics = {
  normals: 'NORMAL',
  colours: 'COLOR_0',
  texcoords: 'TEXCOORD_0',
  'smoothing-groups': '_SMOOTHING_GROUP',
};
const bytesOf = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
/// Returns values as glTF has them: texture coordinates downwards.
const inGltf = ({ kind, values }) => (kind === 'texcoords' ? values.map((v, i) => (i % 2 ? 1 - v : v)) : values);

async function compare(file, bytes = readFileSync(file)) {
  const expected = asConverted(file);
  const made = await read(formatOf(file), bytes);
  const found = { indices: bytesOf(made.triangles), POSITION: bytesOf(made.positions) };
  for (const attribute of made.attributes) found[semantics[attribute.kind]] = bytesOf(inGltf(attribute));
  assert.deepEqual(Object.keys(found).sort(), Object.keys(expected).sort(), file);
  for (const [name, values] of Object.entries(found)) assert.ok(values.equals(expected[name]), `${file}: ${name}`);
  return made;
}

async function compareText(name, text) {
  const file = path.join(folder, name);
  writeFileSync(file, text);
  return compare(file);
}

/// Asserts that a file is refused, as the command line does.
async function assertRefused(file, bytes) {
  const { status, stderr } = spawnSync(papilio, ['info', file], { encoding: 'utf8' });
  assert.notEqual(status, 0, file);
  const error = await read(formatOf(file), bytes).then(
    () => assert.fail(`${file} was read`),
    (problem) => problem,
  );
  assert.deepEqual([error.name, error.code], ['Problem', 'mesh_unusable'], `${file}: ${error}`);
  assert.ok(stderr.includes(`${error.message}; export`), `${file}: ${error.message}, not ${stderr}`);
}

test('real meshes are those of the command line', async () => {
  const files = ['', 'cgal'].flatMap((sub) =>
    readdirSync(path.join(meshes, sub)).map((name) => path.join(meshes, sub, name)),
  );
  let count = 0;
  for (const file of files) {
    if (!['obj', 'off', 'ply', 'stl'].includes(formatOf(file))) continue;
    const bytes = readFileSync(file);
    if (bytes.length > 3e6) continue;
    ++count;
    if (spawnSync(papilio, ['info', file]).status === 0) await compare(file, bytes);
    else await assertRefused(file, bytes); // point clouds
  }
  assert.ok(count >= 60, `${count} files`);
});

test('other formats of a mesh are, too', async () => {
  for (const format of ['ply', 'stl', 'off']) {
    const file = path.join(folder, `bunny.${format}`);
    execFileSync(papilio, ['convert', path.join(meshes, 'bunny600.obj'), file]);
    await compare(file);
  }
});

test('numbers are the nearest ones, in any spelling', async () => {
  let seed = 7;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const spellings = [
    (x) => String(Math.fround(x)),
    (x) => x.toFixed(Math.floor(random() * 12)),
    (x) => x.toExponential(Math.floor(random() * 20)),
    (x) => x.toPrecision(1 + Math.floor(random() * 25)),
    (x) => `+${Math.abs(x)}`,
    (x) => `${Math.abs(x).toFixed(3)}`.replace(/^0/, ''),
    (x) => `${Math.trunc(x)}.`,
  ];
  const exact = [
    '0',
    '-0',
    '1e-46',
    '-1e-46',
    '1.4e-45',
    '1e-400',
    '3.4028235e38',
    '16777217',
    '16777216',
    '0.1',
    '9e-1',
  ];
  // Halfway between two floats, and a little to each side.
  const ties = [
    '1.000000059604644775390625',
    '1.00000005960464477539062500001',
    '1.0000000596046447753906249',
    '16777217.0',
  ];
  const words = [...exact, ...ties, '0000000000000000000001.5', '123456789012345678901234567890'];
  for (let i = 0; i < 6000; ++i) {
    const scale = 10 ** (random() * 20 - 10);
    words.push(spellings[i % spellings.length]((random() - 0.5) * scale));
  }
  while (words.length % 3) words.push('1');
  const lines = words.flatMap((_, i) => (i % 3 ? [] : [`v ${words.slice(i, i + 3).join(' ')}`]));
  const { positions } = await compareText('numbers.obj', `${lines.join('\n')}\nf 1 2 3\n`);
  assert.equal(positions.length, words.length);
});

test('polygons, seams, normals and smoothing groups of OBJ files', async () => {
  // An L, whose fan around the first corner would leave it.
  const l = await compareText('l.obj', 'v 0 0 0\nv 0 2 0\nv -1 2 0\nv -1 -1 0\nv 2 -1 0\nv 2 0 0\nf 1 2 3 4 5 6\n');
  const area = (a, b, c) =>
    ((l.positions[3 * b] - l.positions[3 * a]) * (l.positions[3 * c + 1] - l.positions[3 * a + 1]) -
      (l.positions[3 * c] - l.positions[3 * a]) * (l.positions[3 * b + 1] - l.positions[3 * a + 1])) /
    2;
  const areas = [0, 3, 6, 9].map((i) => area(...l.triangles.slice(i, i + 3)));
  assert.ok(
    areas.every((one) => one > 0),
    String(areas),
  );
  assert.equal(areas[0] + areas[1] + areas[2] + areas[3], 5);

  const corners = 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 .25\nvn 0 0 1\nvn 0 1 0\n';
  const made = await compareText('all.obj', `${corners}s 3\nf 1/1/1 2/2/1 3/3/1\ns off\nf 1/1/2 3/3/2 4/4/2\nf 1 2\n`);
  assert.deepEqual(
    made.attributes.map(({ kind, components }) => [kind, components]),
    [
      ['texcoords', 2],
      ['normals', 3],
      ['smoothing-groups', 1],
    ],
  );
  assert.equal(made.materialOfFace, null);
});

test('materials of OBJ files', async () => {
  const lines = ['mtllib a b.mtl', 'mtllib other.mtl', 'v 0 0 0', 'v 1 0 0', 'v 0 1 0', 'v 1 1 0', 'f 1 2 3'];
  const made = await read('obj', [...lines, 'usemtl Stein grün', 'f 2 4 3', 'usemtl', 'f 1 2 4', ''].join('\n'));
  assert.deepEqual(made.libraries, ['a b.mtl', 'other.mtl']);
  assert.deepEqual(made.materials, ['Stein grün', '']);
  assert.deepEqual([...made.materialOfFace], [2 ** 32 - 1, 0, 1]);
});

test('colours of PLY files are from 0 to 1', async () => {
  const head = [
    'ply',
    'format ascii 1.0',
    'element vertex 3',
    'property float x',
    'property float y',
    'property float z',
  ];
  const colours = ['red', 'green', 'blue'].map((name) => `property uchar ${name}`);
  const rest = ['element face 1', 'property list uchar int vertex_indices', 'end_header'];
  const rows = ['0 0 0 255 0 51', '1 0 0 0 255 0', '0 1 0 102 0 0', '3 0 1 2', ''];
  const { attributes } = await read('ply', [...head, ...colours, ...rest, ...rows].join('\n'));
  assert.deepEqual([attributes.length, attributes[0].kind, attributes[0].components], [1, 'colours', 3]);
  assert.deepEqual([...attributes[0].values], [1, 0, 0.2, 0, 1, 0, 0.4, 0, 0].map(Math.fround));
});

test('damaged files are refused in the words of the command line', async () => {
  const three = 'v 0 0 0\nv 1 0 0\nv 0 1 0\n';
  const damaged = {
    'points.obj': three,
    'index.obj': `${three}f 1 2 9\n`,
    'word.obj': `${three}f 1 2 x\n`,
    'hex.obj': 'v 0x10 0 0\n',
    'sign.obj': 'v +-1 0 0\n',
    'signs.obj': 'v ++1 0 0\n',
    'large.obj': 'v 1e39 0 0\n',
    'cut.obj': `${three}f 1 2`,
    'binary.obj': `${three}\0`,
    'texture.obj': `${three}vt 0 0\nf 1/2 2/1 3/1\n`,
    'fewer.off': 'OFF\n4 1 0\n0 0 0\n',
    'nowhere.off': 'OFF\n1 1 0\n0 0 0\n3 0 0 9\n',
    'none.ply': 'ply\nformat none\n',
    'huge.ply':
      'ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n' +
      'element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n',
    'cut.stl': 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n',
    'short.stl': Buffer.concat([Buffer.alloc(80), Buffer.from([200, 0, 0, 0]), Buffer.alloc(50)]),
  };
  for (const [name, bytes] of Object.entries(damaged)) {
    const file = path.join(folder, name);
    writeFileSync(file, bytes);
    await assertRefused(file, bytes);
  }
});

test('cut and altered files are read or refused', async () => {
  let seed = 3;
  const random = (below) => (seed = (seed * 48271) % 2147483647) % below;
  const ply = path.join(folder, 'small.ply');
  const stl = path.join(folder, 'small.stl');
  const obj = path.join(folder, 'small.obj');
  writeFileSync(
    obj,
    'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\ns 1\nf 1/1/1 2/1/1 3/1/1\ns 2\nf 1 3 4 2\n',
  );
  for (const file of [ply, stl]) execFileSync(papilio, ['convert', obj, file]);
  let refused = 0;
  for (const file of [obj, ply, stl]) {
    const whole = readFileSync(file);
    for (let i = 0; i < 400; ++i) {
      const bytes = Buffer.from(i % 2 ? whole.subarray(0, random(whole.length)) : whole);
      for (let k = random(3); k > 0 && bytes.length > 0; --k) bytes[random(bytes.length)] = random(256);
      if (bytes.length === 0) continue;
      try {
        const made = await read(formatOf(file), bytes);
        assert.ok(made.triangles.length > 0 && made.triangles.every((v) => v < made.positions.length / 3));
      } catch (error) {
        assert.equal(error.code, 'mesh_unusable', `${file}, change ${i}: ${error.stack}`);
        ++refused;
      }
    }
  }
  assert.ok(refused > 300, `${refused} refused`);
});

test('the module is small', () => {
  const packed = brotliCompressSync(wasm, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } });
  assert.ok(packed.length <= 30_000, `${packed.length} bytes`);
});
