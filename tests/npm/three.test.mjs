// papilio/three in headless Chromium: models that refine themselves to the camera, here and by the real server.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { launch, meshes, startServer } from '../web/browser.mjs';
import { cubeGlb } from '../web/mesh_files.mjs';
import { page as pageOf, startFiles } from './files.mjs';

const html = pageOf(`<script type="module">
  import * as THREE from 'three';
  import { Parts, PapilioLoader, RefinedModel, viewOf } from 'papilio/three';
  import { Refiner } from 'papilio/wasm';
  Object.assign(window, { THREE, Parts, PapilioLoader, RefinedModel, Refiner, viewOf });
  window.renderer = new THREE.WebGLRenderer();
  renderer.setPixelRatio(1);
  renderer.setSize(400, 300);
  window.scene = new THREE.Scene();
  scene.add(new THREE.AmbientLight());
  window.camera = new THREE.PerspectiveCamera(45, 4 / 3, 0.01, 1000);
  /** Looks at the object from this many of its radii away, draws it, and waits for what it is refined to. */
  window.look = async (model, radii, away = new THREE.Vector3(0.3, 0.2, 1)) => {
    const { center, radius } = new THREE.Box3().setFromObject(model).getBoundingSphere(new THREE.Sphere());
    window.frame ??= { center, radius };
    camera.position.copy(frame.center).addScaledVector(away.clone().normalize(), radii * frame.radius);
    camera.lookAt(frame.center);
    renderer.render(scene, camera);
    await model.settled();
    renderer.render(scene, camera);
    return model.statistics;
  };
  window.load = async (url, options = {}) => {
    const model = await new PapilioLoader(options).loadAsync(url);
    scene.add(model);
    return model;
  };
  /** A scene with a mesh of its own, whose workers are not shared. */
  window.modelOf = async (object, parameters) => {
    const model = new RefinedModel(object, { refiner: await Refiner.start() }, parameters);
    scene.add(model);
    return model;
  };
  window.firstMesh = (model) => {
    let found = null;
    model.traverse((object) => (found ??= object.isMesh ? object : null));
    return found;
  };
  document.documentElement.dataset.state = 'ready';
</script>`);

let server;
let files;
let browser;
before(async () => {
  [server, browser] = await Promise.all([startServer('--cors-origins', '*'), launch()]);
  files = await startFiles({
    '/page.html': html,
    '/cube.glb': cubeGlb(),
    '/red.glb': cubeGlb({ isTextured: true }),
    '/bunny.drc': readFileSync(path.join(meshes, 'bunny600.drc')),
  });
});
after(async () => {
  await browser.close();
  files.stop();
  await server.stop();
});
afterEach(() => Promise.all(browser.contexts().map((context) => context.close())));

async function open() {
  const page = await (await browser.newContext()).newPage();
  page.setDefaultTimeout(60_000);
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.goto(`${files.url}/page.html`);
  await page.waitForSelector('html[data-state=ready]', { state: 'attached' });
  return { page, faults };
}

test('a model refines itself to the camera, in the browser', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const model = await load('/bunny.drc');
    const before = model.statistics;
    const far = await look(model, 40);
    const near = await look(model, 3);
    const close = await look(model, 1.2);
    const again = await look(model, 40);
    return { before, far, near, close, again, errors: [far, near, close].map((one) => one.errorPixels) };
  });
  assert.equal(seen.before.faces, 600);
  const { before, far, near, close } = seen;
  assert.ok(before.faces <= far.faces && far.faces < near.faces && near.faces < close.faces / 2, JSON.stringify(seen));
  assert.equal(seen.again.faces, seen.far.faces);
  for (const error of seen.errors) assert.ok(error <= 1, JSON.stringify(seen));
  assert.deepEqual(faults, []);
});

test('a vertex has the same position in every view', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const model = await load('/bunny.drc', { parameters: { levels: 4, view: { error_pixels: 0.5 } } });
    const { attributes, index } = firstMesh(model).geometry;
    const placesIn = (array) =>
      Array.from({ length: array.length / 3 }, (_, v) => array.slice(3 * v, 3 * v + 3).join());
    const coarse = placesIn(attributes.position.array);
    const refiner = await Refiner.start();
    const opened = refiner.open({
      positions: attributes.position.array.slice(),
      triangles: Uint32Array.from(index.array),
    });
    const { mesh: uniform } = await refiner.refine(opened, { levels: 4 });
    const views = [];
    for (const away of [
      [0, 0, 1],
      [1, 0.4, 0.2],
      [-1, 0, -1],
      [0, 1, 0.1],
    ]) {
      await look(model, 2.5, new THREE.Vector3(...away));
      views.push(placesIn(firstMesh(model).geometry.attributes.position.array));
    }
    const all = new Set(placesIn(uniform.positions));
    return {
      counts: views.map((view) => view.length),
      strangers: views.map((view) => view.filter((place) => !all.has(place)).length),
      lost: views.map((view) => coarse.filter((place) => !view.includes(place)).length),
    };
  });
  assert.deepEqual(seen.strangers, [0, 0, 0, 0]);
  assert.deepEqual(seen.lost, [0, 0, 0, 0]);
  assert.equal(new Set(seen.counts).size, 4);
});

test('a server refines to the same faces, and the nodes are kept', async () => {
  const { page, faults } = await open();
  const asked = [];
  page.on('request', (request) => request.url().includes('error_pixels') && asked.push(request.url()));
  for (const file of ['/bunny.drc', '/red.glb']) {
    const seen = await page.evaluate(
      async ([url, base]) => {
        window.frame = undefined;
        scene.clear();
        const parameters = { shape: 'organic', view: { error_pixels: 0.25 } };
        const [here, there] = [await load(url, { parameters }), await load(url, { parameters, server: base })];
        scene.remove(there);
        const own = await look(here, 3);
        scene.clear();
        scene.add(there);
        const [mesh, material] = [firstMesh(there), firstMesh(there).material];
        const theirs = await look(there, 3);
        return {
          own,
          theirs,
          isSame: firstMesh(there) === mesh,
          hasMap: mesh.material.map !== null,
          isTextured: material.map !== null,
        };
      },
      [file, server.url],
    );
    assert.equal(seen.theirs.faces, seen.own.faces);
    // A picture cannot wait for the surfaces to be compared.
    assert.ok(asked.length > 0 && asked.every((url) => url.includes('view.verify=false')), asked.join('\n'));
    assert.ok(seen.own.faces > 12 && seen.isSame, JSON.stringify(seen));
    assert.equal(seen.hasMap, file === '/red.glb');
    assert.equal(seen.isTextured, seen.hasMap);
  }
  assert.deepEqual(faults, []);
});

test('position, rotation and scale of a model do not affect its refinement', async () => {
  const { page } = await open();
  const faces = await page.evaluate(async () => {
    const counts = [];
    for (const [place, turn, scale] of [
      [[0, 0, 0], 0, 1],
      [[5, -3, 2], 1.1, 20],
      [[-90, 0, 4], 2.5, 0.05],
    ]) {
      scene.clear();
      const model = await load('/bunny.drc');
      const pivot = new THREE.Group();
      scene.add(pivot);
      pivot.add(model);
      const { center, radius } = new THREE.Box3().setFromObject(model).getBoundingSphere(new THREE.Sphere());
      pivot.position.set(...place);
      pivot.rotation.set(0, turn, 0);
      pivot.scale.setScalar(scale);
      pivot.updateMatrixWorld(true);
      const at = (point) => pivot.localToWorld(point.clone());
      camera.position.copy(at(center.clone().add(new THREE.Vector3(1, 0.5, 2).setLength(3 * radius))));
      camera.up.set(0, 1, 0);
      camera.near = 0.01 * radius * scale;
      camera.far = 100 * radius * scale;
      camera.lookAt(at(center));
      camera.updateProjectionMatrix();
      renderer.render(scene, camera);
      await model.settled();
      counts.push(model.statistics.faces);
    }
    return counts;
  });
  // Rounding may decide otherwise for an edge or two.
  for (const count of faces) assert.ok(Math.abs(count / faces[0] - 1) < 0.01 && count > 700, `${faces}`);
});

test('texture coordinates, colours and morph targets are refined with the surface', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const geometry = new THREE.IcosahedronGeometry(1, 1); // a point for each corner
    const { count } = geometry.attributes.position;
    const values = (of) =>
      Float32Array.from({ length: 3 * count }, (_, i) => of(geometry.attributes.position.array[i]));
    geometry.setAttribute(
      'color',
      new THREE.BufferAttribute(
        values((x) => (x + 1) / 2),
        3,
      ),
    );
    geometry.morphAttributes.position = [
      new THREE.BufferAttribute(
        values((x) => x),
        3,
      ),
    ];
    geometry.morphTargetsRelative = true;
    const material = new THREE.MeshStandardMaterial({ vertexColors: true });
    const model = await modelOf(new THREE.Mesh(geometry, material), { view: { error_pixels: 0.2 } });
    const { faces } = await look(model, 3);
    const { attributes, morphAttributes } = firstMesh(model).geometry;
    let [most, moved] = [0, 0];
    for (let v = 0; v < attributes.position.count; ++v) {
      const [x, colour, shift] = [attributes.position, attributes.color, morphAttributes.position[0]].map((a) =>
        a.getX(v),
      );
      most = Math.max(most, Math.abs(colour - (x + 1) / 2));
      moved = Math.max(moved, Math.abs(shift - x));
    }
    return { faces, most, moved, names: Object.keys(attributes).sort() };
  });
  assert.ok(seen.faces > 200, `${seen.faces}`);
  assert.deepEqual(seen.names, ['color', 'normal', 'position', 'uv']);
  assert.ok(seen.most < 0.1, 'colours are interpolated along the chord');
  assert.ok(seen.moved < 1e-5, 'the target, twice as large, is refined as the surface is');
  assert.deepEqual(faults, []);
});

test('instances are refined once, skinned meshes are kept, and both are drawn', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const ball = () => new THREE.IcosahedronGeometry(1, 1);
    const instances = new THREE.InstancedMesh(ball(), new THREE.MeshStandardMaterial(), 2);
    instances.setMatrixAt(1, new THREE.Matrix4().makeTranslation(3, 0, 0));
    const boned = ball();
    boned.setAttribute('skinIndex', new THREE.BufferAttribute(new Uint16Array(4 * boned.attributes.position.count), 4));
    boned.setAttribute(
      'skinWeight',
      new THREE.BufferAttribute(new Float32Array(4 * boned.attributes.position.count).fill(0.25), 4),
    );
    const skinned = new THREE.SkinnedMesh(boned, new THREE.MeshStandardMaterial());
    const bone = new THREE.Bone();
    skinned.add(bone);
    skinned.bind(new THREE.Skeleton([bone]));
    const model = await modelOf(new THREE.Group().add(instances, skinned));
    const asked = [];
    model.addEventListener('refined', () => asked.push(instances.geometry.index.count));
    await look(model, 6);
    await look(model, 3);
    return {
      asked: asked.length,
      kept: model.unrefined.map((mesh) => mesh.type),
      corners: instances.geometry.index.count,
    };
  });
  assert.equal(seen.asked, 1);
  assert.deepEqual(seen.kept, ['SkinnedMesh']);
  assert.ok(seen.corners > 3 * 80 * 4, `${seen.corners}`);
  assert.deepEqual(faults, []);
});

test('a frozen model is constant, one camera counts, and a disposed model does nothing', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const model = await load('/cube.glb', { parameters: { shape: 'organic', view: { error_pixels: 0.5 } } });
    const near = await look(model, 3);
    model.isFrozen = true;
    const frozen = await look(model, 30);
    model.isFrozen = false;
    model.camera = new THREE.PerspectiveCamera();
    const other = await look(model, 30);
    model.camera = camera;
    const far = await look(model, 30);
    model.dispose();
    const gone = await look(model, 3);
    return [near, frozen, other, far, gone].map(({ faces }) => faces);
  });
  const [near, frozen, other, far, gone] = seen;
  assert.deepEqual([frozen, other, gone], [near, near, far]);
  assert.ok(far < near, `${seen}`);
  assert.deepEqual(faults, []);
});

test('failures are reported, and the model is unchanged', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const missing = await new PapilioLoader().loadAsync('/nothing.glb').catch((error) => String(error));
    const model = await load('/bunny.drc', { server: 'http://127.0.0.1:9/' });
    const told = [];
    model.addEventListener('failed', ({ error }) => told.push(error.code));
    const { faces } = await look(model, 3);
    await look(model, 2);
    scene.clear();
    const wrong = await load('/cube.glb', { parameters: { levels: 99 } });
    wrong.addEventListener('failed', ({ error }) => told.push(error.parameter));
    await look(wrong, 3);
    return { missing, told, faces };
  });
  assert.match(seen.missing, /nothing\.glb|404/);
  assert.deepEqual([seen.told, seen.faces], [['unreachable', 'unreachable', 'levels'], 600]);
  assert.deepEqual(faults, []);
});

test('an orthographic view gives the result of the service', async () => {
  const { page } = await open();
  const seen = await page.evaluate(async () => {
    const object = new THREE.Group();
    object.updateMatrixWorld(true);
    const flat = new THREE.OrthographicCamera(-4, 4, 3, -3, 0.5, 100);
    flat.position.set(0, 0, 7);
    flat.updateMatrixWorld(true);
    const solid = new THREE.PerspectiveCamera(30, 4 / 3, 0.5, 100);
    solid.position.set(0, 0, 7);
    solid.updateMatrixWorld(true);
    return [viewOf(object, flat, [400, 300]), viewOf(object, solid, [400, 300])];
  });
  const [flat, solid] = seen;
  assert.equal(flat.projection, 'orthographic');
  // As high as the service has it: by the angle, at the target.
  const high = Math.abs(flat.target[2] - flat.eye[2]) * Math.tan((flat.fov_y * Math.PI) / 360);
  assert.ok(Math.abs(high - 3) < 1e-5, JSON.stringify(flat));
  assert.deepEqual(
    [solid.eye, solid.fov_y, solid.near, solid.viewport, Math.sign(solid.target[2] - 7), solid.projection],
    [[0, 0, 7], 30, 0.5, [400, 300], -1, undefined],
  );
});

test('adjacent parts stay closed: a mesh with two materials is refined as one', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const ball = new THREE.IcosahedronGeometry(1, 1).deleteAttribute('uv');
    const half = (isUpper, more) => {
      const { array } = ball.attributes.position;
      const [positions, normals] = [[], []];
      for (let f = 0; f < array.length; f += 9) {
        if (array[f + 1] + array[f + 4] + array[f + 7] > 0 !== isUpper) continue;
        positions.push(...array.slice(f, f + 9));
        normals.push(...ball.attributes.normal.array.slice(f, f + 9));
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
      geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normals, 3));
      if (more)
        geometry.setAttribute(
          'uv',
          new THREE.Float32BufferAttribute(new Array((2 * positions.length) / 3).fill(0.5), 2),
        );
      return new THREE.Mesh(geometry, new THREE.MeshStandardMaterial());
    };
    const parts = new THREE.Group().add(half(true, true), half(false, false));
    const [halves, whole] = [
      await modelOf(parts, { view: { error_pixels: 0.2 } }),
      await modelOf(new THREE.Mesh(ball, new THREE.MeshStandardMaterial()), { view: { error_pixels: 0.2 } }),
    ];
    const a = await look(halves, 3);
    const b = await look(whole, 3);
    const names = parts.children.map(({ geometry }) => Object.keys(geometry.attributes).sort().join());
    // Each edge of the two together has two faces.
    const edges = new Map();
    for (const { geometry } of parts.children) {
      const { array } = geometry.attributes.position;
      const at = (i) => array.slice(3 * i, 3 * i + 3).join();
      const index = geometry.index.array;
      for (let i = 0; i < index.length; ++i) {
        const key = [at(index[i]), at(index[i % 3 === 2 ? i - 2 : i + 1])].sort().join(' ');
        edges.set(key, (edges.get(key) ?? 0) + 1);
      }
    }
    return { faces: [a.faces, b.faces], names, open: [...edges.values()].filter((count) => count !== 2).length };
  });
  assert.equal(seen.faces[0], seen.faces[1]);
  assert.deepEqual(seen.names, ['normal,position,uv', 'normal,position']);
  assert.equal(seen.open, 0);
  assert.deepEqual(faults, []);
});

test('smoothing groups mark creases, in two geometries as in one', async () => {
  const { page, faults } = await open();
  const seen = await page.evaluate(async () => {
    const corners = [1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 0.5];
    const sides = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
    const base = [2, 1, 0, 3, 2, 0];
    const geometryOf = (indices, groups) => {
      const geometry = new THREE.BufferGeometry();
      const positions = indices.flatMap((i) => corners.slice(3 * i, 3 * i + 3));
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
      if (groups) geometry.setAttribute('_smoothing_group', new THREE.Float32BufferAttribute(groups, 1));
      return geometry;
    };
    const refiner = await Refiner.start();
    /** Returns the different positions of the result. */
    const placesOf = async (...geometries) => {
      const root = new THREE.Group().add(...geometries.map((one) => new THREE.Mesh(one)));
      const parts = new Parts(root, refiner);
      const places = new Set();
      for (const part of parts.all)
        for (const { attributes } of (await parts.refine(part, 'levels=2&shape=organic', {})).geometries)
          for (let i = 0; i < attributes.position.count; ++i)
            places.add(attributes.position.array.slice(3 * i, 3 * i + 3).join());
      return [...places].sort();
    };
    const [one, zero] = [Array(12).fill(1), Array(6).fill(0)];
    return [
      await placesOf(geometryOf([...sides, ...base], [...one, ...zero])),
      await placesOf(geometryOf([...sides, ...base])),
      await placesOf(geometryOf(sides), geometryOf(base, zero)),
    ];
  });
  assert.equal(seen[0].length, 50);
  assert.deepEqual(seen[2], seen[0]);
  assert.notDeepEqual(seen[1], seen[0]);
  assert.deepEqual(faults, []);
});
