// Packed models of several materials, and with colours of vertices, in node: they decode to the bits of the native library,
// and are refused as by it.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { assertRefused, compareDamaged, edited } from './damaged.mjs';
import { assertSame, checkerPng, decodeDraco, materialNames, pack, unpack } from './packed.mjs';
import { areSame, build, root } from './requests.mjs';

const { compileDecoder, decodeBase, DetailDecoder, isPacked, readPacked, withLevels, withSurfaces } = await import(
  path.join(root, 'build/npm/dist/detail.js')
);
const folder = mkdtempSync(path.join(tmpdir(), 'papilio-materials-'));
after(() => rmSync(folder, { recursive: true }));

const kinds = {
  'two materials': { isParted: true },
  'two materials and a texture': { isParted: true, isTextured: true },
  colours: { isColoured: true },
  'colours and texture coordinates': { isColoured: true, isTextured: true },
};

/// What `pack` makes of a shape, once. In pieces: levels of the vase are.
const made = new Map();
function packOnce(name, kind, options = {}) {
  const key = [name, kind, ...Object.values(options)].join();
  if (!made.has(key)) made.set(key, pack(name, folder, { ...kinds[kind], ...options }));
  return made.get(key);
}
const inPieces = (kind) => packOnce('vase', kind, { rms: 0.0007, pieceBytes: 100 });

let module;
before(
  async () => (module = await compileDecoder(readFileSync(path.join(root, 'build/npm/dist/papilio-detail.wasm')))),
);

const bytesOf = (file) => new Uint8Array(readFileSync(file));
const decoderOf = async ({ base, curves }) => new DetailDecoder(module, await decodeBase(base, decodeDraco), curves);

/// Faces of each material in an OBJ file.
function facesByMaterial(obj) {
  const counts = materialNames.map(() => 0);
  let material = 0;
  for (const line of readFileSync(obj, 'utf8').split('\n')) {
    if (line.startsWith('usemtl ')) material = materialNames.indexOf(line.slice(7));
    if (line.startsWith('f ')) ++counts[material];
  }
  return counts;
}

const seen = { compared: 0, moved: 0, colours: 0 };
for (const [kind, options] of Object.entries(kinds))
  for (const name of ['waves', 'cushion', 'vase'])
    test(`${name} with ${kind}: each level is bit-identical to papilio unpack`, async () => {
      const { packed, report } = packOnce(name, kind);
      assert.ok(isPacked(bytesOf(packed)));
      const file = readPacked(bytesOf(packed));
      const { isParted = false, isTextured = false, isColoured = false } = options;
      const { base, levels } = file;
      assert.deepEqual([base.hasTexcoords, base.hasColours, file.hasMaterial], [isTextured, isColoured, isParted]);
      assert.deepEqual(new Set(base.primitives.map(({ part }) => part)), new Set(isParted ? [1, 2] : [0]));
      assert.deepEqual(
        levels.map(({ faces, texcoordBytes }) => [faces, texcoordBytes]),
        report.levels.map(({ faces, texcoords }) => [faces, texcoords?.bytes ?? 0]),
      );
      const decoder = await decoderOf(file);
      assert.equal(decoder.countEdges(), base.edges);
      for (let count = 0; count <= levels.length; ++count) {
        const made = decoder.decode(levels.slice(0, count));
        assertSame(made, unpack(packed, count), `${name} at level ${count}`);
        const creased = decoder.decode(levels.slice(0, count), undefined, 'creased');
        assertSame(creased, unpack(packed, count, '--normals', true), `${name} with normals at level ${count}`);
        ++seen.compared;
      }
      if (isParted) {
        // Faces of a level are in the order of the primitives.
        const obj = path.join(folder, 'parts.obj');
        execFileSync(path.join(build, 'papilio'), ['unpack', packed, '-o', obj], { stdio: 'pipe' });
        const counts = [0, 0];
        for (const { faces, part } of base.primitives) counts[part - 1] += faces * 4 ** levels.length;
        const { materials } = documentOf(packed);
        const expected = facesByMaterial(obj);
        assert.deepEqual(
          counts,
          materials.map((material) => expected[materialNames.indexOf(material.name)]),
        );
        // Borders between materials are seams: without them the bits are others.
        const joined = await decodeBase(base, decodeDraco);
        delete joined.parts;
        const without = new DetailDecoder(module, joined, file.curves).decode(levels);
        if (!areSame(without.positions, decoder.decode(levels).positions)) ++seen.moved;
      }
      if (isColoured) {
        const without = levels.map((level) => {
          const residuals = level.residuals.subarray(0, level.residuals.length - level.texcoordBytes);
          return { ...level, residuals, texcoordStep: 0, texcoordBytes: 0 };
        });
        const [all, some] = [decoder.decode(levels), decoder.decode(without)];
        assert.ok(areSame(all.positions, some.positions));
        if (!areSame(all.colours, some.colours)) ++seen.colours;
      }
    });

test('the levels compared depend on borders and on residuals of colours', () => {
  assert.ok(seen.compared >= 36 && seen.moved >= 3 && seen.colours >= 4, JSON.stringify(seen));
});

function documentOf(packed) {
  const bytes = readFileSync(packed);
  return JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
}

for (const kind of Object.keys(kinds))
  test(`${kind}: pieces and truncated files have the bits of papilio unpack`, async () => {
    const { packed } = inPieces(kind);
    const file = bytesOf(packed);
    const whole = readPacked(file);
    const { levels } = whole;
    const decoder = await decoderOf(whole);
    for (let count = 0; count <= levels.length; ++count)
      assertSame(decoder.decode(levels.slice(0, count)), unpack(packed, count), `level ${count}`);
    const l = levels.findLastIndex(({ pieces }) => pieces.length > 1);
    const last = levels[l];
    const cut = path.join(folder, 'cut.glb');
    for (let there = 1; there < last.pieces.length; ++there) {
      const bytes = last.pieces.slice(0, there).reduce((sum, piece) => sum + piece.bytes + piece.texcoordBytes, 0);
      const prefix = file.slice(0, levels[l - 1].end + bytes);
      writeFileSync(cut, prefix);
      assert.equal(readPacked(prefix, { mayBeCut: true }).levels.length, l);
      const pieces = last.pieces.map((piece, p) => ({ ...piece, isMissing: p >= there }));
      const some = { ...last, residuals: last.residuals.subarray(0, bytes), pieces };
      assertSame(decoder.decode([...levels.slice(0, l), some]), unpack(cut, 10, '--truncated'), `${there} pieces`);
    }
  });

test('a file truncated within a primitive of the base is refused', () => {
  const file = bytesOf(packOnce('vase', 'two materials').packed);
  const { base } = readPacked(file);
  for (const { draco } of base.primitives) {
    const prefix = file.slice(0, draco.byteOffset + draco.length - 1);
    assert.throws(() => readPacked(prefix, { mayBeCut: true }), {
      code: 'mesh_not_gltf',
      message: /cut inside its base/,
    });
  }
});

/// What `papilio unpack` says of a file; empty where it reads it.
function nativeRefusal(bytes) {
  const file = path.join(folder, 'refused.glb');
  writeFileSync(file, bytes);
  try {
    unpack(file, 1);
    return '';
  } catch (error) {
    return String(error.stderr);
  }
}

test('invalid documents are refused as by the native reader', () => {
  const detail = { version: 3, bufferView: 0 };
  const parted = bytesOf(packOnce('cushion', 'two materials and a texture').packed);
  const coloured = bytesOf(packOnce('waves', 'colours').packed);
  for (const [file, change, code, message] of [
    [parted, ({ json }) => (json.meshes[0].primitives = []), 'mesh_not_gltf', /no primitives/],
    [
      parted,
      ({ second }) => (second.extensions.PAPILIO_detail = detail),
      'mesh_unsupported',
      /several primitives with/,
    ],
    [parted, ({ second }) => (second.mode = 4), 'mesh_unsupported', /a primitive with mode/],
    [parted, ({ second }) => (second.targets = []), 'mesh_unsupported', /a primitive with targets/],
    [parted, ({ second }) => delete second.attributes.TEXCOORD_0, 'mesh_unsupported', /primitives of different attrib/],
    [parted, ({ second }) => (second.attributes.COLOR_0 = 0), 'mesh_unsupported', /primitives of different attributes/],
    [parted, ({ second }) => (second.attributes.NORMAL = 0), 'mesh_unsupported', /other attributes than POSITION, TEX/],
    [parted, ({ second }) => delete second.attributes, 'mesh_not_gltf', /primitives\[1\].* has no attributes/],
    [parted, ({ second }) => delete second.attributes.POSITION, 'mesh_unsupported', /other attributes than POSITION/],
    [parted, ({ second }) => delete second.extensions, 'mesh_not_gltf', /primitives\[1\] has no base compressed/],
    [parted, ({ second }) => (second.material = -1), 'mesh_not_gltf', /primitives\[1\]\.material/],
    [parted, ({ second }) => delete second.indices, 'mesh_not_gltf', /primitives\[1\] lacks an accessor/],
    [parted, ({ json, second }) => ++json.accessors[second.indices].count, 'mesh_not_gltf', /whole triangles/],
    [parted, ({ json }) => json.meshes[0].primitives.reverse(), 'mesh_unsupported', /no PAPILIO_detail/],
    [
      parted,
      ({ second, first }) => (dracoOf(second).bufferView = dracoOf(first).bufferView),
      'mesh_not_gltf',
      /before/,
    ],
    [coloured, ({ first }) => delete first.attributes.COLOR_0, 'mesh_not_gltf', /neither TEXCOORD_0 nor COLOR_0/],
    [coloured, ({ first }) => (first.attributes.COLOR_1 = 0), 'mesh_unsupported', /other attributes than POSITION/],
  ]) {
    const changed = edited(file, ({ json }) => {
      const [first, second] = json.meshes[0].primitives;
      change({ json, first, second });
    });
    assertRefused(changed, code, message, change);
    // Without PAPILIO_detail on any primitive, or the first, papilio unpack takes a file for a plain scene, or says so.
    if (isPacked(changed)) assert.match(nativeRefusal(changed), message, String(change));
  }
});
const dracoOf = ({ extensions }) => extensions.KHR_draco_mesh_compression;

test('primitives that differ from the declared ones are refused', async () => {
  const refusalOf = async (name, kind, change) => {
    const { base } = readPacked(bytesOf(packOnce(name, kind).packed));
    const decode = async (draco) => {
      const decoded = await decodeDraco(draco);
      return draco === base.primitives.at(-1).draco ? { ...decoded, ...change(decoded) } : decoded;
    };
    return decodeBase(base, decode).then(
      () => null,
      ({ code, message }) => `${code}: ${message}`,
    );
  };
  const fewer = ({ triangles }) => ({ triangles: triangles.subarray(3) });
  assert.match(await refusalOf('vase', 'two materials', fewer), /mesh_not_gltf: .* other counts/);
  assert.match(await refusalOf('vase', 'colours', () => ({ colours: undefined })), /declares colours, unlike/);
  const colours = new Uint8Array(3);
  assert.match(await refusalOf('vase', 'two materials', () => ({ colours })), /declares no colours, unlike/);
});

test('randomly damaged files are refused or read as by the native reader', async () => {
  for (const kind of Object.keys(kinds)) await compareDamaged(inPieces(kind).packed, { module, assertSame });
});

const infoOf = (file) => JSON.parse(execFileSync(path.join(build, 'papilio'), ['info', '--json', file]));

test('a file of fewer levels keeps materials and colours, and is read by the native library', () => {
  for (const kind of Object.keys(kinds)) {
    const { packed } = packOnce('vase', kind);
    const file = bytesOf(packed);
    const { levels, base } = readPacked(file);
    for (let count = 0; count <= levels.length; ++count) {
      const fewer = path.join(folder, `fewer${count}.glb`);
      writeFileSync(fewer, withLevels(file, count));
      assert.deepEqual(unpack(fewer, 10), unpack(packed, count), `${count} levels`);
      const { materials, meshes, detail } = infoOf(fewer);
      const isParted = base.primitives.length > 1;
      assert.deepEqual([materials, meshes[0].primitives], isParted ? [2, 2] : [0, 1]);
      assert.equal(detail.levels.length, count);
    }
  }
});

test('a scene with other surfaces keeps materials, images and colours, and is not a packed model', () => {
  for (const [name, kind, attributes] of [
    ['cushion', 'two materials and a texture', { POSITION: 0, TEXCOORD_0: 1 }],
    ['vase', 'colours', { POSITION: 0, COLOR_0: 3 }],
  ]) {
    const file = bytesOf(packOnce(name, kind).packed);
    const { base } = readPacked(file);
    const surfaces = base.primitives.map(({ draco, vertices: points, faces }) => {
      return { draco, points, faces, attributes, min: [-4, -4, -4], max: [4, 4, 4] };
    });
    const scene = withSurfaces(file, surfaces);
    assert.ok(!isPacked(scene) && scene.length < file.length);
    assert.equal(Buffer.from(scene).includes(checkerPng()), kind.includes('texture'));
    const written = path.join(folder, 'scene.glb');
    writeFileSync(written, scene);
    const { meshes, detail } = infoOf(written);
    assert.deepEqual([meshes[0].faces, meshes[0].primitives, detail], [base.faces, surfaces.length, undefined]);
    assert.deepEqual([...meshes[0].attributes].sort(), Object.keys(attributes).sort());
    assert.throws(() => withSurfaces(file, [...surfaces, surfaces[0]]), RangeError);
  }
});
