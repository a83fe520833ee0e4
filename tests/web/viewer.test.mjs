// What the viewer does, in a real browser against the real server.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import {
  compare,
  done,
  drag,
  drop,
  dropAll,
  facesOf,
  fourWays,
  meshes,
  openPage,
  picture,
  redShare,
  refinements,
  run,
  shades,
  surfaceDistances,
  serverAndBrowser,
} from './browser.mjs';
import { cubeGlb, cubeGltf, cubeObj, cubeOff, cubePly, cubeStl, texturedCubePly } from './mesh_files.mjs';
import { startProxy } from './proxy.mjs';

const shared = serverAndBrowser();

/// Nothing is asked for any more: the camera has been at rest for longer than it takes to notice.
const quiet = (page) => page.waitForTimeout(700);

test('the sample is shown in four modes: refined ones are finer, and all are drawn', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const [coarse, uniform, adaptive, view] = await Promise.all(
    ['coarse', 'uniform', 'adaptive', 'view'].map((mode) => facesOf(page, mode)),
  );
  assert.equal(coarse, 344);
  assert.equal(uniform, 344 * 4 ** 3);
  assert.ok(coarse < view && view < adaptive && adaptive < uniform / 2, `${view}, ${adaptive}`);
  // Pixels: something is there, and refinement changes it.
  const pictures = {};
  for (const mode of ['coarse', 'uniform', 'adaptive', 'view']) pictures[mode] = await picture(page, mode);
  for (const mode of ['uniform', 'adaptive', 'view']) {
    const { drawn, differing } = await compare(page, pictures.coarse, pictures[mode]);
    assert.ok(drawn > 0.1 && drawn < 0.9, `${drawn} of the coarse picture`);
    assert.ok(differing > 0.015, `${mode} differs in ${differing}`);
  }
  // The figures are those of the meshes, and the saving is theirs.
  const table = await page.locator('#figures table').innerText();
  const row = (name) =>
    table
      .split('\n')
      .find((line) => line.startsWith(name))
      .split('\t')
      .slice(1);
  assert.deepEqual(
    row('faces').map((text) => Number(text.replace(',', ''))),
    [coarse, uniform, adaptive, view],
  );
  assert.equal(row('fewer faces')[2], `${((1 - adaptive / uniform) * 100).toFixed(1)} %`);
  for (const stage of ['decode ms', 'refine ms', 'encode ms']) assert.match(row(stage)[1], /^[\d.]+$/);
  assert.equal(await page.locator('.bars i').count(), 8);
  assert.deepEqual(faults, []);
});

test('the first picture takes one round trip, and levels are shown on arrival', async () => {
  // Of what the service computes nothing comes but the coarse level of the uniform result.
  const first = 1400;
  const proxy = await startProxy(shared.server.url, (url) => (url.includes('/refined?') ? first : Infinity));
  const late = await startProxy(shared.server.url, (url) => (/^\/v1\/(meshes|refine)/.test(url) ? 0 : Infinity));
  try {
    const waiting = await openPage(shared.browser, late.url);
    await done(waiting.page, ['coarse']); // without an answer to anything but the sample itself
    const { drawn } = await compare(
      waiting.page,
      await picture(waiting.page, 'coarse'),
      await picture(waiting.page, 'view'),
    );
    assert.ok(drawn > 0.1, `${drawn} of the picture`);
    await waiting.context.close();

    const { page, faults } = await openPage(shared.browser, proxy.url, {
      hash: 'mesh=mug&show=uniform&levels=3',
    });
    const panel = page.locator('.panel[data-mode=uniform]');
    await panel.and(page.locator('[data-faces="344"]')).waitFor();
    assert.equal(await panel.getAttribute('data-state'), 'busy');
    proxy.release();
    await done(page, ['uniform']);
    assert.equal(await facesOf(page, 'uniform'), 344 * 64);
    assert.deepEqual(faults, []);
  } finally {
    proxy.stop();
    late.stop();
  }
});

test('the sample and the parameters are fetched in parallel', async () => {
  const page = await shared.browser.newPage();
  const events = [];
  page.on('request', (request) => events.push(`> ${new URL(request.url()).pathname}`));
  page.on('response', (response) => events.push(`< ${new URL(response.url()).pathname}`));
  await page.goto(`${shared.server.url}#${fourWays}`);
  await done(page);
  const firstAnswer = events.findIndex((event) => event.startsWith('< /v1/'));
  const before = events.slice(0, firstAnswer);
  for (const path of ['/v1/info', '/v1/samples/mug']) assert.ok(before.includes(`> ${path}`), `${path}: ${before}`);
  assert.ok(before.some((event) => /> \/assets\/draco_decoder.*wasm/.test(event)));
  await page.close();
});

test('a camera at rest sends exactly one request for the new view', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await quiet(page);
  const made = refinements(page);
  const before = await picture(page, 'view');
  await Promise.all([page.waitForRequest(/refined\?/), drag(page, 120, 10)]);
  await done(page);
  await quiet(page);
  assert.equal(made.length, 1, made.join('\n'));
  assert.ok(made[0].searchParams.has('view.eye'));
  const { differing } = await compare(page, before, await picture(page, 'view'));
  assert.ok(differing > 0.03);
  // By keys: one request for a burst of them, from further away.
  const farFrom = (url) => Math.hypot(...url.searchParams.get('view.eye').split(',').map(Number));
  await page.locator('#stage').focus();
  await page.evaluate(() => {
    for (const [key, shiftKey] of [['ArrowLeft'], ['ArrowUp'], ['ArrowRight', true], ['-'], ['-'], ['-']])
      document.getElementById('stage').dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey }));
  });
  await quiet(page);
  await done(page);
  assert.equal(made.length, 2, made.join('\n'));
  assert.ok(farFrom(made[1]) > 1.2 * farFrom(made[0]));
  // Back to the whole mesh, by key.
  await Promise.all([page.waitForRequest(/refined\?/), page.keyboard.press('Home')]);
  await done(page);
  assert.deepEqual(faults, []);
});

test('a newer view aborts the older request; the last good mesh stays until it arrives', async () => {
  const { page } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await quiet(page);
  const faces = await facesOf(page, 'view');
  const made = refinements(page);
  const failed = [];
  page.on('requestfailed', (request) => failed.push(request));
  shared.server.process.kill('SIGSTOP');
  let older;
  try {
    [older] = await Promise.all([page.waitForRequest(/refined\?/), drag(page, 80, 0)]);
    await quiet(page);
    assert.equal(failed.length, made.length - 1);
    const [newer] = await Promise.all([page.waitForRequest(/refined\?/), drag(page, 80, 40)]);
    assert.notEqual(newer.url(), older.url());
    await page.waitForFunction(() => document.querySelector('.panel[data-mode=view]').dataset.state === 'busy');
    await quiet(page);
    // On a busy machine the camera may come to rest twice: all but the last are aborted.
    assert.deepEqual(
      failed.map((request) => request.url()),
      made.slice(0, -1).map((url) => url.href),
    );
    assert.equal(await facesOf(page, 'view'), faces);
    const { drawn } = await compare(page, await picture(page, 'view'), await picture(page, 'view'));
    assert.ok(drawn > 0.1);
  } finally {
    shared.server.process.kill('SIGCONT');
  }
  await done(page);
  assert.notEqual(await facesOf(page, 'view'), faces);
});

test('a file that is not a mesh is refused with a message, and the open mesh stays', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  for (const [name, bytes, words] of [
    ['notes.txt', 'hello', /notes\.txt is no mesh file/],
    ['broken.drc', 'DRACO but not really', /no Draco mesh, or it is damaged/],
    ['empty.obj', '', /empty\.obj is empty/],
    ['points.obj', 'v 0 0 0\nv 1 0 0\n', /points\.obj: holds no triangles; export the mesh again/],
    ['junk.glb', 'hello, no scene', /junk\.glb cannot be read: The bytes do not begin with glTF/],
    ['broken.glb', 'glTF', /broken\.glb cannot be read: The \.glb file has 4 bytes; at least 20 are required/],
    [
      'cut.glb',
      cubeGlb().subarray(0, 500),
      /cut\.glb cannot be read: The \.glb header declares \d+ bytes, and there are 500\./,
    ],
    ['broken.ply', 'ply\nformat none\n', /broken\.ply: line 2: unknown PLY format/],
    ['word.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n', /word\.obj: line 4: expected the number of a vertex/],
    ['nowhere.obj', 'v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n', /nowhere\.obj/],
  ]) {
    await drop(page, name, bytes);
    await page.locator('#alert-text', { hasText: words }).waitFor();
    await page.getByRole('button', { name: 'Close' }).click();
    assert.ok(await page.locator('#alert').isHidden());
  }
  assert.equal(await facesOf(page, 'coarse'), 344);
  assert.equal(await page.locator('#sample').inputValue(), 'mug');
  // three's loader itself says so in the console when bytes are no Draco mesh.
  assert.deepEqual(
    faults.filter((fault) => !fault.includes('THREE.DRACOLoader: Unexpected geometry type')),
    [],
  );
});

test('files of all formats open, and are sent as Draco, scenes unchanged', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const bunny = readFileSync(join(meshes, 'bunny600.drc'));
  await drop(page, 'bunny.drc', bunny);
  await page.locator('.panel[data-mode=coarse][data-faces="600"]').waitFor();
  await done(page);
  assert.equal(await facesOf(page, 'uniform'), 600 * 64);
  for (const [name, bytes] of [
    ['cube.obj', cubeObj()],
    ['cube.ply', cubePly()],
    ['cube.stl', cubeStl()],
    ['cube.off', cubeOff()],
    ['textured.ply', texturedCubePly()],
    ['cube.GLB', cubeGlb()],
  ]) {
    const [stored] = await Promise.all([
      page.waitForRequest((request) => request.url().endsWith('/v1/meshes')),
      drop(page, name, bytes),
    ]);
    assert.equal(stored.postDataBuffer().subarray(0, 4).toString(), name.endsWith('GLB') ? 'glTF' : 'DRAC');
    await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
    await page.locator('.panel[data-mode=uniform][data-faces="768"][data-state=done]').waitFor();
    await done(page);
    assert.equal(await page.title(), `${name} – Papilio`);
    // Back to something else, so that the next cube is seen to come.
    await page.locator('#sample').selectOption('wheel');
    await page.locator('.panel[data-mode=coarse][data-faces="290"]').waitFor();
    await done(page);
  }
  // By the file picker too.
  await page.locator('#file').setInputFiles({
    name: 'cube.obj',
    mimeType: 'model/obj',
    buffer: Buffer.from(cubeObj()),
  });
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  assert.deepEqual(faults, []);
});

test('a scene is shown with its textures in every panel, and saved as .glb', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url, {
    hash: `${fourWays}&look=shaded`.replace('look=wireframe&', ''),
  });
  await done(page);
  assert.equal(await page.locator('#parameter-split_instances').count(), 0);
  await drop(page, 'red.glb', cubeGlb({ isTextured: true }));
  await page.locator('.panel[data-mode=coarse][data-faces="12"]').waitFor();
  await page.locator('.panel[data-mode=uniform][data-faces="768"]').waitFor();
  await done(page);
  for (const mode of ['coarse', 'uniform', 'adaptive', 'view']) {
    const { red, drawn } = await redShare(page, await picture(page, mode));
    assert.ok(drawn > 0.1 && red > 0.9 * drawn, `${mode}: ${red} of ${drawn} are red`);
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator(`.panel[data-mode=${mode}] button`, { hasText: 'Save' }).click(),
    ]);
    assert.equal(download.suggestedFilename(), `red-${mode}.glb`);
    const saved = readFileSync(await download.path());
    assert.equal(saved.subarray(0, 4).toString(), 'glTF');
    assert.ok(saved.includes('"baseColorTexture"'));
  }
  assert.match(await page.locator('.command[data-mode=view] pre').innerText(), /-o refined\.glb/);
  assert.equal(await page.locator('#parameter-split_instances').count(), 1);
  assert.ok(await page.locator('input[name=look][value=level]').isDisabled());
  // A link to it is opened as a scene.
  const link = page.url();
  const again = await openPage(shared.browser, shared.server.url, { hash: new URL(link).hash.slice(1) });
  await done(again.page);
  const { red, drawn } = await redShare(again.page, await picture(again.page, 'uniform'));
  assert.ok(red > 0.9 * drawn);
  assert.deepEqual([...faults, ...again.faults], []);
});

test('a metal reflects its surroundings', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await page.getByLabel('Shaded').check();
  const shown = async (metallicFactor, roughnessFactor) => {
    const name = `${metallicFactor} ${roughnessFactor}`;
    const change = (json) => {
      json.materials = [{ pbrMetallicRoughness: { metallicFactor, roughnessFactor } }];
      json.meshes[0].primitives[0].material = 0;
    };
    await drop(page, `${name}.glb`, cubeGlb({ change }));
    await page.waitForFunction((title) => document.title.startsWith(title), name);
    await done(page);
    return shades(page, await picture(page, 'uniform'));
  };
  // Without a room round it, it is black but where the lamp is mirrored.
  const metal = await shown(1, 0.1);
  const paint = await shown(0, 0.9);
  assert.ok(metal.drawn > 0.1 && metal.mean > 40 && metal.spread > 10, JSON.stringify([metal, paint]));
  assert.ok(Math.abs(metal.mean - paint.mean) > 5, `${metal.mean}, ${paint.mean}`);
  assert.deepEqual(faults, []);
});

test('a .gltf file opens with its referenced files, or names the missing ones', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const files = cubeGltf();
  await dropAll(page, files.slice(1));
  await page.locator('#alert-text', { hasText: /cube\.gltf needs .*cube%20one\.bin: drop or pick both/ }).waitFor();
  await dropAll(page, files);
  await page.locator('.panel[data-mode=uniform][data-faces="768"]').waitFor();
  await done(page);
  await page.getByLabel('Shaded').check();
  const { red, drawn } = await redShare(page, await picture(page, 'uniform'));
  assert.ok(drawn > 0.1 && red > 0.9 * drawn, `${red} of ${drawn} are red`);
  assert.equal(await page.title(), 'cube.glb – Papilio');
  // A texture of another host is not fetched: the model is shown without it.
  const [binary, [, document]] = files;
  const elsewhere = Buffer.from(document.toString().replace('red.png', 'https://textures.example/red.png'));
  await dropAll(page, [binary, ['elsewhere.gltf', elsewhere]]);
  await page.waitForFunction(() => document.title === 'elsewhere.glb – Papilio');
  await done(page);
  const without = await redShare(page, await picture(page, 'uniform'));
  assert.ok(without.drawn > 0.1 && without.red < 0.1 * without.drawn, JSON.stringify(without));
  for (const [text, words] of [
    ['OFF\n4 1 0\n0 0 0\n', /4 vertices are declared, more than the file can hold/],
    ['OFF\n1 1 0\n0 0 0\n3 0 0 9\n', /line 4: there is no vertex 9/],
  ]) {
    await drop(page, 'broken.off', text);
    await page.locator('#alert-text', { hasText: words }).waitFor();
  }
  assert.deepEqual(faults, []);
});

test('the displayed command returns the bytes on screen', async () => {
  const { page } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await page.locator('[data-mode=view] pre').waitFor();
  for (const mode of ['coarse', 'uniform', 'adaptive', 'view']) {
    const command = await page.locator(`.command[data-mode=${mode}] pre`).innerText();
    assert.match(command, /^curl /);
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator(`.panel[data-mode=${mode}] button`, { hasText: 'Save' }).click(),
    ]);
    const saved = readFileSync(await download.path());
    assert.equal(download.suggestedFilename(), `mug-${mode}.drc`);
    const fetched = await run(command, mode === 'coarse' ? 'coarse.drc' : 'refined.drc');
    assert.ok(saved.equals(fetched), `${mode}: ${saved.length} and ${fetched.length} bytes`);
  }
});

test('an unreached target is reported at the mesh', async () => {
  const hash = (levels) => `mesh=mug&show=adaptive&levels=${levels}&tolerance=0.0001`;
  const { page } = await openPage(shared.browser, shared.server.url, { hash: hash(1) });
  await done(page, ['adaptive']);
  const note = page.locator('.panel[data-mode=adaptive] .note');
  assert.match(
    await note.innerText(),
    /tolerance=0\.0001 is not reached: the remaining error is .* Raise levels above 1/,
  );
  await page.locator('[id="parameter-levels"]').fill('8');
  await page.keyboard.press('Tab');
  await page.waitForFunction(() => document.querySelector('.panel[data-mode=adaptive] .note').textContent === '');
});

test('a frozen view keeps its refinement when the camera moves', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url, {
    hash: 'mesh=mug&show=view&look=wireframe&levels=3&view.error_pixels=0.5&view.edge_pixels=0',
  });
  await done(page, ['view']);
  await quiet(page);
  const made = refinements(page);
  const faces = await facesOf(page, 'view');
  const before = await picture(page, 'view');
  await page.getByLabel(/Freeze the view/).check();
  await drag(page, 300, 60);
  await quiet(page);
  await page.locator('#stage').focus();
  await page.keyboard.press('-');
  await page.keyboard.press('-');
  await quiet(page);
  assert.equal(made.length, 0);
  assert.equal(await facesOf(page, 'view'), faces);
  const { differing } = await compare(page, before, await picture(page, 'view'));
  assert.ok(differing > 0.03, 'it was turned');
  // Of whatever size its panel becomes.
  await page.setViewportSize({ width: 900, height: 600 });
  await quiet(page);
  assert.equal(made.length, 0);
  // The link keeps it.
  const copy = await openPage(shared.browser, page.url());
  await done(copy.page, ['view']);
  assert.equal(await facesOf(copy.page, 'view'), faces);
  assert.ok(await copy.page.getByLabel(/Freeze the view/).isChecked());
  // Then the view from here is asked for, once.
  await Promise.all([page.waitForRequest(/refined\?/), page.getByLabel(/Freeze the view/).uncheck()]);
  await done(page, ['view']);
  await quiet(page);
  assert.equal(made.length, 1);
  assert.deepEqual([...faults, ...copy.faults], []);
});

test('a link restores the whole state', async () => {
  const { page } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await drop(page, 'bunny.drc', readFileSync(join(meshes, 'bunny600.drc')));
  await page.locator('.panel[data-mode=coarse][data-faces="600"]').waitFor();
  await page.getByRole('checkbox', { name: 'Uniform', exact: true }).uncheck();
  await page.getByLabel('By level').check();
  await page.locator('[id="parameter-tolerance"]').fill('0.003');
  await page.keyboard.press('Enter');
  await page.locator('[id="parameter-tension"]').selectOption('off');
  await Promise.all([page.waitForRequest(/view\.eye/), drag(page, -90, 20)]);
  await quiet(page);
  const modes = ['coarse', 'adaptive', 'view'];
  await done(page, modes);
  await page.waitForFunction(() => /mesh=[0-9a-f]{64}/.test(location.hash));
  const state = async (one) => ({
    faces: await Promise.all(modes.map((mode) => facesOf(one, mode))),
    commands: await one.locator('#commands pre').allInnerTexts(),
    hash: new URL(one.url()).hash,
  });
  const copy = await openPage(shared.browser, page.url());
  await done(copy.page, modes);
  await quiet(copy.page);
  await done(copy.page, modes);
  assert.deepEqual(await state(copy.page), await state(page));
  assert.ok(await copy.page.getByLabel('By level').isChecked());
  assert.equal(await copy.page.locator('[id="parameter-tolerance"]').inputValue(), '0.003');
  assert.equal(await copy.page.locator('.panel').count(), 3);
  // And an address changed by hand is followed.
  await copy.page.evaluate(() => (location.hash = 'mesh=wheel&show=coarse&look=shaded'));
  await copy.page.locator('.panel[data-mode=coarse][data-faces="290"]').waitFor();
  assert.equal(await copy.page.locator('.panel').count(), 1);
});

test('colours by level and by distance to uniform have legends with units', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const shaded = await picture(page, 'adaptive');
  await page.getByLabel('By level').check();
  const legend = (mode) => page.locator(`.panel[data-mode=${mode}] .legend`);
  await legend('view').filter({ hasText: 'level' }).waitFor(); // the last to be drawn
  assert.equal(await legend('uniform').locator('.swatch').count(), 4);
  const byLevel = await picture(page, 'adaptive');
  assert.ok((await compare(page, shaded, byLevel)).differing > 0.1);
  await page.getByLabel('By distance to uniform').check();
  await legend('view').filter({ hasText: 'largest here' }).waitFor();
  await legend('uniform').filter({ hasText: 'largest here 0 %' }).waitFor();
  const largest = async (mode) => Number(/largest here ([\d.]+) %/.exec(await legend(mode).innerText())[1]);
  // As `papilio compare` has it for the same meshes, in two digits.
  const commands = page.locator('.command[data-mode=uniform] pre, .command[data-mode=adaptive] pre');
  const [uniform, adaptive] = await Promise.all((await commands.allInnerTexts()).map((one) => run(one, 'refined.drc')));
  const { max_forward, diagonal } = await surfaceDistances(uniform, adaptive);
  const measured = (100 * max_forward) / diagonal;
  assert.ok(Math.abs((await largest('adaptive')) / measured - 1) < 0.06, `${await largest('adaptive')}, ${measured}`);
  assert.ok((await largest('coarse')) > 0.1, await legend('coarse').innerText());
  const byDistance = await picture(page, 'adaptive');
  assert.ok((await compare(page, byLevel, byDistance)).differing > 0.1);
  // Without its panel the uniform result is fetched all the same.
  const alone = await openPage(shared.browser, shared.server.url, {
    hash: 'mesh=mug&show=adaptive&look=distance&levels=2&tolerance=0.004',
  });
  await alone.page.locator('.panel[data-mode=adaptive] .legend', { hasText: 'largest here' }).waitFor();
  assert.deepEqual([...faults, ...alone.faults], []);
});

test('a mesh is enlarged, and restored side by side', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  await page.getByRole('button', { name: 'Show Adaptive alone' }).click();
  assert.equal(await page.locator('.panel').count(), 1);
  assert.ok((await page.locator('.panel').boundingBox()).width > 500);
  assert.ok((await compare(page, await picture(page, 'adaptive'), await picture(page, 'adaptive'))).drawn > 0.1);
  await page.getByRole('button', { name: 'Show all meshes side by side' }).click();
  await done(page);
  assert.equal(await page.locator('.panel').count(), 4);
  assert.ok((await compare(page, await picture(page, 'uniform'), await picture(page, 'uniform'))).drawn > 0.1);
  assert.deepEqual(faults, []);
});

test('every parameter of the server has a control that states its range', async () => {
  const { page, faults } = await openPage(shared.browser, shared.server.url);
  await done(page);
  const info = await (await fetch(`${shared.server.url}v1/info`)).json();
  const ofScenes = ['output.compress', 'split_instances'];
  for (const { name, choices } of info.parameters) {
    const controls = ofScenes.includes(name) ? 0 : 1;
    assert.equal(await page.locator(`[id="parameter-${name}"]`).count(), controls, name);
    if (choices === undefined || controls === 0) continue;
    const label = await page.locator(`label[for="parameter-${name}"]`).innerText();
    assert.ok(!choices.some((choice) => label.startsWith(choice)), `${label}: what is chosen, not a choice`);
  }
  const made = refinements(page);
  // Out of range: said at the control, nothing asked.
  const levels = page.locator('[id="parameter-levels"]');
  for (const [text, words] of [
    ['11', '0 to 10'],
    ['2.5', 'whole'],
  ]) {
    await levels.fill(text);
    await page.keyboard.press('Enter');
    await page.locator('[id="parameter-levels-fault"]', { hasText: words }).waitFor();
  }
  await page.locator('[id="parameter-view.target"]').fill('1,2');
  await page.keyboard.press('Enter');
  await page.locator('[id="parameter-view.target-fault"]', { hasText: '3 numbers' }).waitFor();
  assert.equal(made.length, 0);
  // In range: all that depend on it are asked for anew, and nothing else.
  await levels.fill('2');
  await page.keyboard.press('Enter');
  await page.locator('.panel[data-mode=uniform][data-faces="5504"][data-state=done]').waitFor();
  await done(page);
  assert.equal(made.length, 3);
  await page.locator('[id="parameter-view.error_pixels"]').fill('4');
  await Promise.all([page.waitForRequest(/error_pixels=4/), page.keyboard.press('Enter')]);
  await done(page);
  assert.equal(made.length, 4);
  // Emptied: the default.
  await levels.fill('');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => !location.hash.includes('levels='));
  await done(page);
  // The camera goes where it is told.
  await page.locator('[id="parameter-view.eye"]').fill('0, 5, 40');
  const [request] = await Promise.all([page.waitForRequest(/view\.eye=/), page.keyboard.press('Enter')]);
  assert.equal(new URL(request.url()).searchParams.get('view.eye'), '0,5,40');
  // Orthographic, from another angle of view: drawn otherwise.
  const before = await picture(page, 'coarse');
  await page.locator('[id="parameter-view.fov_y"]').fill('70');
  await page.keyboard.press('Enter');
  const projection = page.locator('[id="parameter-view.projection"]');
  await Promise.all([page.waitForRequest(/orthographic/), projection.selectOption('orthographic')]);
  await done(page);
  assert.ok((await compare(page, before, await picture(page, 'coarse'))).differing > 0.02);
  assert.deepEqual(faults, []);
});

test('keys rotate the mesh about any up axis', async () => {
  const hash = 'mesh=wheel&show=view&levels=1&view.up=0,0,1&camera=60,10,20,0,0,0';
  const { page, faults } = await openPage(shared.browser, shared.server.url, { hash });
  await done(page, ['view']);
  await page.locator('#stage').focus();
  const [request] = await Promise.all([page.waitForRequest(/refined\?/), page.keyboard.press('ArrowRight')]);
  const eye = new URL(request.url()).searchParams.get('view.eye').split(',').map(Number);
  assert.ok(Math.abs(eye[2] - 20) < 1e-3, `${eye}`);
  assert.ok(Math.abs(Math.hypot(...eye) - Math.hypot(60, 10, 20)) < 1e-3, `${eye}`);
  assert.ok(Math.abs(eye[1] - 10) > 1, `${eye}`);
  assert.deepEqual(faults, []);
});
