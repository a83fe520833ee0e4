// Packed models for the tests: shapes made by formula, what `papilio pack` makes of a mesh, and what `papilio unpack` reads.

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { deflateSync } from 'node:zlib';
import { build, root } from './requests.mjs';

const files = process.env.PAPILIO_MESHES ?? path.join(root, 'build/deps/meshes');
const draco3d = createRequire(path.join(root, 'client/web/package.json'))('draco3d');

/// A grid of n by n squares, `at(u, v)` with u and v in 0..1 being its points; equal points are one. Each side is a chart of
/// texture coordinates, beside the others.
function grid(n, ...sides) {
  const points = new Map();
  const number = (point) => {
    const key = point.map((x) => x.toFixed(9).replace('-0.000000000', '0.000000000')).join(' ');
    if (!points.has(key)) points.set(key, points.size);
    return points.get(key);
  };
  const faces = [];
  const texcoords = [];
  for (const [s, at] of sides.entries())
    for (let i = 0; i < n; ++i)
      for (let j = 0; j < n; ++j) {
        const [a, b, c, d] = [
          [i, j],
          [i + 1, j],
          [i + 1, j + 1],
          [i, j + 1],
        ].map(([k, l]) => number(at(k / n, l / n)));
        faces.push([a, b, c], [a, c, d]);
        const [left, right] = [i, i + 1].map((k) => (s + k / n) / sides.length);
        const [down, up] = [j / n, (j + 1) / n];
        texcoords.push([left, down, right, down, right, up], [left, down, right, up, left, up]);
      }
  return { points: [...points.keys()], faces, texcoords };
}

const circle = (share) => [Math.cos(2 * Math.PI * (share % 1)), Math.sin(2 * Math.PI * (share % 1))];
/// Closed and smooth.
const torus = grid(48, (u, v) => {
  const [[x, y], [r, z]] = [circle(u), circle(v)];
  const radius = 2 + r * (1 + 0.1 * circle(3 * u)[0]);
  return [radius * x, radius * y, z];
});
/// Open.
const waves = grid(56, (u, v) => [3 * u, 3 * v, 0.2 * Math.sin(5 * u) * Math.cos(4 * v)]);
/// Closed, its sides bulging between hard edges.
const cushion = grid(
  24,
  ...[0, 1, 2].flatMap((axis) =>
    [1, -1].map((side) => (u, v) => {
      const point = [0, 0, 0];
      point[axis] = side * (1 + 0.3 * Math.sin(Math.PI * u) * Math.sin(Math.PI * v));
      point[(axis + 1) % 3] = 2 * (side > 0 ? u : v) - 1;
      point[(axis + 2) % 3] = 2 * (side > 0 ? v : u) - 1;
      return point;
    }),
  ),
);
/// Open at both ends, with a hard edge along its middle.
const vase = grid(40, (u, v) => {
  const [x, y] = circle(u);
  const radius = 1 + (v < 0.5 ? v : 1 - v) + 0.1 * Math.sin(9 * v);
  return [radius * x, radius * y, 2 * v];
});

/// By name; those with a folder are files.
export const originals = { torus, waves, cushion, vase };

/// As PNG has it.
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/// A PNG of 32 by 32 pixels: squares of orange and blue.
export function checkerPng() {
  const rows = Array.from({ length: 32 }, (_, y) => [
    0, // no filter
    ...Array.from({ length: 32 }, (_, x) => ((x >> 2) + (y >> 2)) % 2).flatMap((is) =>
      is ? [230, 120, 30] : [30, 60, 200],
    ),
  ]);
  const chunk = (name, bytes) => {
    const made = Buffer.alloc(12 + bytes.length);
    made.writeUInt32BE(bytes.length);
    made.write(name, 4, 'latin1');
    Buffer.from(bytes).copy(made, 8);
    made.writeUInt32BE(crc32(made.subarray(4, 8 + bytes.length)), 8 + bytes.length);
    return made;
  };
  return Buffer.concat([
    Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
    chunk('IHDR', [0, 0, 0, 32, 0, 0, 0, 32, 8, 2, 0, 0, 0]),
    chunk('IDAT', deflateSync(Buffer.from(rows.flat()))),
    chunk('IEND', []),
  ]);
}

/// An OBJ file of a shape; `isTextured`: with texture coordinates and a material in a file of this name.
function objOf({ points, faces, texcoords }, isTextured, materials) {
  const lines = points.map((point) => `v ${point}`);
  if (!isTextured) return [...lines, ...faces.map((face) => `f ${face.map((v) => v + 1).join(' ')}`)].join('\n');
  const numbers = new Map();
  const numberOf = (u, v) => {
    if (!numbers.has(`${u} ${v}`)) numbers.set(`${u} ${v}`, numbers.size + 1);
    return numbers.get(`${u} ${v}`);
  };
  const corners = faces.map((face, f) =>
    face.map((v, i) => `${v + 1}/${numberOf(...texcoords[f].slice(2 * i, 2 * i + 2))}`).join(' '),
  );
  return [
    `mtllib ${materials}`,
    ...lines,
    ...[...numbers.keys()].map((texcoord) => `vt ${texcoord}`),
    'usemtl checker',
    ...corners.map((face) => `f ${face}`),
  ].join('\n');
}

/// The file of the original, and that of the packed model, in `folder`, its levels in pieces of so many bytes if asked.
/// `isTextured`: of a shape with texture coordinates and a material with an image.
export function pack(name, folder, { rms = 0.001, pieceBytes = null, isTextured = false } = {}) {
  const shape = originals[name];
  const stem = `${path.basename(name, path.extname(name))}${isTextured ? '-textured' : ''}`;
  const original = shape ? path.join(folder, `${stem}.obj`) : path.join(files, name);
  if (shape) writeFileSync(original, objOf(shape, isTextured, `${stem}.mtl`));
  if (isTextured) {
    writeFileSync(path.join(folder, `${stem}.mtl`), 'newmtl checker\nKd 1 1 1\nmap_Kd checker.png\n');
    writeFileSync(path.join(folder, 'checker.png'), checkerPng());
  }
  const packed = path.join(folder, `${stem}-${rms}-${pieceBytes ?? 'whole'}.glb`);
  const report = execFileSync(
    path.join(build, 'papilio'),
    [
      ...['pack', original, '-o', packed, '--rms', rms, '--no-simplify', '--json'],
      ...(pieceBytes === null ? [] : ['--piece-bytes', pieceBytes]),
    ],
    { encoding: 'utf8' },
  );
  return { original, packed, report: JSON.parse(report) };
}

/// The first levels of a packed model by the native decoder. Texture coordinates are upwards there.
export function unpack(packed, levels, ...more) {
  const ply = `${packed}.ply`;
  const flags = ['--levels', levels, ...more];
  execFileSync(path.join(build, 'papilio'), ['unpack', packed, '-o', ply, ...flags], { stdio: 'pipe' });
  const bytes = readFileSync(ply);
  const end = bytes.indexOf('end_header\n') + 11;
  const head = bytes.toString('latin1', 0, end);
  const [vertices, faces] = ['vertex', 'face'].map((of) => Number(new RegExp(`element ${of} (\\d+)`).exec(head)[1]));
  const properties = [...head.matchAll(/^property float (\w+)$/gm)].map(([, name]) => name);
  const begin = bytes.byteOffset + end;
  const values = new Float32Array(bytes.buffer.slice(begin, begin + 4 * properties.length * vertices));
  const only = (...names) => {
    const columns = names.map((name) => properties.indexOf(name));
    if (columns.includes(-1)) return undefined;
    return Float32Array.from({ length: names.length * vertices }, (_, i) => {
      return values[Math.floor(i / names.length) * properties.length + columns[i % names.length]];
    });
  };
  const triangles = new Uint32Array(3 * faces);
  for (let f = 0, at = end + values.byteLength; f < faces; ++f, at += 13)
    for (let i = 0; i < 3; ++i) triangles[3 * f + i] = bytes.readUInt32LE(at + 1 + 4 * i);
  const [positions, texcoords, normals] = [only('x', 'y', 'z'), only('s', 't'), only('nx', 'ny', 'nz')];
  return { head, positions, triangles, texcoords, normals };
}

/// As openPacked takes it.
export async function decodeDraco(draco) {
  const module = await draco3d.createDecoderModule({});
  const decoder = new module.Decoder();
  const buffer = new module.DecoderBuffer();
  buffer.Init(draco, draco.length);
  const mesh = new module.Mesh();
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  if (!status.ok()) throw new Error(status.error_msg(), { cause: 'draco' });
  const valuesOf = (kind) => {
    const id = decoder.GetAttributeId(mesh, kind);
    if (id < 0) return undefined;
    const values = new module.DracoFloat32Array();
    decoder.GetAttributeFloatForAllPoints(mesh, decoder.GetAttribute(mesh, id), values);
    return Float32Array.from({ length: values.size() }, (_, i) => values.GetValue(i));
  };
  const bytes = 12 * mesh.num_faces();
  const pointer = module._malloc(bytes);
  decoder.GetTrianglesUInt32Array(mesh, bytes, pointer);
  return {
    positions: valuesOf(module.POSITION),
    triangles: new Uint32Array(module.HEAPU32.buffer, pointer, bytes / 4).slice(),
    texcoords: valuesOf(module.TEX_COORD),
  };
}
