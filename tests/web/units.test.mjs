// The viewer's parts that need no browser, compiled by esbuild.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { test } from 'node:test';

const web = new URL('../../client/web/', import.meta.url).pathname;
const esbuild = createRequire(`${web}node_modules/vite/package.json`)('esbuild');

async function load(name) {
  const { outputFiles } = await esbuild.build({
    entryPoints: [`${web}src/${name}.ts`],
    bundle: true,
    format: 'esm',
    write: false,
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}

const { boundaryOf, partsOf } = await load('../../npm/src/multipart');
const link = await load('link');
const { faultOf, rangeOf, queryOf } = await load('parameters');
const { valuesFor } = await load('requests');
const { edgesOf } = await load('mesh_edges');
const { MeasuredOriginal } = await load('two_sided');
const { mechanicalIn } = await load('strip');

const answer = Buffer.from(
  '--b\r\nContent-Type: a/b\r\nContent-Length: 6\r\n\r\n\r\n--b\r\r\n--b\r\nContent-Type: c/d\r\nContent-Length: 0\r\n\r\n\r\n--b--\r\n',
);

async function partsFrom(bytes, chunkSize) {
  const stream = new ReadableStream({
    start(controller) {
      for (let at = 0; at < bytes.length; at += chunkSize)
        controller.enqueue(new Uint8Array(bytes.subarray(at, at + chunkSize)));
      controller.close();
    },
  });
  const parts = [];
  for await (const { headers, body } of partsOf(stream, 'b'))
    parts.push([headers.get('content-type'), Buffer.from(body).toString()]);
  return parts;
}

test('the parts do not depend on the chunks of the answer, even if a body resembles a boundary', async () => {
  for (let size = 1; size <= answer.length; ++size)
    assert.deepEqual(await partsFrom(answer, size), [
      ['a/b', '\r\n--b\r'],
      ['c/d', ''],
    ]);
});

test('a truncated answer is an error at every length', async () => {
  for (let length = 0; length < answer.length - 2; ++length)
    await assert.rejects(partsFrom(answer.subarray(0, length), 7), /ended too soon/, String(length));
  await assert.rejects(partsFrom(Buffer.from('hello\r\n'), 7), /not divided/);
  await assert.rejects(partsFrom(Buffer.from('--b\r\n\r\nx'), 7), /length/);
});

test('the boundary is found in all valid spellings', () => {
  assert.equal(boundaryOf('multipart/mixed; boundary=abc-1'), 'abc-1');
  assert.equal(boundaryOf('multipart/mixed; charset=x; Boundary="a b"; c=d'), 'a b');
  assert.equal(boundaryOf('application/json'), null);
});

const defaults = {
  mesh: 'mug',
  modes: [...link.modes],
  arrangement: 'wipe',
  look: 'wireframe',
  where: 'here',
  ground: 'page',
  camera: null,
  frozen: null,
  values: new Map([['levels', '3']]),
};

test('a state is restored from its link; invalid fields of a link are ignored', () => {
  const state = {
    mesh: 'f'.repeat(64),
    modes: ['coarse', 'view'],
    arrangement: 'wipe',
    look: 'distance',
    where: 'here',
    ground: 'studio',
    camera: { eye: [1, -2.5, 3e-7], target: [0, 0, 1e9] },
    frozen: { eye: [0, 0, 3], target: [0, 0, 0], pixels: [640, 480] },
    values: new Map([
      ['flatness', '0.8,0.9'],
      ['view.lights', '0,0,1,1,0,0'],
      ['tension', 'off'],
    ]),
  };
  assert.deepEqual(link.fromHash(`#${link.toHash(state)}`, defaults), state);
  assert.deepEqual(link.fromHash('', defaults), defaults);
  assert.deepEqual(link.fromHash('#mesh=wheel', defaults), { ...defaults, mesh: 'wheel' });
  const strange = link.fromHash('#mesh=a&show=none,coarse&look=red&camera=1,2,x,4,5,6&levels=1', defaults);
  // As links were before these could be chosen.
  const earlier = { ...defaults, arrangement: 'panels', where: 'server' };
  assert.deepEqual(strange, { ...earlier, mesh: 'a', modes: ['coarse'], values: new Map([['levels', '1']]) });
});

test('commands are quoted for a shell, for any file name', () => {
  const base = 'http://host/';
  assert.equal(link.curlOf(base, null, { id: null, file: 'a', kind: 'draco' }, false), '');
  assert.match(
    link.curlOf(base, 'levels=2', { id: 'ab', file: 'a', kind: 'draco' }, true),
    /-H "Authorization: Bearer \$PAPILIO_KEY"/,
  );
  for (const file of ['a.drc', "it's $HOME `x`.drc", 'a b"c\\.drc']) {
    const command = link.curlOf(base, 'levels=2&flatness=0.8,0.9', { id: null, file, kind: 'draco' }, false);
    const words = execFileSync('bash', ['-c', `curl() { printf '%s\\0' "$@"; }; ${command}`])
      .toString()
      .split('\0');
    assert.ok(words.includes(`@${file}`), command);
    assert.ok(words.includes('http://host/v1/refine?levels=2&flatness=0.8,0.9'));
  }
});

test('values are validated as on the server', () => {
  const flatness = { name: 'flatness', type: 'numbers', min: -1, max: 1, least: 1, most: 10 };
  for (const text of ['0.8', '-1,1', '1e-3']) assert.equal(faultOf(flatness, text), null, text);
  for (const text of ['', '2', 'a', '0.8,', Array(11).fill('0').join()])
    assert.notEqual(faultOf(flatness, text), null, text);
  const lights = { name: 'view.lights', type: 'numbers', min: -1e18, max: 1e18, least: 3, most: 24, group: 3 };
  assert.equal(faultOf(lights, '0,0,1,1,0,0'), null);
  assert.match(faultOf(lights, '0,0,1,1'), /1 to 8 times 3 numbers/);
  assert.match(faultOf({ name: 'levels', type: 'integer', min: 0, max: 10 }, '1.5'), /whole/);
  assert.equal(rangeOf({ name: 'w', type: 'number', min: 0, max: 1e18, unit: 'pixels' }), 'at least 0, pixels');
});

test('the uniform result has no parameters of selection, and the adaptive one no view', () => {
  const values = new Map(
    Object.entries({
      tolerance: '1',
      max_faces: '2',
      w: '0.1',
      'view.near': '1',
      'output.speed': '5',
      simplify_hidden: 'true',
    }),
  );
  const view = { eye: [0, 0, 1 / 3], target: [0, 0, 0], pixels: [800, 600] };
  const names = (mode) => [...valuesFor(mode, values, view, 100).keys()];
  assert.deepEqual(names('uniform'), ['w', 'output.speed', 'levels']);
  assert.deepEqual(names('adaptive'), ['tolerance', 'max_faces', 'w', 'output.speed']);
  const kinds = ['view.eye', 'view.viewport', 'w'].map((name) => ({ name }));
  assert.equal(
    queryOf(valuesFor('view', values, view, 100), kinds),
    'view.eye=0,0,0.333333&view.viewport=800,600&w=0.1',
  );
  // Levels are chosen by the size, and without a target the adaptive result is as near as the picture asks for.
  const levels = (faces) => valuesFor('uniform', new Map(), view, faces).get('levels');
  assert.deepEqual([12, 4000, 70_000, 1e6].map(levels), ['3', '3', '1', '1']);
  const pixels = new Map([['view.error_pixels', '0.5']]);
  assert.equal(valuesFor('adaptive', pixels, view, 100).get('tolerance'), '0.0005');
  // With pixels, a tolerance does not keep the picture from being refined as the camera comes nearer.
  const both = new Map([...pixels, ['tolerance', '0.001']]);
  assert.equal(valuesFor('view', both, view, 100).has('tolerance'), false);
  assert.equal(valuesFor('view', new Map([['tolerance', '0.001']]), view, 100).get('tolerance'), '0.001');
  assert.equal(valuesFor('adaptive', both, view, 100).get('tolerance'), '0.001');
  // Surfaces are compared unless the camera moves or the user says otherwise.
  const verified = (given, isPassing) =>
    valuesFor('view', new Map([...pixels, ...given]), view, 100, isPassing).get('view.verify');
  assert.equal(verified([], false), undefined);
  assert.equal(verified([], true), 'false');
  for (const given of ['true', 'false'])
    for (const isPassing of [true, false]) assert.equal(verified([['view.verify', given]], isPassing), given);
});

/// A square of n by n cells in the plane z = height, from 0 to `side`.
function square(n, height, side = 1) {
  const positions = [];
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= n; ++j) positions.push((side * i) / n, (side * j) / n, height);
  const triangles = [];
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < n; ++j) {
      const a = i * (n + 1) + j;
      triangles.push(a, a + n + 1, a + n + 2, a, a + n + 2, a + 1);
    }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles) };
}

test('the distance between parallel squares is their height, at all faces', () => {
  const { rms, largest, diagonal, ofFaces } = new MeasuredOriginal(square(1, 0)).measure(square(3, 0.25));
  for (const distance of [rms, largest, ...ofFaces]) assert.ok(Math.abs(distance - 0.25) < 1e-9, `${distance}`);
  assert.ok(Math.abs(diagonal - Math.SQRT2) < 1e-9);
  assert.equal(ofFaces.length, 18);
});

test('the distance is the larger of both directions; a face has the distance of its nearest points', () => {
  // From the small square to the large one it is 0. From 0..2 to 0..1 it is by x and y beyond 1.
  const small = square(2, 0);
  const large = square(8, 0, 2);
  // The integral of the squared distance over the corner and both strips, by the area.
  const rms = Math.sqrt((1 / 3 + 1 / 3 + 2 / 3) / 4);
  for (const made of [new MeasuredOriginal(large).measure(small), new MeasuredOriginal(small).measure(large)]) {
    assert.ok(Math.abs(made.rms - rms) < 0.002 * rms, `${made.rms}, not ${rms}`);
    assert.ok(Math.abs(made.largest - Math.SQRT2) < 1e-6);
  }
  const { ofFaces } = new MeasuredOriginal(small).measure(large);
  assert.ok(ofFaces[0] < 1e-9 && Math.abs(Math.max(...ofFaces) - Math.SQRT2) < 1e-6);
  const marked = new MeasuredOriginal(large).measure(small).ofFaces;
  assert.ok(Math.max(...marked) > 1.3 && marked[0] < 0.01, `${marked}`);
});

test('points without faces, and faces without area, are not measured', () => {
  const { positions, triangles } = square(1, 0);
  const more = {
    positions: new Float32Array([...positions, 9, 9, 9]),
    triangles: new Uint32Array([...triangles, 0, 0, 1]),
  };
  for (const made of [
    new MeasuredOriginal(more).measure(square(1, 0)),
    new MeasuredOriginal(square(1, 0)).measure(more),
  ]) {
    assert.ok(made.largest < 1e-9 && made.rms < 1e-9, `${made.largest}`);
    assert.ok(Math.abs(made.diagonal - Math.SQRT2) < 1e-9);
  }
});

/// Each edge of a mesh as 'a b', a < b, by a table.
function edgesByTable(corners) {
  const edges = new Set();
  corners.forEach((a, i) => {
    const b = corners[i % 3 < 2 ? i + 1 : i - 2];
    edges.add(`${Math.min(a, b)} ${Math.max(a, b)}`);
  });
  return [...edges].sort();
}

function edgesAsText(ends) {
  const edges = [];
  for (let i = 0; i < ends.length; i += 2)
    edges.push(`${Math.min(ends[i], ends[i + 1])} ${Math.max(ends[i], ends[i + 1])}`);
  return edges.sort();
}

/// A grid of n x n squares, cut in halves; closed to a torus.
function gridOf(n, isClosed) {
  const side = isClosed ? n : n + 1;
  const at = (x, y) => (x % side) + side * (y % side);
  const corners = [];
  for (let y = 0; y < n; ++y)
    for (let x = 0; x < n; ++x)
      corners.push(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1));
  return { corners, vertices: side * side };
}

test('each edge of a closed surface is drawn once', () => {
  const { corners, vertices } = gridOf(40, true);
  const edges = edgesAsText(edgesOf(corners, vertices));
  assert.equal(edges.length, 3 * vertices);
  assert.deepEqual(edges, edgesByTable(corners));
});

test('no edge is missing at boundaries, at non-manifold edges, and between flipped faces', () => {
  const { corners, vertices } = gridOf(9, false);
  const fin = [...corners, 33, 34, vertices];
  const turned = fin.flatMap((_, i) =>
    i % 3 ? [] : (i / 3) % 5 ? fin.slice(i, i + 3) : fin.slice(i, i + 3).reverse(),
  );
  for (const mesh of [corners, fin, turned]) {
    const edges = edgesAsText(edgesOf(mesh, vertices + 1));
    assert.deepEqual([...new Set(edges)], edgesByTable(mesh));
    assert.ok(edges.length < mesh.length);
  }
});

test('the strip tells whether a model is mechanical, or pieces of it', () => {
  assert.equal(mechanicalIn('organic'), null);
  for (const whole of ['mechanical', 'mechanical: 1 of 1 component, 40 creases', 'mechanical: 7 of 7 components'])
    assert.equal(mechanicalIn(whole), 'This looks mechanical: its hard edges stay sharp.');
  const two = '2 of 14 pieces look mechanical: their hard edges stay sharp.';
  assert.equal(mechanicalIn('mechanical: 2 of 14 components, 32 creases'), two);
  const one = '1 of 3 pieces looks mechanical: its hard edges stay sharp.';
  assert.equal(mechanicalIn('mechanical: 1 of 3 components'), one);
});
