// papilio/detail in node: packed models decode to the bits of the native library, and damaged ones are refused.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { brotliCompressSync, constants } from 'node:zlib';
import { assertRefused, compareDamaged, edited, withTable } from './damaged.mjs';
import { decodeDraco, originals, pack, unpack } from './packed.mjs';
import { areSame, root } from './requests.mjs';

const { compileDecoder, decodeBase, DetailDecoder, isPacked, readPacked, withLevels } = await import(
  path.join(root, 'build/npm/dist/detail.js')
);
const wasm = readFileSync(path.join(root, 'build/npm/dist/papilio-detail.wasm'));
const folder = mkdtempSync(path.join(tmpdir(), 'papilio-detail-'));
after(() => rmSync(folder, { recursive: true }));

let module;
let torus, fine, inPieces;
before(async () => {
  module = await compileDecoder(wasm);
  torus = pack('torus', folder).packed;
  fine = pack('torus', folder, { rms: 0.0002 }).packed;
  inPieces = pack('torus', folder, { rms: 0.0002, pieceBytes: 64 }).packed;
});

const bytesOf = (file) => new Uint8Array(readFileSync(file));
const assertSame = (made, expected, what) => {
  assert.ok(areSame(made.triangles, expected.triangles), `triangles: ${what}`);
  assert.ok(areSame(made.positions, expected.positions), `positions: ${what}`);
};

let compared = 0;
const seen = { curves: 0, none: 0 };
// Open, closed, with hard edges and without.
for (const name of [
  ...Object.keys(originals),
  'cgal/mask_cone.off',
  'cgal/three_peaks.off',
  'cgal/mushroom.off',
  'cgal/anchor_dense.off',
  'cgal/knot1.off',
])
  test(`${name}: each level is bit-identical to papilio unpack`, async () => {
    const { packed, report } = pack(name, folder);
    const file = readPacked(bytesOf(packed));
    ++seen[file.curves.length > 0 ? 'curves' : 'none'];
    assert.deepEqual(
      file.levels.map(({ faces, residuals, rms }) => [faces, residuals.length, rms >= 0]),
      report.levels.map(({ faces, bytes }) => [faces, bytes, true]),
    );
    const decoder = new DetailDecoder(module, await decodeBase(file.base, decodeDraco), file.curves);
    assert.equal(decoder.countEdges(), file.levels[0].residualCount);
    for (let levels = 0; levels <= file.levels.length; ++levels) {
      assertSame(decoder.decode(file.levels.slice(0, levels)), unpack(packed, levels), `${name} at level ${levels}`);
      ++compared;
    }
  });

test('at least 20 surfaces were compared, with curves and without', () => {
  assert.ok(compared >= 20, `${compared}`);
  assert.ok(seen.curves >= 2 && seen.none >= 2, JSON.stringify(seen));
});

test('levels in pieces are bit-identical to levels in one part', async () => {
  const [one, parted] = [fine, inPieces].map((packed) => readPacked(bytesOf(packed)));
  assert.ok(parted.levels.some(({ pieces }) => pieces.length > 3));
  assert.ok(one.levels.every(({ pieces }) => pieces.length === 0));
  const decoder = new DetailDecoder(module, await decodeBase(parted.base, decodeDraco), parted.curves);
  for (let levels = 0; levels <= parted.levels.length; ++levels) {
    const made = decoder.decode(parted.levels.slice(0, levels));
    assertSame(made, unpack(fine, levels), `level ${levels} in one`);
    assertSame(made, unpack(inPieces, levels), `level ${levels} in pieces`);
  }
});

test('without all pieces, the bits are those of papilio unpack for a truncated file', async () => {
  const file = bytesOf(inPieces);
  const { base, curves, levels } = readPacked(file);
  const decoder = new DetailDecoder(module, await decodeBase(base, decodeDraco), curves);
  const l = levels.findLastIndex(({ pieces }) => pieces.length > 0);
  const last = levels[l];
  const cut = path.join(folder, 'cut.glb');
  for (let there = 1; there < last.pieces.length; ++there) {
    const bytes = last.pieces.slice(0, there).reduce((sum, piece) => sum + piece.bytes, 0);
    writeFileSync(cut, file.subarray(0, levels[l - 1].end + bytes));
    const some = {
      ...last,
      residuals: last.residuals.subarray(0, bytes),
      pieces: last.pieces.map((piece, p) => ({ ...piece, isMissing: p >= there })),
    };
    assertSame(decoder.decode([...levels.slice(0, l), some]), unpack(cut, 10, '--truncated'), `${there} pieces`);
  }
});

test('repeated decoding does not grow the memory', async () => {
  const { base, curves, levels } = readPacked(bytesOf(torus));
  const triangles = await decodeBase(base, decodeDraco);
  const decoder = new DetailDecoder(module, triangles, curves);
  const first = decoder.decode(levels);
  const { bytes } = decoder;
  for (let i = 0; i < 20; ++i) assertSame(decoder.decode(levels), first);
  assert.ok(decoder.bytes <= 1.5 * bytes, `${bytes} bytes, then ${decoder.bytes}`);
  const tight = new DetailDecoder(module, triangles, curves, 2 ** 20);
  assertSame(tight.decode(levels), first);
  assert.equal(tight.bytes, 0);
});

test('the decoder reports errors, and works afterwards', async () => {
  const { base, curves, levels } = readPacked(bytesOf(torus));
  const triangles = await decodeBase(base, decodeDraco);
  const decoder = new DetailDecoder(module, triangles, curves);
  const problem = (code, message) => (error) => {
    assert.equal(error.code, code);
    assert.match(error.message, message);
    return true;
  };
  assert.throws(() => decoder.decode(levels, 1000), problem('result_too_large', /more than the limit of 1000/));
  assert.throws(() => decoder.decode([{ ...levels[0], step: NaN }]), problem('mesh_unusable', /step/));
  const far = { step: 1e18, residuals: new Uint8Array(), pieces: [] };
  assert.throws(() => decoder.decode([far, far]), problem('mesh_unusable', /beyond the largest coordinate/));
  assert.equal(decoder.decode(levels.slice(0, 1)).triangles.length, 12 * base.faces);
  const refused = (change, message) => {
    const copy = { positions: triangles.positions.slice(), triangles: triangles.triangles.slice() };
    change(copy);
    assert.throws(() => new DetailDecoder(module, copy, curves).countEdges(), problem('mesh_unusable', message));
  };
  refused((copy) => (copy.triangles[0] = 1e6), /1000000/);
  refused((copy) => (copy.positions[4] = NaN), /NaN|finite/);
  refused((copy) => copy.positions.copyWithin(3, 0, 3), /not a manifold surface/);
  refused((copy) => copy.triangles.subarray(0, 3).reverse(), /not a manifold surface/);
});

test('damaged and foreign documents are refused, with the place of the fault', () => {
  const file = bytesOf(torus);
  const refusals = [
    [({ detail }) => (detail.version = 1), 'mesh_unsupported', /version 1; version 3 is supported/],
    [({ detail }) => (detail.version = 1.5), 'mesh_not_gltf', /version is no whole number/],
    [({ detail }) => delete detail.bufferView, 'mesh_not_gltf', /has no bufferView/],
    [({ detail }) => (detail.bufferView = 0), 'mesh_not_gltf', /before the end of the base/],
    [({ detail }) => (detail.bufferView = 99), 'mesh_not_gltf', /bufferViews\[99\] does not exist/],
    [({ json }) => --json.bufferViews[1].byteOffset, 'mesh_not_gltf', /before the end of/],
    [({ json }) => --json.bufferViews[1].byteLength, 'mesh_not_gltf', /has .* bytes, and its table declares/],
    [({ json }) => (json.bufferViews[1].byteLength = 17), 'mesh_not_gltf', /too short/],
    [({ json }) => (json.bufferViews[1].byteLength += 1e6), 'mesh_not_gltf', /has the bytes .* of buffers\[0\]/],
    [({ json }) => (json.bufferViews[1].byteStride = 4), 'mesh_not_gltf', /has byteStride/],
    [({ json }) => (json.buffers[0].byteLength += 9), 'mesh_not_gltf', /buffers\[0\] declares/],
    [({ json }) => (json.buffers[0].uri = 'other.bin'), 'mesh_unsupported', /one buffer, the binary chunk/],
    [({ json }) => json.meshes.push(json.meshes[0]), 'mesh_unsupported', /other than one mesh/],
    [({ json }) => (json.nodes[0].scale = [2, 2, 2]), 'mesh_unsupported', /a node with scale/],
    [({ json }) => (json.asset.version = '1.0'), 'mesh_unsupported', /glTF version/],
    [({ primitive }) => (primitive.mode = 5), 'mesh_unsupported', /a primitive with mode/],
    [
      ({ primitive }) => (primitive.attributes.NORMAL = 0),
      'mesh_unsupported',
      /other attributes than POSITION, TEXCOORD_0 and COLOR_0/,
    ],
    [({ primitive }) => delete primitive.extensions.PAPILIO_detail, 'mesh_unsupported', /no PAPILIO_detail/],
    [({ primitive }) => delete primitive.extensions.KHR_draco_mesh_compression, 'mesh_not_gltf', /no base compressed/],
    [({ json }) => ++json.accessors[1].count, 'mesh_not_gltf', /whole triangles/],
    [({ json }) => (json.accessors[1].count = 3e6), 'result_too_large', /the limit is 8000000/],
  ];
  for (const [change, code, message] of refusals) assertRefused(edited(file, change), code, message, change);
  assert.equal(readPacked(edited(file, () => {})).levels.length, readPacked(file).levels.length);
});

test('damaged tables of levels are refused', () => {
  const file = bytesOf(torus);
  const refusals = [
    [(table) => (table[0] = 11), 'mesh_not_gltf', /has 11 of them; at most 10/],
    [(table) => --table[0], 'mesh_not_gltf', /its table declares/],
    [(table) => (table[1] = 1), 'mesh_not_gltf', /step|TEXCOORD_0|declares/],
    [(table) => (table[1] = 2), 'mesh_not_gltf', /pieces; 1 to 65535 are allowed/],
    [(table) => (table[1] = 4), 'mesh_not_gltf', /unknown flags/],
    [(table) => ++table[6], 'mesh_not_gltf', /its table declares/],
    [(table) => table.writeFloatLE(-1, 10), 'mesh_not_gltf', /the base's row has a distance/],
    [(table) => table.writeFloatLE(Infinity, 14), 'mesh_not_gltf', /the base's row has a distance/],
    [(table) => table.writeFloatLE(0, 34), 'mesh_not_gltf', /level 2 has a step that is not above 0/],
    [(table) => table.writeFloatLE(1.1e18, 34), 'mesh_not_gltf', /level 2 has a step/],
    [(table) => table.writeFloatLE(NaN, 38), 'mesh_not_gltf', /level 2 has a distance/],
    [(table) => ++table[30], 'mesh_not_gltf', /its table declares/],
  ];
  for (const [change, code, message] of refusals) assertRefused(withTable(file, change), code, message, change);
  assert.deepEqual(readPacked(withTable(file, () => {})), readPacked(file));
});

test('damaged tables of pieces are refused', () => {
  const file = bytesOf(inPieces);
  const { levels } = readPacked(file);
  const l = levels.findIndex(({ pieces }) => pieces.length > 0);
  const count = levels[l].pieces.length;
  const countAt = 18 + 20 * l + 16;
  const begin = 18 + 20 * levels.length; // of the pieces
  const refusals = [
    [(table) => table.writeUInt32LE(0, countAt), /has 0 pieces/],
    [(table) => table.writeUInt32LE(65536, countAt), /has 65536 pieces/],
    [(table) => table.writeUInt32LE(count + 1, countAt), /pieces|bound|declares/],
    [(table) => table.writeUInt32LE(65535, countAt), /too short/],
    [(table) => ++table[begin], /has other bytes than its pieces together/],
    [(table) => table.writeFloatLE(-1, begin + 4), /has a bound/],
    [(table) => table.writeFloatLE(NaN, begin + 8), /has a bound/],
    [(table) => table.writeFloatLE(Infinity, begin + 20), /has a bound/],
    [(table) => table.writeFloatLE(1.5, begin + 24), /has a bound/],
    [(table) => table.writeFloatLE(-1.5, begin + 36), /has a bound/],
  ];
  for (const [change, message] of refusals) assertRefused(withTable(file, change), 'mesh_not_gltf', message, change);
});

test('damaged containers are refused', () => {
  const file = bytesOf(torus);
  const at = (offset, word) => {
    const copy = Buffer.from(file);
    copy.writeUInt32LE(word, offset);
    return new Uint8Array(copy);
  };
  for (const [bytes, message] of [
    [new Uint8Array(), /do not begin with glTF/],
    [file.slice(0, 12), /at least 20/],
    [at(4, 1), /has version 1/],
    [file.slice(0, -1), /header declares/],
    [at(12, 2 ** 31), /declares 2147483648 bytes/],
    [at(16, 0), /first chunk .* is not JSON/],
    [at(20, 0), /not valid JSON/],
  ])
    assert.throws(() => readPacked(bytes), { name: 'Problem', message });
});

test('randomly damaged files are refused or read as by the native reader', async () => {
  for (const pieceBytes of [null, 64])
    await compareDamaged(pack('vase', folder, { pieceBytes }).packed, { module, assertSame });
});

test('every prefix of a file is refused, or has fewer complete levels', () => {
  const file = bytesOf(torus);
  const whole = readPacked(file);
  let most = -1;
  for (let length = 0; length < file.length; ++length) {
    const prefix = file.slice(0, length);
    assert.throws(() => readPacked(prefix), { name: 'Problem' });
    let cut;
    try {
      cut = readPacked(prefix, { mayBeCut: true });
    } catch (error) {
      assert.equal(error.code, 'mesh_not_gltf');
      assert.ok(length < whole.base.end, `${length}: ${error.message}`);
      continue;
    }
    assert.equal(cut.declaredLevels, whole.levels.length);
    assert.equal(cut.levels.length, whole.levels.filter(({ end }) => end <= length).length, `${length}`);
    most = Math.max(most, cut.levels.length);
  }
  assert.equal(most, whole.levels.filter(({ end }) => end < file.length).length);
  assert.ok(most > 0);
});

test('a file of fewer levels is a packed model that the native library reads', () => {
  for (const packed of [torus, inPieces]) compareFewerLevels(packed);
});

function compareFewerLevels(packed) {
  const file = bytesOf(packed);
  const { levels } = readPacked(file);
  for (let count = 0; count <= levels.length; ++count) {
    const fewer = path.join(folder, `fewer${count}.glb`);
    writeFileSync(fewer, withLevels(file, count));
    const { head, ...surface } = unpack(fewer, 10);
    const { head: expectedHead, ...expected } = unpack(packed, count);
    assert.equal(head, expectedHead);
    assertSame(surface, expected, `${count} levels`);
    assert.equal(readPacked(bytesOf(fewer)).levels.length, count);
    assert.ok(
      bytesOf(fewer).length < file.length || levels.slice(count).every(({ residuals }) => residuals.length < 4),
    );
  }
}

test('packed models are distinguished from other files', () => {
  const file = bytesOf(torus);
  assert.ok(isPacked(file));
  assert.ok(!isPacked(edited(file, ({ primitive }) => delete primitive.extensions.PAPILIO_detail)));
  for (const bytes of [new Uint8Array(), file.slice(1), file.slice(0, 30), readFileSync(`${torus}.ply`)])
    assert.ok(!isPacked(new Uint8Array(bytes)));
});

test('the module is small', () => {
  const packed = brotliCompressSync(wasm, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } });
  assert.ok(packed.length <= 45_000, `${packed.length} bytes`);
});
