// papilio/detail and PapilioLoader in headless Chromium: packed models are decoded in a worker.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch } from '../web/browser.mjs';
import { page as pageOf, startFiles } from './files.mjs';
import { materialNames, pack, unpack } from './packed.mjs';
import { root } from './requests.mjs';

const { readPacked } = await import(path.join(root, 'build/npm/dist/detail.js'));

const html = pageOf(`<script type="module">
  import { openPacked } from 'papilio/detail';
  import { dracoDecoder, PapilioLoader } from 'papilio/three';
  import * as THREE from 'three';
  import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
  const decodeDraco = dracoDecoder(new DRACOLoader());
  const fetched = async (url) => new Uint8Array(await (await fetch(url)).arrayBuffer());
  const open = async (url, options = {}) => openPacked(await fetched(url), { decodeDraco, ...options });
  /** SHA-256 of the arrays. */
  const digest = async ({ positions, triangles }) => {
    const bytes = await new Blob([positions, triangles]).arrayBuffer();
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
    return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  };
  /** What a promise is rejected with. */
  const refusal = (promise) => promise.then(() => null, ({ name, code, message }) => ({ name, code, message }));
  Object.assign(window, { THREE, PapilioLoader, fetched, open, openPacked, decodeDraco, digest, refusal });
  document.documentElement.dataset.state = 'ready';
</script>`);

const folder = mkdtempSync(path.join(tmpdir(), 'papilio-detail-'));
const { packed, report } = pack('vase', folder);
const glb = readFileSync(packed);
const textured = pack('cushion', folder, { isTextured: true });
const parted = pack('vase', folder, { isParted: true });
const coloured = pack('waves', folder, { isColoured: true });

let files;
let browser;
before(async () => {
  [files, browser] = await Promise.all([
    startFiles({
      ...{ '/page.html': html, '/vase.glb': glb, '/textured.glb': readFileSync(textured.packed) },
      ...{ '/parted.glb': readFileSync(parted.packed), '/coloured.glb': readFileSync(coloured.packed) },
    }),
    launch(),
  ]);
});
after(async () => {
  await browser.close();
  files.stop();
  rmSync(folder, { recursive: true });
});

async function open() {
  const page = await browser.newPage();
  page.setDefaultTimeout(60_000);
  const requests = [];
  page.on('request', (request) => requests.push(new URL(request.url()).pathname));
  await page.goto(`${files.url}/page.html`);
  await page.waitForSelector('html[data-state=ready]', { state: 'attached' });
  return { page, requests };
}

test('a worker decodes each level to the bits of papilio unpack', async () => {
  const { page, requests } = await open();
  const fetched = () => requests.filter((name) => name.endsWith('papilio-detail.wasm')).length;
  assert.equal(fetched(), 0, 'the module is fetched before there is a packed model');
  const made = await page.evaluate(async () => {
    const model = await open('/vase.glb');
    const levels = [model.base, ...model.levels];
    const all = await Promise.all(levels.map(async (_, k) => digest(await model.decode(k))));
    model.close();
    return { levels, all, afterwards: await refusal(model.decode(0)) };
  });
  assert.equal(fetched(), 1);
  const native = [report.base, ...report.levels].map((_, k) => unpack(packed, k));
  const digests = native.map(({ positions, triangles }) =>
    createHash('sha256')
      .update(new Uint8Array(positions.buffer))
      .update(new Uint8Array(triangles.buffer))
      .digest('hex'),
  );
  assert.deepEqual(made.all, digests);
  assert.deepEqual(
    made.levels.map(({ faces, vertices }) => [faces, vertices]),
    native.map(({ triangles, positions }) => [triangles.length / 3, positions.length / 3]),
  );
  assert.deepEqual(
    made.levels.slice(1).map(({ bytes }) => bytes),
    report.levels.map(({ bytes }) => bytes),
  );
  // What is stated is rounded up to four digits.
  for (const [l, { rms, largest }] of made.levels.entries()) {
    const stated = [report.base, ...report.levels][l];
    assert.ok(Math.abs(rms - stated.rms) <= 0.001 * stated.rms, `${rms}, ${stated.rms}`);
    assert.ok(Math.abs(largest - stated.largest) <= 0.001 * stated.largest);
  }
  assert.match(made.afterwards.message, /was closed/);
  await page.close();
});

test('an aborted decoding stops, and the next one runs', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const model = await open('/vase.glb');
    const abort = new AbortController();
    const given = refusal(model.decode(model.levels.length, { signal: abort.signal }));
    const waiting = refusal(model.decode(1, { signal: abort.signal }));
    const kept = model.decode(2);
    abort.abort();
    const late = await refusal(model.decode(1, { signal: abort.signal }));
    const bad = await refusal(model.decode(99));
    return { given: await given, waiting: await waiting, late, bad, faces: (await kept).triangles.length / 3 };
  });
  for (const one of [seen.given, seen.waiting, seen.late]) assert.equal(one.name, 'AbortError');
  assert.equal(seen.bad.name, 'RangeError');
  assert.equal(seen.faces, report.levels[1].faces);
  await page.close();
});

test('a prefix opens if prefixes are allowed, with its complete levels', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const whole = await open('/vase.glb');
    const bytes = await fetched('/vase.glb');
    const prefix = bytes.slice(0, whole.levels[1].fileBytes);
    const refused = await refusal(openPacked(prefix, { decodeDraco }));
    const cut = await openPacked(prefix, { decodeDraco, mayBeCut: true });
    const same = (await digest(await cut.decode(2))) === (await digest(await whole.decode(2)));
    return { refused, levels: cut.levels.length, declared: cut.declaredLevels, same };
  });
  assert.equal(seen.refused.code, 'mesh_not_gltf');
  assert.deepEqual([seen.levels, seen.declared, seen.same], [2, report.levels.length, true]);
  await page.close();
});

test('a base that differs from the declared one is refused', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const refusedWith = (change) =>
      refusal(
        open('/vase.glb', {
          decodeDraco: async (draco) => {
            const mesh = await decodeDraco(draco);
            return { ...mesh, ...change(mesh) };
          },
        }),
      );
    return {
      fewer: await refusedWith(({ triangles }) => ({ triangles: triangles.slice(3) })),
      turned: await refusedWith(({ triangles }) => ({ triangles: turn(triangles) })),
      parted: await refusedWith(({ triangles }) => ({
        triangles: triangles.map((v, i) => (i < 3 ? triangles[i + 3] : v)),
      })),
      large: await refusal(open('/vase.glb', { maxFaces: 1000 })),
      damaged: await refusal(open('/vase.glb', { decodeDraco: () => decodeDraco(new Uint8Array(40)) })),
    };
    function turn(triangles) {
      const [a, b, c, ...rest] = triangles;
      return new Uint32Array([a, c, b, ...rest]);
    }
  });
  assert.equal(seen.fewer.code, 'mesh_not_gltf');
  assert.match(seen.fewer.message, /other counts/);
  for (const one of [seen.turned, seen.parted]) {
    assert.equal(one.code, 'mesh_unusable');
    assert.match(one.message, /not a manifold surface/);
  }
  assert.equal(seen.large.code, 'result_too_large');
  assert.equal(seen.damaged.code, 'mesh_not_draco');
  await page.close();
});

test('PapilioLoader shows a packed model with all its levels', async () => {
  const { page } = await open();
  const faces = await page.evaluate(async () => {
    const model = await new PapilioLoader().loadAsync('/vase.glb');
    return model.statistics.faces;
  });
  assert.equal(faces, report.levels.at(-1).faces);
  await page.close();
});

test('PapilioLoader shows a textured model with its material, and refines it', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const model = await new PapilioLoader().loadAsync('/textured.glb');
    let mesh;
    model.traverse((object) => (mesh = object.isMesh ? object : mesh));
    const { geometry, material } = mesh;
    const [uv, normal, position] = ['uv', 'normal', 'position'].map((name) => geometry.attributes[name]);
    const { image } = material.map;
    const shown = {
      faces: model.statistics.faces,
      counts: [uv.count === position.count, normal.count === position.count],
      image: [image.width, image.height],
      isFlat: material.flatShading,
      digest: await digest({ positions: position.array, triangles: geometry.index.array }),
      texcoords: Array.from(uv.array, (value, i) => Math.fround(i % 2 === 0 ? value : 1 - value)),
    };
    const renderer = new THREE.WebGLRenderer();
    renderer.setSize(256, 256);
    const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
    camera.position.set(0, 0, 5);
    renderer.render(new THREE.Scene().add(model), camera);
    await model.settled();
    return { ...shown, refined: model.statistics.faces, hasUv: mesh.geometry.hasAttribute('uv') };
  });
  const { positions, triangles, texcoords, normals } = unpack(textured.packed, 10, '--normals', true);
  const digest = (...arrays) =>
    arrays.reduce((hash, { buffer }) => hash.update(new Uint8Array(buffer)), createHash('sha256')).digest('hex');
  assert.equal(seen.faces, textured.report.levels.at(-1).faces);
  assert.deepEqual(seen.counts, [true, true]);
  assert.deepEqual(seen.image, [32, 32]);
  assert.equal(seen.isFlat, false);
  assert.equal(seen.digest, digest(positions, triangles));
  assert.equal(normals.length, positions.length);
  assert.deepEqual(Float32Array.from(seen.texcoords), texcoords);
  assert.ok(seen.hasUv && seen.refined >= seen.faces, `${seen.refined}`);
  await page.close();
});

/// The corners of all faces of a packed model's scene, mesh by mesh, and how many each has, before and after it is refined.
async function loaded(page, url) {
  return page.evaluate(async (url) => {
    const model = await new PapilioLoader().loadAsync(url);
    const meshes = [];
    model.traverse((object) => object.isMesh && meshes.push(object));
    const cornersOf = (name) =>
      meshes.flatMap(({ geometry }) => {
        const { array, itemSize } = geometry.attributes[name];
        return Array.from(geometry.index.array).flatMap((v) =>
          Array.from(array.subarray(v * itemSize, (v + 1) * itemSize)),
        );
      });
    const { color } = meshes[0].geometry.attributes;
    const shown = {
      positions: cornersOf('position'),
      points: meshes.map(({ geometry }) => geometry.attributes.position.count),
      colours: color ? cornersOf('color') : null,
      format: color ? [color.array.constructor.name, color.itemSize, color.normalized] : null,
      materials: meshes.map(({ material }) => [material.name, material.vertexColors]),
      corners: meshes.map(({ geometry }) => geometry.index.count),
    };
    const renderer = new THREE.WebGLRenderer();
    renderer.setSize(256, 256);
    const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
    camera.position.set(1, 1, 7);
    renderer.render(new THREE.Scene().add(model), camera);
    await model.settled();
    const refined = model.statistics.faces;
    return { ...shown, refined, hasColours: meshes.every(({ geometry }) => geometry.hasAttribute('color')) };
  }, url);
}

/// The values at the corners of faces.
const atCorners = (values, triangles) => Array.from(triangles).flatMap((v) => [...values.subarray(3 * v, 3 * v + 3)]);

test('PapilioLoader shows a model of two materials with both, and refines it', async () => {
  const { page } = await open();
  const seen = await loaded(page, '/parted.glb');
  const { positions, triangles } = unpack(parted.packed, 10);
  assert.deepEqual(seen.positions, atCorners(positions, triangles));
  assert.deepEqual(new Set(seen.materials.map(([name]) => name)), new Set(materialNames));
  const { base, levels } = readPacked(new Uint8Array(readFileSync(parted.packed)));
  assert.deepEqual(
    seen.corners,
    base.primitives.map(({ faces }) => 3 * faces * 4 ** levels.length),
  );
  // Each has its own points alone.
  for (const points of seen.points) assert.ok(points < positions.length / 3);
  assert.ok(seen.refined >= triangles.length / 3, `${seen.refined}`);
  await page.close();
});

test('PapilioLoader shows a model with colours, and refines it', async () => {
  const { page } = await open();
  const seen = await loaded(page, '/coloured.glb');
  const { positions, triangles, colours } = unpack(coloured.packed, 10);
  assert.deepEqual(seen.positions, atCorners(positions, triangles));
  assert.deepEqual(seen.colours, atCorners(colours, triangles));
  assert.deepEqual(seen.format, ['Uint8Array', 3, true]);
  assert.deepEqual(seen.materials, [['', true]]);
  assert.ok(seen.hasColours && seen.refined >= triangles.length / 3, `${seen.refined}`);
  await page.close();
});
