// Meshes and random requests, and what the C functions, compiled for this machine, make of them.

import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';

export const root = new URL('../..', import.meta.url).pathname;
export const build = process.env.PAPILIO_BUILD ?? path.join(root, 'build/release');
const kernelResults = path.join(build, 'kernel_results');
const files = process.env.PAPILIO_MESHES ?? path.join(root, 'build/deps/meshes');

const kinds = ['values', 'normals', 'smoothing-groups', 'displacements'];
const faults = ['bad-parameter', 'unusable-mesh', 'too-large', 'cancelled', 'out-of-memory', 'internal'];
const stopReasons = ['converged', 'levels', 'budget', 'limits'];

/// Numbers in 0..1 that are the same in each run (mulberry32).
export function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/// The triangles of an OFF or OBJ file that has nothing else.
export function readMesh(name) {
  const text = readFileSync(path.join(files, name), 'utf8').replace(/#.*/g, '');
  const positions = [];
  const triangles = [];
  const addFace = (face) => {
    for (let i = 2; i < face.length; ++i) triangles.push(face[0], face[i - 1], face[i]);
  };
  if (name.endsWith('.obj')) {
    for (const line of text.split('\n')) {
      const [head, ...rest] = line.trim().split(/\s+/);
      if (head === 'v') positions.push(...rest.map(Number));
      if (head === 'f') addFace(rest.map((word) => parseInt(word) - 1));
    }
  } else {
    const words = text.split(/\s+/).filter(Boolean).slice(1).map(Number);
    const [points, faces] = words;
    let at = 3;
    for (; positions.length < 3 * points; ++at) positions.push(words[at]);
    for (let f = 0; f < faces; ++f) {
      addFace(words.slice(at + 1, at + 1 + words[at]));
      at += 1 + words[at];
    }
  }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles) };
}

/// A cone of `valence` faces about its tip, open: the stencils of high valences.
export function cone(valence) {
  const angles = Array.from({ length: valence }, (_, i) => (2 * Math.PI * i) / valence);
  return {
    positions: new Float32Array([
      0,
      0,
      0.4,
      ...angles.flatMap((a) => [Math.cos(a), Math.sin(a), 0.1 * Math.sin(3 * a)]),
    ]),
    triangles: new Uint32Array(angles.flatMap((_, i) => [0, 1 + i, 1 + ((i + 1) % valence)])),
  };
}

/// A torus of n by n squares with texture coordinates, which have seams, and whatever else is carried.
export function torusWithAttributes(n) {
  const positions = [];
  const triangles = [];
  const [places, normals, groups, moves] = [[], [], [], []];
  for (let i = 0; i <= n; ++i)
    for (let j = 0; j <= n; ++j) {
      const [a, b] = [i, j].map((k) => (2 * Math.PI * (k % n)) / n);
      positions.push((2 + Math.cos(b)) * Math.cos(a), (2 + Math.cos(b)) * Math.sin(a), Math.sin(b));
      places.push(i / n, j / n);
      normals.push(Math.cos(b) * Math.cos(a), Math.cos(b) * Math.sin(a), Math.sin(b));
      groups.push(1);
      moves.push(0.1 * Math.sin(a), 0.1 * Math.cos(b), 0.2 * Math.cos(2 * a));
    }
  const at = (i, j) => i * (n + 1) + j;
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < n; ++j)
      triangles.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
  const attribute = (kind, components, values) => ({ kind, components, values: new Float64Array(values) });
  return {
    positions: new Float32Array(positions),
    triangles: new Uint32Array(triangles),
    attributes: [
      attribute('values', 2, places),
      attribute('normals', 3, normals),
      attribute('smoothing-groups', 1, groups),
      attribute('displacements', 3, moves),
    ],
  };
}

/// The parameters of one request, as a query. `size`: of the mesh.
export function randomQuery(random, size) {
  const pick = (...of) => of[Math.floor(random() * of.length)];
  const some = (chance, ...fields) => (random() < chance ? fields : []);
  const number = (low, high) => (low + (high - low) * random()).toPrecision(6);
  const point = (reach) => [0, 1, 2].map(() => number(-reach, reach)).join(',');
  const scheme = pick('red-green', 'red-green', 'in-place');
  return [
    `levels=${pick(0, 1, 2, 2, 3)}`,
    `scheme=${scheme}`,
    `shape=${pick('auto', 'organic', 'mechanical', 'plain')}`,
    `tension=${pick('soft', 'off', 'sharp')}`,
    ...some(0.3, `w=${number(-0.06, 0.12)}`),
    ...some(0.3, `crease_angle=${number(20, 120)}`),
    ...some(0.3, `flatness=${number(0.7, 0.999)},${number(0.7, 0.999)}`),
    ...some(0.3, `growth=${pick(0, 1, 2)}`),
    ...some(0.4, `tolerance=${pick(0.01, 0.003, 0.001, 0.0003)}`),
    ...some(0.2, `max_faces=${20000 + Math.floor(5000 * random())}`),
    ...some(0.3, 'output.normals=true'),
    ...some(
      0.4,
      `view.eye=${point(3 * size)}`,
      `view.projection=${pick('perspective', 'orthographic')}`,
      ...some(0.6, `view.error_pixels=${pick(0.5, 1, 3)}`),
      ...some(0.2, `view.lights=${point(1)}`),
      ...some(0.4, 'simplify_hidden=true'),
    ),
  ].join('&');
}

/// What kernel_results gives for each query: `{ mesh, statistics }`, or `{ fault, message, parameter }`.
export function nativeResults(mesh, queries) {
  const { file, remove } = writeMesh(mesh);
  try {
    const input = `${queries.join('\n')}\n`;
    return readResults(execFileSync(kernelResults, [file], { input, maxBuffer: 2 ** 31 }), queries.length);
  } finally {
    remove();
  }
}

/// A process of kernel_results that stays. `refine` refines so often, and returns the milliseconds of all by the clock.
export function nativeProcess(mesh) {
  const { file, remove } = writeMesh(mesh);
  const child = spawn(kernelResults, [file, '--times'], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  return {
    pid: child.pid,
    async refine(query, times = 1) {
      child.stdin.write(`${query}\n`.repeat(times));
      let sum = 0;
      for (let i = 0; i < times; ++i) {
        const { value, done } = await lines.next();
        if (done) throw new Error(`kernel_results cannot refine by ${query}`);
        sum += Number(value);
      }
      return sum;
    },
    stop() {
      child.stdin.end();
      remove();
    },
  };
}

/// Writes a mesh where kernel_results reads it.
function writeMesh({ positions, triangles, attributes = [] }) {
  const folder = mkdtempSync(path.join(tmpdir(), 'kernel-'));
  const file = path.join(folder, 'mesh');
  const bytesOf = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  const head = [positions.length / 3, triangles.length / 3, attributes.length];
  for (const { components, kind } of attributes) head.push(components, kinds.indexOf(kind));
  const arrays = [new Uint32Array(head), positions, triangles, ...attributes.map(({ values }) => values)];
  writeFileSync(file, Buffer.concat(arrays.map(bytesOf)));
  return { file, remove: () => rmSync(folder, { recursive: true }) };
}

function readResults(bytes, count) {
  let at = 0;
  const take = (Type, length) => {
    const size = length * Type.BYTES_PER_ELEMENT;
    const copy = new Uint8Array(size);
    copy.set(bytes.subarray(at, at + size));
    at += size;
    return new Type(copy.buffer);
  };
  const text = () => {
    const end = bytes.indexOf(0, at);
    const words = bytes.toString('utf8', at, end);
    at = end + 1;
    return words;
  };
  return Array.from({ length: count }, () => {
    const [fault] = take(Uint32Array, 1);
    if (fault !== 0) return { fault: faults[fault - 1], message: text(), parameter: text() };
    const [level, isLast, stopReason, components, mechanical, creases] = take(Uint32Array, 6);
    const [error, errorPixels] = take(Float64Array, 2);
    const [points, faces, attributeCount] = take(Uint32Array, 3);
    const rows = take(Uint32Array, 2 * attributeCount);
    return {
      statistics: {
        level,
        isLast: isLast !== 0,
        stopReason: stopReasons[stopReason],
        components,
        mechanical,
        creases,
        error,
        errorPixels,
      },
      mesh: {
        positions: take(Float32Array, 3 * points),
        triangles: take(Uint32Array, 3 * faces),
        attributes: Array.from({ length: attributeCount }, (_, a) => ({
          kind: kinds[rows[2 * a + 1]],
          components: rows[2 * a],
          values: take(Float64Array, points * rows[2 * a]),
        })),
      },
    };
  });
}

/// Whether two arrays have the same bytes: as equal numbers, -0 and 0 are not.
export function areSame(a, b) {
  return Buffer.from(a.buffer, a.byteOffset, a.byteLength).equals(Buffer.from(b.buffer, b.byteOffset, b.byteLength));
}

/// The meshes of the comparison, by name.
export function meshes() {
  const all = new Map();
  for (const name of ['bunny600.obj', 'elephant2000.obj', 'cgal/3torus.off', 'cgal/anchor.off', 'cgal/P.off'])
    all.set(name, readMesh(name));
  for (const name of ['cgal/couplingdown.off', 'cgal/cube-ouvert.off', 'cgal/bear_bis.off', 'cgal/blobby_3cc.off'])
    all.set(name, readMesh(name));
  for (const valence of [33, 40, 59, 60]) all.set(`cone of ${valence}`, cone(valence));
  all.set('torus with attributes', torusWithAttributes(12));
  return all;
}

export function sizeOf({ positions }) {
  return positions.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
}
