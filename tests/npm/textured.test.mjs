// Packed models with texture coordinates in node: they decode to the bits of the native library, seams, pieces and normals
// included.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { assertRefused, compareDamaged, edited, withTable } from './damaged.mjs';
import { assertSame, checkerPng, decodeDraco, originals, pack, unpack } from './packed.mjs';
import { areSame, build, root } from './requests.mjs';

const { compileDecoder, decodeBase, DetailDecoder, isPacked, readPacked, withLevels, withSurfaces } = await import(
  path.join(root, 'build/npm/dist/detail.js')
);
const folder = mkdtempSync(path.join(tmpdir(), 'papilio-textured-'));
after(() => rmSync(folder, { recursive: true }));

let module;
let cushion, inPieces;
before(async () => {
  module = await compileDecoder(readFileSync(path.join(root, 'build/npm/dist/papilio-detail.wasm')));
  cushion = pack('cushion', folder, { isTextured: true }).packed;
  inPieces = pack('torus', folder, { rms: 0.0002, pieceBytes: 64, isTextured: true }).packed;
});

const bytesOf = (file) => new Uint8Array(readFileSync(file));

async function open(packed) {
  const file = readPacked(bytesOf(packed));
  return { file, decoder: new DetailDecoder(module, await decodeBase(file.base, decodeDraco), file.curves) };
}

const seen = { compared: 0, seams: 0, moved: 0 };
// Closed and open, with hard edges and without, with one chart and with six.
for (const name of Object.keys(originals))
  test(`${name} with a texture: each level is bit-identical to papilio unpack`, async () => {
    const { packed, report } = pack(name, folder, { isTextured: true });
    const { file, decoder } = await open(packed);
    assert.ok(file.base.hasTexcoords && file.hasMaterial);
    assert.deepEqual(
      file.levels.map(({ residuals, texcoordBytes }) => [residuals.length - texcoordBytes, texcoordBytes]),
      report.levels.map(({ bytes, texcoords }) => [bytes, texcoords?.bytes ?? 0]),
    );
    assert.equal(decoder.countEdges(), file.levels[0].residualCount);
    for (let levels = 0; levels <= file.levels.length; ++levels) {
      const expected = unpack(packed, levels);
      const made = decoder.decode(file.levels.slice(0, levels));
      assertSame(made, expected, `${name} at level ${levels}`);
      ++seen.compared;
      seen.seams += made.positions.length / 3 > file.base.vertices + residualsUpTo(file, levels) ? 1 : 0;
    }
    // Residuals of texture coordinates have a part in it.
    const without = file.levels.map((level) => ({ ...level, texcoordStep: 0, ...stripped(level) }));
    const [all, some] = [decoder.decode(file.levels), decoder.decode(without)];
    assert.ok(areSame(all.positions, some.positions));
    if (!areSame(all.texcoords, some.texcoords)) ++seen.moved;
  });

const residualsUpTo = ({ levels }, count) =>
  levels.slice(0, count).reduce((sum, { residualCount }) => sum + residualCount, 0);

/// A level of one piece without the residuals of its texture coordinates.
const stripped = ({ residuals, texcoordBytes }) => ({
  residuals: residuals.subarray(0, residuals.length - texcoordBytes),
  texcoordBytes: 0,
});

test('the surfaces compared had seams and residuals of texture coordinates', () => {
  assert.ok(seen.compared >= 12 && seen.seams >= 6 && seen.moved >= 2, JSON.stringify(seen));
});

test('normals are split as in the output of papilio unpack', async () => {
  const { file, decoder } = await open(cushion);
  const points = {};
  for (let levels = 0; levels <= file.levels.length; ++levels) {
    const made = decoder.decode(file.levels.slice(0, levels), undefined, 'creased');
    assertSame(made, unpack(cushion, levels, '--normals', true), `level ${levels}`);
    assert.equal(made.normals.length, made.positions.length);
    points[levels] = made.positions.length;
  }
  const smooth = decoder.decode(file.levels, undefined, 'smooth');
  for (let i = 0; i < smooth.normals.length; i += 3)
    assert.ok(Math.abs(Math.hypot(...smooth.normals.subarray(i, i + 3)) - 1) < 1e-6);
  for (const style of ['absent', 'faceted'])
    assert.equal(decoder.decode(file.levels, undefined, style).normals, undefined);
});

test('without all pieces, the bits are those of papilio unpack for a truncated file', async () => {
  const file = bytesOf(inPieces);
  const { file: packed, decoder } = await open(inPieces);
  const { levels } = packed;
  const l = levels.findLastIndex(({ pieces }) => pieces.length > 0);
  const last = levels[l];
  assert.ok(last.pieces.length > 3 && last.pieces.some(({ texcoordBytes }) => texcoordBytes > 0));
  const cut = path.join(folder, 'cut.glb');
  for (let there = 1; there < last.pieces.length; ++there) {
    const bytes = last.pieces.slice(0, there).reduce((sum, piece) => sum + piece.bytes + piece.texcoordBytes, 0);
    writeFileSync(cut, file.subarray(0, levels[l - 1].end + bytes));
    const some = {
      ...last,
      residuals: last.residuals.subarray(0, bytes),
      pieces: last.pieces.map((piece, p) => ({ ...piece, isMissing: p >= there })),
    };
    const expected = unpack(cut, 10, '--truncated');
    assertSame(decoder.decode([...levels.slice(0, l), some]), expected, `${there} pieces`);
  }
});

test('every prefix of a file is refused, or has its complete levels', async () => {
  const file = bytesOf(cushion);
  const whole = readPacked(file);
  const cut = path.join(folder, 'prefix.glb');
  let compared = 0;
  for (const [l, { end }] of whole.levels.entries())
    for (const length of [end - 1, end]) {
      const prefix = file.slice(0, length);
      assert.throws(() => readPacked(prefix), { name: 'Problem' });
      const { levels, base, curves } = readPacked(prefix, { mayBeCut: true });
      assert.equal(levels.length, length === end ? l + 1 : l);
      writeFileSync(cut, prefix);
      const decoder = new DetailDecoder(module, await decodeBase(base, decodeDraco), curves);
      assertSame(decoder.decode(levels), unpack(cut, levels.length, '--truncated'), `${length} bytes`);
      ++compared;
    }
  assert.ok(compared >= 4);
  assert.throws(() => readPacked(file.slice(0, whole.base.end - 1), { mayBeCut: true }), { code: 'mesh_not_gltf' });
});

test('damaged tables and documents are refused', () => {
  const file = bytesOf(cushion);
  const refusals = [
    [(table) => (table[1] = 0), 'mesh_not_gltf', /table|step|distance/],
    [(table) => table.writeFloatLE(-1, 34), 'mesh_not_gltf', /level 1 has a step/],
    [(table) => table.writeFloatLE(1.1e18, 34), 'mesh_not_gltf', /level 1 has a step/],
    [(table) => table.writeFloatLE(0, 34), 'mesh_not_gltf', /level 1 has texture coordinates without a step/],
    [(table) => ++table[38], 'mesh_not_gltf', /its table declares/],
  ];
  for (const [change, code, message] of refusals) assertRefused(withTable(file, change), code, message, change);
  const parted = bytesOf(inPieces);
  const { levels } = readPacked(parted);
  const begin = 18 + 28 * levels.length; // of the pieces
  assertRefused(
    withTable(parted, (table) => ++table[begin + 4]),
    'mesh_not_gltf',
    /other bytes than its pieces/,
  );
  assertRefused(
    withTable(parted, (table) => table.writeFloatLE(NaN, begin + 8)),
    'mesh_not_gltf',
    /has a bound/,
  );
  for (const [change, code, message] of [
    [
      ({ primitive }) => delete primitive.attributes.TEXCOORD_0,
      'mesh_not_gltf',
      /the base has neither TEXCOORD_0 nor COLOR_0/,
    ],
    [({ primitive }) => (primitive.attributes.TEXCOORD_1 = 0), 'mesh_unsupported', /other attributes than/],
    [({ detail }) => (detail.normals = 'round'), 'mesh_not_gltf', /must be "smooth", "creased" or "faceted"/],
  ])
    assertRefused(edited(file, change), code, message, change);
});

test('randomly damaged files are refused or read as by the native reader', async () => {
  for (const pieceBytes of [null, 64])
    await compareDamaged(pack('vase', folder, { pieceBytes, isTextured: true }).packed, { module, assertSame });
});

test('the decoder refuses pieces whose bytes do not match their level', async () => {
  const { file, decoder } = await open(cushion);
  const [first] = file.levels;
  for (const texcoordBytes of [first.texcoordBytes - 1, first.residuals.length + 1]) {
    const bytes = first.residuals.length - first.texcoordBytes;
    if (texcoordBytes < first.texcoordBytes)
      assert.equal(
        decoder.decode([{ ...first, pieces: [{ bytes, texcoordBytes }] }]).triangles.length,
        12 * file.base.faces,
      );
    else
      assert.throws(() => decoder.decode([{ ...first, pieces: [{ bytes, texcoordBytes }] }]), {
        code: 'mesh_unusable',
        message: /other bytes than the level/,
      });
  }
});

const infoOf = (file) => JSON.parse(execFileSync(path.join(build, 'papilio'), ['info', '--json', file]));
const contains = (bytes, part) => Buffer.from(bytes).includes(part);

test('a file of fewer levels keeps its texture, and is read by the native library', () => {
  for (const packed of [cushion, inPieces]) {
    const file = bytesOf(packed);
    const { levels } = readPacked(file);
    for (let count = 0; count <= levels.length; ++count) {
      const fewer = path.join(folder, `fewer${count}.glb`);
      writeFileSync(fewer, withLevels(file, count));
      assert.deepEqual(unpack(fewer, 10), unpack(packed, count), `${count} levels`);
      assert.ok(contains(bytesOf(fewer), checkerPng()));
      const { materials, textures, images, detail } = infoOf(fewer);
      assert.deepEqual([materials, textures, images, detail.levels.length], [1, 1, 1, count]);
    }
  }
});

test('a scene with another surface keeps the texture, and is not a packed model', () => {
  const file = bytesOf(cushion);
  const { base } = readPacked(file);
  const surface = {
    draco: base.primitives[0].draco,
    points: base.vertices,
    faces: base.faces,
    min: [-2, -2, -2],
    max: [2, 2, 2],
  };
  const scene = withSurfaces(file, [{ ...surface, attributes: { POSITION: 0, TEXCOORD_0: 1 } }]);
  assert.ok(!isPacked(scene) && contains(scene, checkerPng()) && scene.length < file.length);
  const written = path.join(folder, 'scene.glb');
  writeFileSync(written, scene);
  const { materials, images, meshes, detail } = infoOf(written);
  assert.deepEqual([materials, images, meshes[0].faces, detail], [1, 1, base.faces, undefined]);
  assert.deepEqual(meshes[0].attributes, ['POSITION', 'TEXCOORD_0']);
});
