// Packed models for the tests: shapes made by formula, what `papilio pack` makes of a mesh, and what `papilio unpack` reads.

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { build, root } from './requests.mjs';

const files = process.env.PAPILIO_MESHES ?? path.join(root, 'build/deps/meshes');
const draco3d = createRequire(path.join(root, 'client/web/package.json'))('draco3d');

/// A grid of n by n squares, `at(u, v)` with u and v in 0..1 being its points; equal points are one.
function grid(n, ...sides) {
  const points = new Map();
  const number = (point) => {
    const key = point.map((x) => x.toFixed(9).replace('-0.000000000', '0.000000000')).join(' ');
    if (!points.has(key)) points.set(key, points.size);
    return points.get(key);
  };
  const faces = [];
  for (const at of sides)
    for (let i = 0; i < n; ++i)
      for (let j = 0; j < n; ++j) {
        const [a, b, c, d] = [
          [i, j],
          [i + 1, j],
          [i + 1, j + 1],
          [i, j + 1],
        ].map(([k, l]) => number(at(k / n, l / n)));
        faces.push([a, b, c], [a, c, d]);
      }
  return { points: [...points.keys()], faces };
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

/// The file of the original, and that of the packed model, in `folder`, its levels in pieces of so many bytes if asked.
export function pack(name, folder, { rms = 0.001, pieceBytes = null } = {}) {
  const shape = originals[name];
  const original = shape ? path.join(folder, `${name}.obj`) : path.join(files, name);
  if (shape)
    writeFileSync(
      original,
      [...shape.points.map((p) => `v ${p}`), ...shape.faces.map((f) => `f ${f.map((v) => v + 1).join(' ')}`)].join(
        '\n',
      ),
    );
  const packed = path.join(folder, `${path.basename(name, path.extname(name))}-${rms}-${pieceBytes ?? 'whole'}.glb`);
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

/// The first levels of a packed model by the native decoder.
export function unpack(packed, levels, ...more) {
  const ply = `${packed}.ply`;
  const flags = ['--levels', levels, ...more];
  execFileSync(path.join(build, 'papilio'), ['unpack', packed, '-o', ply, ...flags], { stdio: 'pipe' });
  const bytes = readFileSync(ply);
  const end = bytes.indexOf('end_header\n') + 11;
  const head = bytes.toString('latin1', 0, end);
  const [vertices, faces] = ['vertex', 'face'].map((of) => Number(new RegExp(`element ${of} (\\d+)`).exec(head)[1]));
  const positions = new Float32Array(
    bytes.buffer.slice(bytes.byteOffset + end, bytes.byteOffset + end + 12 * vertices),
  );
  const triangles = new Uint32Array(3 * faces);
  for (let f = 0, at = end + 12 * vertices; f < faces; ++f, at += 13)
    for (let i = 0; i < 3; ++i) triangles[3 * f + i] = bytes.readUInt32LE(at + 1 + 4 * i);
  return { head, positions, triangles };
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
  const position = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, module.POSITION));
  const values = new module.DracoFloat32Array();
  decoder.GetAttributeFloatForAllPoints(mesh, position, values);
  const bytes = 12 * mesh.num_faces();
  const pointer = module._malloc(bytes);
  decoder.GetTrianglesUInt32Array(mesh, bytes, pointer);
  return {
    positions: Float32Array.from({ length: values.size() }, (_, i) => values.GetValue(i)),
    triangles: new Uint32Array(module.HEAPU32.buffer, pointer, bytes / 4).slice(),
  };
}
