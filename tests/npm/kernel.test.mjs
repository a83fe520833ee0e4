// The WebAssembly module in node: the same bits as the C functions compiled for this machine.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { before, test } from 'node:test';
import { brotliCompressSync, constants } from 'node:zlib';
import {
  areSame,
  cone,
  meshes,
  nativeResults,
  randomNumbers,
  randomQuery,
  readMesh,
  root,
  sizeOf,
  torusWithAttributes,
} from './requests.mjs';

const { Kernel, KernelError } = await import(path.join(root, 'build/npm/dist/wasm.js'));
const bytes = readFileSync(path.join(root, 'build/npm/dist/papilio.wasm'));

let module;
before(async () => {
  module = await Kernel.compile(bytes);
});

function assertSame(made, expected, what) {
  assert.deepEqual(made.statistics, expected.statistics, what);
  assert.ok(areSame(made.mesh.triangles, expected.mesh.triangles), `triangles: ${what}`);
  assert.ok(areSame(made.mesh.positions, expected.mesh.positions), `positions: ${what}`);
  assert.equal(made.mesh.attributes.length, expected.mesh.attributes.length, what);
  made.mesh.attributes.forEach(({ kind, components, values }, a) => {
    assert.deepEqual(
      [kind, components],
      [expected.mesh.attributes[a].kind, expected.mesh.attributes[a].components],
      what,
    );
    assert.ok(areSame(values, expected.mesh.attributes[a].values), `attribute ${a}: ${what}`);
  });
}

let compared = 0;
let refined = 0;
for (const [name, mesh] of meshes())
  test(`${name}: results are bit-identical to the native library`, () => {
    const random = randomNumbers(name.length + mesh.positions.length);
    const queries = Array.from({ length: 24 }, () => randomQuery(random, sizeOf(mesh)));
    const expected = nativeResults(mesh, queries);
    const kernel = new Kernel(module);
    let opened = kernel.open(mesh);
    queries.forEach((query, q) => {
      ++compared;
      const what = `${name}?${query}`;
      if (expected[q].fault) {
        assert.throws(
          () => kernel.refine(opened, query),
          ({ fault, message, parameter }) => {
            assert.deepEqual({ fault, message, parameter }, expected[q], what);
            return true;
          },
        );
        return;
      }
      ++refined;
      assertSame(kernel.refine(opened, query), expected[q], what);
      if (q % 3 === 0) {
        kernel.close(opened);
        opened = kernel.open(mesh);
      }
    });
  });

test('at least 300 requests were compared, and most of them refined faces', () => {
  assert.ok(compared >= 300, `${compared}`);
  assert.ok(refined > 0.8 * compared, `${refined}`);
});

test('levels arrive with the coarse mesh first, and equal results with fewer levels', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(readMesh('bunny600.obj'));
  const levels = [];
  const last = kernel.refine(mesh, { levels: 3 }, { onLevel: (level) => levels.push(level) });
  assert.deepEqual(
    levels.map((level) => [level.statistics.level, level.statistics.isLast]),
    [
      [0, false],
      [1, false],
      [2, false],
      [3, true],
    ],
  );
  for (const { mesh: of, statistics } of levels)
    assert.ok(areSame(of.positions, kernel.refine(mesh, { levels: statistics.level }).mesh.positions));
  assert.ok(areSame(last.mesh.positions, levels[3].mesh.positions));
});

const faultOf = (work) => {
  try {
    work();
  } catch (error) {
    assert.ok(error instanceof KernelError, String(error));
    return error;
  }
  return assert.fail('nothing was thrown');
};

test('refusals have the text of the service, and the kernel works afterwards', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(readMesh('bunny600.obj'));
  const before = kernel.refine(mesh, { levels: 1 });
  const unknown = faultOf(() => kernel.refine(mesh, { tolerence: 0.1 }));
  assert.equal(unknown.fault, 'bad-parameter');
  assert.equal(unknown.message, 'Unknown parameter "tolerence". Did you mean tolerance?');
  assert.equal(unknown.parameter, 'tolerence');
  const range = faultOf(() => kernel.refine(mesh, { view: { near: -1 } }));
  assert.match(range.message, /view\.near must be .* at least 0/);
  const bent = { positions: new Float32Array([0, 0, 0, 1, 0, 0, NaN, 1, 0]), triangles: new Uint32Array([0, 1, 2]) };
  assert.equal(faultOf(() => kernel.open(bent)).fault, 'unusable-mesh');
  assert.equal(faultOf(() => kernel.open({ ...bent, triangles: new Uint32Array([0, 1, 7]) })).fault, 'unusable-mesh');
  assert.equal(faultOf(() => kernel.open({ ...bent, triangles: new Uint32Array() })).fault, 'unusable-mesh');
  const values = { kind: 'values', components: 2, values: [1, 2, 3] };
  assert.match(faultOf(() => kernel.open({ ...cone(6), attributes: [values] })).message, /3 values for 7 points/);
  assert.match(faultOf(() => kernel.refine(mesh, { levels: 9 })).message, /faces; the limit is 16000000/);
  assert.ok(areSame(kernel.refine(mesh, { levels: 1 }).mesh.positions, before.mesh.positions));
});

test('an aborted refinement stops', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(readMesh('elephant2000.obj'));
  let asked = 0;
  const cancelled = faultOf(() =>
    kernel.refine(mesh, { levels: 5, tolerance: 1e-6 }, { cancelled: () => ++asked > 3 }),
  );
  assert.equal(cancelled.fault, 'cancelled');
  assert.equal(asked, 4);
});

test('an exception of the caller passes through, and the kernel works afterwards', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(readMesh('bunny600.obj'));
  const fail = () => {
    throw new Error('no more');
  };
  assert.throws(() => kernel.refine(mesh, { levels: 2 }, { onLevel: fail }), /no more/);
  assert.equal(kernel.refine(mesh, { levels: 1 }).statistics.level, 1);
});

test('memory is returned, and the next refinement has the same result', () => {
  const kernel = new Kernel(module, 32 * 2 ** 20);
  const mesh = kernel.open(readMesh('elephant2000.obj'));
  const small = kernel.refine(mesh, { levels: 1 });
  assert.ok(kernel.bytes > 0);
  assert.equal(kernel.refine(mesh, { levels: 5 }).mesh.triangles.length, 3 * 1024 * 2000);
  assert.equal(kernel.bytes, 0);
  assert.ok(areSame(kernel.refine(mesh, { levels: 1 }).mesh.positions, small.mesh.positions));
});

test('a result read in place has the bytes of a copied one, until the next call', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(torusWithAttributes(12));
  const parameters = { levels: 2, 'output.normals': true };
  const copied = kernel.refine(mesh, parameters);
  for (let i = 0; i < 3; ++i) {
    const { mesh: viewed, statistics } = kernel.refine(mesh, parameters, { inPlace: true });
    assert.equal(viewed.positions.buffer.byteLength, kernel.bytes, 'a view of the memory');
    assert.ok(areSame(viewed.positions, copied.mesh.positions));
    assert.ok(areSame(viewed.triangles, copied.mesh.triangles));
    for (const [a, { values }] of viewed.attributes.entries())
      assert.ok(areSame(values, copied.mesh.attributes[a].values));
    assert.deepEqual(statistics, copied.statistics);
  }
});

test('results read in place are freed by the next call', () => {
  const kernel = new Kernel(module);
  const mesh = kernel.open(readMesh('bunny600.obj'));
  const bytesAfter = (times) => {
    for (let i = 0; i < times; ++i) kernel.refine(mesh, { levels: 4 }, { inPlace: true });
    return kernel.bytes;
  };
  const first = bytesAfter(3);
  assert.equal(bytesAfter(20), first);
});

test('a result beyond the memory is refused with its size before the refinement', () => {
  const kernel = new Kernel(module);
  const mesh = readMesh('elephant2000.obj');
  const values = new Float64Array((8 * mesh.positions.length) / 3);
  const attributes = Array.from({ length: 4 }, () => ({ kind: 'values', components: 8, values }));
  const refused = faultOf(() => kernel.refine(kernel.open({ ...mesh, attributes }), { levels: 6 }));
  assert.equal(refused.fault, 'too-large');
  assert.match(refused.message, /MiB of memory; the limit is 2048 MiB/);
});

test('the module has at most 130,000 bytes with brotli', () => {
  const packed = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } });
  assert.ok(packed.length <= 130_000, `${packed.length} bytes`);
});
