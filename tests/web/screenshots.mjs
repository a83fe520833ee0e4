// screenshots.mjs FOLDER SAMPLES SCENE FRAMES: the README's pictures of the viewer, as PNG; in FRAMES those of its recording.

import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { done, drag, drop, launch, openPage, startServer } from './browser.mjs';

const [folder, samples, scene, frames] = process.argv.slice(2);
for (const made of [folder, frames]) mkdirSync(made, { recursive: true });
const [server, browser] = await Promise.all([startServer('--samples', samples), launch({ smooth: true })]);

/// Once nothing changes any more.
async function save(page, name) {
  await page.waitForTimeout(1000);
  await page.screenshot({ path: join(folder, `${name}.png`) });
  console.log(join(folder, `${name}.png`));
}

const screen = { viewport: { width: 1280, height: 800 } };
try {
  // The same mesh four ways.
  const wide = 'view.error_pixels=0.5&output.normals=true';
  const four = await openPage(browser, server.url, {
    ...screen,
    hash: `mesh=bunny&show=coarse,uniform,adaptive,view&look=wireframe&${wide}`,
  });
  await done(four.page);
  await save(four.page, 'side-by-side');

  // Refined for a close view of the head, then looked at from the side, with the frustum: the paper's figure 4(d).
  const close = 'levels=4&view.error_pixels=0.5&view.edge_pixels=0&view.fov_y=30';
  const camera = '-4,8.5,11,-3,7.6,1';
  const frozen = await openPage(browser, server.url, {
    ...screen,
    colorScheme: 'dark',
    hash: `mesh=bunny&show=view&look=wireframe&camera=${camera}&frozen=${camera},905,755&${close}`,
  });
  await done(frozen.page, ['view']);
  await frozen.page.getByRole('button', { name: 'Whole mesh' }).click();
  await drag(frozen.page, -70, 30);
  await save(frozen.page, 'frozen-view');

  // A scene with its materials, coarse and refined.
  const textured = await openPage(browser, server.url, {
    viewport: { width: 1280, height: 500 },
    hash: 'mesh=bunny&show=coarse,adaptive&look=shaded&tolerance=0.0003',
  });
  await drop(textured.page, 'controller.glb', readFileSync(scene));
  await textured.page.waitForFunction(() => document.title.startsWith('controller.glb'));
  await done(textured.page, ['coarse', 'adaptive']);
  await save(textured.page, 'scene');

  // What the page does while it is turned, wiped and zoomed.
  const { page } = await openPage(browser, server.url, {
    viewport: { width: 1180, height: 560 },
    hash: 'mesh=knot&show=coarse,view&as=wipe&look=wireframe&where=here&ground=studio&view.error_pixels=0.5&output.normals=true',
  });
  const made = page.locator('.panel[data-mode=view][data-by=here][data-state=done]');
  await made.waitFor();
  const stage = await page.locator('#stage').boundingBox();
  let count = 0;
  const record = async () => {
    await made.waitFor();
    await page.screenshot({ path: join(frames, `${String(count++).padStart(3, '0')}.png`), clip: stage });
  };
  const [x, y] = [stage.x + stage.width / 2, stage.y + stage.height / 3];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 0; step < 30; ++step) {
    await page.mouse.move(x + 6 * step, y + 2 * step);
    await record();
  }
  await page.mouse.up();
  for (let step = 0; step <= 15; ++step) {
    await page.locator('#wipe').fill(String(500 - 30 * step));
    await record();
  }
  await page.mouse.move(x, y + 40);
  for (let step = 0; step < 14; ++step) {
    await page.mouse.wheel(0, -100);
    await page.waitForTimeout(100);
    await record();
  }
  for (let step = 0; step <= 15; ++step) {
    await page.locator('#wipe').fill(String(50 + 30 * step));
    await record();
  }
} finally {
  await browser.close();
  await server.stop();
}
