// Packed models for the tests: shapes made by formula, what `papilio pack` makes of a mesh, and what `papilio unpack` reads.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { deflateSync } from 'node:zlib';
import { areSame, build, root } from './requests.mjs';

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

/// Materials of the files of originals: of the faces to one side of a plane that cuts all shapes, and of the others.
export const materialNames = ['checker', 'plain'];
const coordinatesOf = (point) => point.split(' ').map(Number);
const materialOf = ({ points }, face) => {
  const corners = face.map((v) => coordinatesOf(points[v]));
  const [x, y, z] = [0, 1, 2].map((axis) => corners.reduce((sum, corner) => sum + corner[axis] / 3, 0));
  return x + 0.3 * y + 0.2 * z < 0.4 ? 0 : 1;
};

/// Lines of an OBJ file for faces, each with its text, under their materials.
function facesWithMaterials(shape, texts, isParted) {
  let last = null;
  return texts.flatMap((text, f) => {
    const material = materialNames[isParted ? materialOf(shape, shape.faces[f]) : 0];
    const lines = [...(material === last ? [] : [`usemtl ${material}`]), `f ${text}`];
    last = material;
    return lines;
  });
}

/// An OBJ file of a shape; `isTextured`: with texture coordinates and a material in a file of this name; `isParted`: with two
/// materials there.
function objOf(shape, { isTextured, isParted }, materials) {
  const { points, faces, texcoords } = shape;
  const lines = points.map((point) => `v ${point}`);
  const plain = faces.map((face) => face.map((v) => v + 1).join(' '));
  if (!isTextured && !isParted) return [...lines, ...plain.map((face) => `f ${face}`)].join('\n');
  if (!isTextured) return [`mtllib ${materials}`, ...lines, ...facesWithMaterials(shape, plain, true)].join('\n');
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
    ...facesWithMaterials(shape, corners, isParted),
  ].join('\n');
}

/// A PLY file of a shape with colours: waves of red and green, steps of blue. `isTextured`: with texture coordinates, for which
/// each corner of a face is a point.
function plyOf({ points, faces, texcoords }, isTextured) {
  const row = (v) => {
    const [x, y, z] = coordinatesOf(points[v]);
    const [red, green] = [Math.sin(4 * x), Math.cos(3 * y + z)].map((wave) => Math.round(127.5 + 127.5 * wave));
    return `${x} ${y} ${z} ${red} ${green} ${z > 0.1 ? 230 : 20}`;
  };
  const rows = isTextured
    ? faces.flatMap((face, f) => face.map((v, i) => `${row(v)} ${texcoords[f][2 * i]} ${texcoords[f][2 * i + 1]}`))
    : points.map((_, v) => row(v));
  const properties = ['float x', 'float y', 'float z', 'uchar red', 'uchar green', 'uchar blue'];
  if (isTextured) properties.push('float s', 'float t');
  return [
    ...['ply', 'format ascii 1.0', `element vertex ${rows.length}`, ...properties.map((one) => `property ${one}`)],
    ...[`element face ${faces.length}`, 'property list uchar int vertex_indices', 'end_header', ...rows],
    ...faces.map((face, f) => `3 ${(isTextured ? [3 * f, 3 * f + 1, 3 * f + 2] : face).join(' ')}`),
    '',
  ].join('\n');
}

/// The file of the original, and that of the packed model, in `folder`, its levels in pieces of so many bytes if asked.
/// `isTextured`: of a shape with texture coordinates and a material with an image; `isParted`: with two materials;
/// `isColoured`: with colours of vertices, and no materials.
export function pack(name, folder, options = {}) {
  const { rms = 0.001, pieceBytes = null, isTextured = false, isParted = false, isColoured = false } = options;
  const shape = originals[name];
  const kinds = [...(isTextured ? ['-textured'] : []), ...(isParted ? ['-parted'] : [])].join('');
  const stem = `${path.basename(name, path.extname(name))}${kinds}${isColoured ? '-coloured' : ''}`;
  const original = shape ? path.join(folder, `${stem}.${isColoured ? 'ply' : 'obj'}`) : path.join(files, name);
  const text = () => (isColoured ? plyOf(shape, isTextured) : objOf(shape, { isTextured, isParted }, `${stem}.mtl`));
  if (shape) writeFileSync(original, text());
  if (!isColoured && (isTextured || isParted)) {
    const image = isTextured ? 'Kd 1 1 1\nmap_Kd checker.png' : 'Kd 0.9 0.4 0.05';
    writeFileSync(path.join(folder, `${stem}.mtl`), `newmtl checker\n${image}\nnewmtl plain\nKd 0.05 0.2 0.8\n`);
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
  const places = new Map();
  let stride = 0;
  for (const [, type, name] of head.matchAll(/^property (float|uchar) (\w+)$/gm)) {
    places.set(name, stride);
    stride += type === 'float' ? 4 : 1;
  }
  const read = (Values, names, valueAt) => {
    if (names.some((name) => !places.has(name))) return undefined;
    return Values.from({ length: names.length * vertices }, (_, i) => {
      return valueAt(end + Math.floor(i / names.length) * stride + places.get(names[i % names.length]));
    });
  };
  const only = (...names) => read(Float32Array, names, (at) => bytes.readFloatLE(at));
  const triangles = new Uint32Array(3 * faces);
  for (let f = 0, at = end + stride * vertices; f < faces; ++f, at += 13)
    for (let i = 0; i < 3; ++i) triangles[3 * f + i] = bytes.readUInt32LE(at + 1 + 4 * i);
  const [positions, texcoords, normals] = [only('x', 'y', 'z'), only('s', 't'), only('nx', 'ny', 'nz')];
  const colours = read(Uint8Array, ['red', 'green', 'blue'], (at) => bytes.readUInt8(at));
  return { head, positions, triangles, texcoords, colours, normals };
}

/// As meshes other than glTF have them, upwards.
export const turnedOver = (values) => values?.map((value, i) => (i % 2 === 0 ? value : 1 - value));

/// `made`: by papilio/detail; `expected`: by `unpack`.
export function assertSame(made, expected, what) {
  for (const name of ['triangles', 'positions', 'texcoords', 'colours', 'normals']) {
    const own = name === 'texcoords' ? turnedOver(made[name]) : made[name];
    assert.equal(own?.length, expected[name]?.length, `${name}: ${what}`);
    if (own) assert.ok(areSame(own, expected[name]), `${name}: ${what}`);
  }
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
  const valuesOf = (kind, Values = Float32Array) => {
    const id = decoder.GetAttributeId(mesh, kind);
    if (id < 0) return undefined;
    const values = Values === Float32Array ? new module.DracoFloat32Array() : new module.DracoUInt8Array();
    const take = `GetAttribute${Values === Float32Array ? 'Float' : 'UInt8'}ForAllPoints`;
    decoder[take](mesh, decoder.GetAttribute(mesh, id), values);
    return Values.from({ length: values.size() }, (_, i) => values.GetValue(i));
  };
  const bytes = 12 * mesh.num_faces();
  const pointer = module._malloc(bytes);
  decoder.GetTrianglesUInt32Array(mesh, bytes, pointer);
  return {
    positions: valuesOf(module.POSITION),
    triangles: new Uint32Array(module.HEAPU32.buffer, pointer, bytes / 4).slice(),
    texcoords: valuesOf(module.TEX_COORD),
    colours: valuesOf(module.COLOR, Uint8Array),
  };
}
