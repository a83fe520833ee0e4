// What papilio writes, read by two decoders that are not its own: npm's draco3d and Debian's draco_decoder.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

import { build, meshes, root } from './browser.mjs';

const draco3d = createRequire(join(root, 'client/web/package.json'))('draco3d');
const folder = mkdtempSync(join(tmpdir(), 'papilio-draco3d-'));
after(() => rmSync(folder, { recursive: true }));

/// Positions [vertices * 3] and triangles [faces * 3].
async function byDraco3d(bytes) {
  const module = await draco3d.createDecoderModule({});
  const decoder = new module.Decoder();
  const buffer = new module.DecoderBuffer();
  buffer.Init(bytes, bytes.length);
  const mesh = new module.Mesh();
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  assert.ok(status.ok(), status.error_msg());
  const position = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, module.POSITION));
  const values = new module.DracoFloat32Array();
  decoder.GetAttributeFloatForAllPoints(mesh, position, values);
  const positions = Array.from({ length: values.size() }, (_, i) => values.GetValue(i));
  const bytesOfTriangles = 12 * mesh.num_faces();
  const pointer = module._malloc(bytesOfTriangles);
  decoder.GetTrianglesUInt32Array(mesh, bytesOfTriangles, pointer);
  const triangles = Array.from(new Uint32Array(module.HEAPU32.buffer, pointer, 3 * mesh.num_faces()));
  return { positions, triangles };
}

function byDracoDecoder(file) {
  execFileSync('draco_decoder', ['-i', file, '-o', `${file}.obj`]);
  const lines = readFileSync(`${file}.obj`, 'utf8').split('\n');
  const rows = (key) => lines.filter((line) => line.startsWith(`${key} `)).map((line) => line.split(' ').slice(1));
  const corners = rows('f').flatMap((row) => row.map((corner) => Number(corner.split('/')[0]) - 1));
  return { positions: rows('v').flat().map(Number), triangles: corners };
}

/// Coordinates [faces * 3 * 3] of the triangles' corners.
function corners({ positions, triangles }) {
  return triangles.flatMap((vertex) => positions.slice(3 * vertex, 3 * vertex + 3));
}

// Closed, a torus, open, in many parts, and not manifold.
for (const name of [
  'elephant2k.drc',
  'cgal/rotor_small.off',
  'cgal/lion-head.off',
  'cgal/bones.off',
  'cgal/diplodocus.off',
])
  for (const speed of [7, 3])
    test(`${name} at speed ${speed}: both decoders read the same mesh`, async () => {
      const file = join(folder, 'refined.drc');
      for (const levels of [0, 1, 2]) {
        const options = ['--levels', levels, '--output.speed', speed, '--json'];
        const told = execFileSync(join(build, 'papilio'), ['refine', join(meshes, name), '-o', file, ...options]);
        const ours = await byDraco3d(readFileSync(file));
        const theirs = byDracoDecoder(file);
        assert.equal(ours.triangles.length, 3 * JSON.parse(told).faces);
        assert.equal(theirs.triangles.length, ours.triangles.length);
        assert.equal(theirs.positions.length, ours.positions.length);
        // Each numbers the vertices in its own way; the corners are in the stream's order.
        const [a, b] = [ours, theirs].map(corners);
        const largest = a.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
        const furthest = a.reduce((most, x, i) => Math.max(most, Math.abs(x - b[i])), 0);
        assert.ok(furthest <= 1e-5 * largest, `${furthest}`); // the text has six digits
      }
    });
