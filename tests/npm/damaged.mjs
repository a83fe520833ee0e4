// Packed models that are damaged: by hand, and at random, when what papilio/detail makes of them is compared with the native
// reader.

import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { decodeDraco, unpack } from './packed.mjs';
import { randomNumbers, root } from './requests.mjs';

const { decodeBase, DetailDecoder, isPacked, readPacked } = await import(path.join(root, 'build/npm/dist/detail.js'));

/// The file with other bytes in the table of its levels.
export function withTable(file, change) {
  const bytes = Buffer.from(file);
  const { draco } = readPacked(new Uint8Array(file)).base.primitives.at(-1);
  change(bytes.subarray(draco.byteOffset + draco.length));
  return new Uint8Array(bytes);
}

/// The file with another document.
export function edited(file, change) {
  const bytes = Buffer.from(file);
  const end = 20 + bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, end));
  const detail = json.meshes[0].primitives[0].extensions.PAPILIO_detail;
  change({ json, detail, primitive: json.meshes[0].primitives[0] });
  let text = JSON.stringify(json);
  text = text.padEnd(Math.ceil(text.length / 4) * 4);
  const head = Buffer.from(bytes.subarray(0, 20));
  head.writeUInt32LE(text.length, 12);
  const made = Buffer.concat([head, Buffer.from(text), bytes.subarray(end)]);
  made.writeUInt32LE(made.length, 8);
  return new Uint8Array(made);
}

export function assertRefused(file, code, message, change) {
  assert.throws(
    () => readPacked(file),
    (error) => {
      assert.equal(error.name, 'Problem', String(change));
      assert.deepEqual([error.code, message.test(error.message)], [code, true], `${change}: ${error.message}`);
      return true;
    },
  );
}

/// `packed`: a file, which is read.
export async function compareDamaged(packed, { module, assertSame }) {
  const file = readFileSync(packed);
  const random = randomNumbers(7);
  const below = (n) => Math.floor(n * random());
  const jsonEnd = 20 + file.readUInt32LE(12);
  // Damage to the Draco streams is for their decoder to find.
  const { primitives } = readPacked(new Uint8Array(file)).base;
  const streams = primitives.reduce((sum, { draco }) => sum + draco.length, jsonEnd + 8);
  const damaged = `${packed}.damaged.glb`;
  const seen = { decoded: 0, refused: 0 };
  for (let i = 0; i < 150; ++i) {
    const bytes = Buffer.from(file);
    for (let k = below(3); k >= 0; --k)
      if (i % 2 === 0) {
        let at = 20 + below(jsonEnd - 20);
        while (random() < 0.8 && !/\d/.test(String.fromCharCode(bytes[at]))) at = 20 + below(jsonEnd - 20);
        bytes[at] = '0123456789.-eE",:{}[] '.charCodeAt(below(random() < 0.7 ? 10 : 22));
      } else if (random() < 0.1) bytes[below(20)] = below(256);
      else bytes[streams + below(bytes.length - streams)] = below(256);
    if (!isPacked(new Uint8Array(bytes))) {
      assert.throws(() => readPacked(new Uint8Array(bytes)), { name: 'Problem' });
      continue; // papilio unpack reads plain scenes too
    }
    writeFileSync(damaged, bytes);
    let [native, refusal] = [null, ''];
    try {
      native = unpack(damaged, 3);
    } catch (error) {
      refusal = String(error.stderr);
      assert.equal(error.status, 1, refusal);
    }
    let made = null;
    try {
      made = await decodeAsDeclared(new Uint8Array(bytes), 3, module);
    } catch (error) {
      if (error.cause === 'draco') continue;
      assert.ok(error.name === 'Problem' || error.name === 'AssertionError', error.stack);
    }
    assert.equal(made !== null, native !== null, `file ${i}: ${refusal}`);
    if (made !== null) assertSame(made, native, `file ${i}`);
    ++seen[made === null ? 'refused' : 'decoded'];
  }
  assert.ok(seen.decoded >= 20 && seen.refused >= 20, JSON.stringify(seen));
}

/// As openPacked does it.
async function decodeAsDeclared(bytes, count, module) {
  const { base, curves, levels } = readPacked(bytes, { maxFaces: 2 ** 30 });
  const triangles = await decodeBase(base, decodeDraco);
  const decoder = new DetailDecoder(module, triangles, curves);
  let [edges, { faces }] = [decoder.countEdges(), base];
  for (const { residualCount } of levels) {
    assert.equal(residualCount, edges);
    edges = 2 * edges + 3 * faces;
    faces *= 4;
  }
  return decoder.decode(levels.slice(0, count));
}
