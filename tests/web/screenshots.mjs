// screenshots.mjs FOLDER SAMPLES SCENE: the README's pictures of the viewer, as PNG.

import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { done, drag, drop, launch, openPage, startServer } from './browser.mjs';

const [folder, samples, scene] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const [server, browser] = await Promise.all([startServer('--samples', samples), launch()]);

/// Once nothing changes any more.
async function save(page, name) {
  await page.waitForTimeout(1000);
  await page.screenshot({ path: join(folder, `${name}.png`) });
  console.log(join(folder, `${name}.png`));
}

const screen = { viewport: { width: 1280, height: 800 } };
try {
  // The same mesh four ways.
  const wide = 'levels=3&tolerance=0.001&view.error_pixels=0.5&view.edge_pixels=0';
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
} finally {
  await browser.close();
  await server.stop();
}
