// trace.mjs [FACES]: how long the page's main thread is busy at a time while a mesh of about so many faces (300,000) is
// turned and refined here, by the browser's own trace. WebGL is in software here, which the picture's own rate says. Two
// times are told: by the clock, in which other processes have their turns, and of the processor in that thread alone.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { drop, facesOf, launch, meshes, openPage, startServer, tasksOf } from './browser.mjs';

const wanted = Number(process.argv[2] ?? 300_000);
const [server, browser] = await Promise.all([startServer(), launch({ smooth: true })]);
const row = (...cells) =>
  console.log(cells.map((cell, i) => (i ? String(cell).padStart(10) : cell.padEnd(12))).join(''));

try {
  row('look', 'faces', 'refined', 'pictures', 'time of', 'tasks', 'over 16 ms', 'over 50 ms', 'longest');
  for (const look of ['shaded', 'wireframe']) {
    const values = 'view.edge_pixels=0&output.normals=true';
    const { page } = await openPage(browser, server.url, {
      hash: `mesh=knot&show=coarse,view&as=wipe&where=here&look=${look}&view.error_pixels=0.5&${values}`,
    });
    const done = page.locator('.panel[data-mode=view][data-by=here][data-state=done]');
    await done.waitFor();
    await drop(page, 'elephant.obj', readFileSync(join(meshes, 'elephant2000.obj')));
    await page.waitForFunction(() => document.title.startsWith('elephant'));
    await done.waitFor();
    // Finer until there are as many faces.
    for (let pixels = 0.5; (await facesOf(page, 'view')) < wanted && pixels > 1e-4; pixels /= 2) {
      await page.locator('[id="parameter-view.error_pixels"]').fill(String(pixels));
      await page.keyboard.press('Enter');
      await page.waitForTimeout(500);
      await done.waitFor();
    }
    const faces = await facesOf(page, 'view');
    await page.evaluate(() => {
      window.counts = { refined: 0, pictures: 0 };
      const panel = document.querySelector('.panel[data-mode=view]');
      new MutationObserver(() => ++window.counts.refined).observe(panel, { attributeFilter: ['data-faces'] });
      const frame = () => requestAnimationFrame(() => (++window.counts.pictures, frame()));
      frame();
    });
    const box = await page.locator('#stage').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 3];
    await browser.startTracing(page, { categories: ['toplevel'] });
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let step = 1; step <= 40; ++step) {
      await page.mouse.move(x + 2 * step, y + step / 2);
      await page.waitForTimeout(30);
    }
    await page.mouse.up();
    const times = tasksOf(await browser.stopTracing());
    const { refined, pictures } = await page.evaluate(() => window.counts);
    for (const [by, tasks] of Object.entries(times)) {
      const over = (limit) => tasks.filter((task) => task > limit).length;
      row(look, faces, refined, pictures, by, tasks.length, over(16), over(50), `${tasks.at(-1).toFixed(1)} ms`);
    }
    await page.close();
  }
} finally {
  await browser.close();
  await server.stop();
}
