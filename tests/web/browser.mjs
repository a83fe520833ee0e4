// A real server and a real browser for the tests of the viewer: Debian's Chromium, driven by playwright-core, WebGL in
// software.

import { execFile, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, afterEach, before } from 'node:test';
import { promisify } from 'node:util';

export const root = new URL('../..', import.meta.url).pathname;
const { chromium } = createRequire(join(root, 'client/web/package.json'))('playwright-core');

export const build = process.env.PAPILIO_BUILD ?? join(root, 'build/release');
export const meshes = process.env.PAPILIO_MESHES ?? join(root, 'build/deps/meshes');
export const axeSource = createRequire(join(root, 'client/web/package.json')).resolve('axe-core');

/// Longest wait for anything, in milliseconds: the machines are slow at times, and slower under sanitizers.
export const patience = Number(process.env.PAPILIO_PATIENCE ?? 60_000);

const running = new Set();

/// Starts papilio-server, on a free port unless the arguments name one. `stop` ends it as an operator would.
export async function startServer(...args) {
  if (!args.includes('--port')) args.push('--port', '0');
  const server = spawn(join(build, 'papilio-server'), args, { stdio: ['ignore', 'pipe', 'pipe'] });
  running.add(server);
  let log = '';
  server.stderr.on('data', (text) => (log += text));
  const exited = once(server, 'exit');
  const first = await Promise.race([once(createInterface(server.stdout), 'line'), exited.then(() => null)]);
  if (first === null) throw new Error(`the server did not start: ${log}`);
  return {
    url: `${first[0].replace('listening on ', '')}/`,
    /// Signals are for what a test does to it.
    process: server,
    log: () => log,
    stop: async () => {
      server.kill('SIGTERM');
      const [status] = await exited;
      running.delete(server);
      if (status !== 0) throw new Error(`the server ended with ${status}: ${log.slice(-4000)}`);
    },
  };
}

/// Without `smooth`, edges of triangles are not smoothed (multisampled), and ambient light is filtered from few samples:
/// both take most of what drawing in software does.
export async function launch({ smooth = false } = {}) {
  const program = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
  const args = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  if (!smooth) args.push('--webgl-antialiasing-mode=none');
  if (process.getuid() === 0) args.push('--no-sandbox'); // which root cannot have
  const browser = await chromium.launch({ executablePath: program, args });
  if (smooth) return browser;
  const newContext = browser.newContext.bind(browser);
  browser.newContext = async (options) => {
    const context = await newContext(options);
    await context.addInitScript(filterFewSamples);
    return context;
  };
  return browser;
}

/// Runs in pages: three.js's filters of environments take 2 and 4 samples of each point in place of 20 and 256.
function filterFewSamples() {
  const { shaderSource } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.shaderSource = function (shader, source) {
    const few = source.replace('#define SAMPLES 20', '#define SAMPLES 2');
    shaderSource.call(this, shader, few.replace('#define GGX_SAMPLES 256u', '#define GGX_SAMPLES 4u'));
  };
}

/// One of each for all tests of a file, from before the first to after the last.
export function serverAndBrowser() {
  const shared = { server: null, browser: null };
  before(async () => {
    [shared.server, shared.browser] = await Promise.all([startServer(), launch()]);
  });
  after(async () => {
    await shared.browser.close();
    await shared.server.stop();
    for (const left of running) left.kill('SIGKILL'); // by tests that failed
  });
  afterEach(() => Promise.all(shared.browser.contexts().map((context) => context.close())));
  return shared;
}

/// The hash of a page that shows the mug four ways, all of them by the server.
export const fourWays =
  'mesh=mug&show=coarse,uniform,adaptive,view&look=wireframe&levels=3&tolerance=0.001&view.error_pixels=0.5&view.edge_pixels=0';

/// A page of its own on this server, with all its settings open, and all that goes wrong in it: `faults` lists errors in the console, exceptions
/// and requests to other hosts; what a refusal of the server leaves in the console only where `countRefusals`.
export async function openPage(browser, url, { hash = fourWays, countRefusals = true, ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width: 1000, height: 700 },
    ...options,
  });
  context.setDefaultTimeout(patience);
  const page = await context.newPage();
  const faults = [];
  page.on('console', (message) => {
    const isRefusal = message.text().startsWith('Failed to load resource');
    if (message.type() === 'error' && (countRefusals || !isRefusal)) faults.push(message.text());
  });
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('request', (request) => {
    const at = new URL(request.url());
    if (at.protocol !== 'blob:' && at.protocol !== 'data:' && at.host !== new URL(url).host) faults.push(request.url());
  });
  await page.goto(url + (hash && !url.includes('#') ? `#${hash}` : ''));
  await page.evaluate(() => (document.getElementById('advanced').open = true));
  return { page, faults, context };
}

/// Resolves once these panels have all that they asked for.
export async function done(page, modes = ['coarse', 'uniform', 'adaptive', 'view']) {
  for (const mode of modes) await page.locator(`.panel[data-mode=${mode}][data-state=done]`).waitFor();
}

export const facesOf = async (page, mode) =>
  Number(await page.locator(`.panel[data-mode=${mode}]`).getAttribute('data-faces'));

/// The requests for refinements from now on.
export function refinements(page) {
  const made = [];
  page.on('request', (request) => {
    if (/\/refined\?|\/v1\/refine\?/.test(request.url())) made.push(new URL(request.url()));
  });
  return made;
}

/// What is drawn in a panel below its caption, as PNG.
export async function picture(page, mode) {
  // Two frames, so that what was asked for is drawn.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const box = await page.locator(`.panel[data-mode=${mode}]`).boundingBox();
  return page.screenshot({
    clip: {
      x: box.x + 2,
      y: box.y + 60,
      width: box.width - 4,
      height: box.height - 100,
    },
  });
}

/// Shares of the pixels: `drawn` are not the ground's colour, `red` are red, `orange` are as three.js draws frustums.
export function redShare(page, picture) {
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    const count = (test) => {
      let found = 0;
      for (let i = 0; i < data.length; i += 4) if (test(data[i], data[i + 1], data[i + 2])) ++found;
      return (4 * found) / data.length;
    };
    return {
      drawn: count((r, g, b) => [r - data[0], g - data[1], b - data[2]].some((d) => Math.abs(d) > 16)),
      red: count((r, g, b) => r > 2 * g + 16 && r > 2 * b + 16),
      orange: count((r, g, b) => r > 160 && b < 90 && g > 60 && g < 0.85 * r),
    };
  }, picture.toString('base64'));
}

/// Of a picture's pixels that are not the ground's colour: `mean` and `spread` of their lightness, 0 to 255, the share
/// `steps` of them whose lightness differs by 6 or more from the one to the right, and `drawn`, their share of all.
export function shades(page, picture) {
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    const isDrawn = (i) => [0, 1, 2].some((k) => Math.abs(data[i + k] - data[k]) > 16);
    const lightness = (i) => (data[i] + data[i + 1] + data[i + 2]) / 3;
    let [count, sum, squares, steps] = [0, 0, 0, 0];
    for (let i = 0; i + 7 < data.length; i += 4) {
      if (!isDrawn(i) || !isDrawn(i + 4)) continue;
      ++count;
      sum += lightness(i);
      squares += lightness(i) ** 2;
      if (Math.abs(lightness(i) - lightness(i + 4)) >= 6) ++steps;
    }
    const mean = sum / count;
    const spread = Math.sqrt(squares / count - mean * mean);
    return { mean, spread, steps: steps / count, drawn: (4 * count) / data.length };
  }, picture.toString('base64'));
}

/// The tasks of the page's main thread in a trace of `toplevel`, in milliseconds by the clock, and of the processor in
/// that thread, ascending.
export function tasksOf(trace) {
  const { traceEvents } = JSON.parse(trace);
  const main = traceEvents.filter(({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain');
  const ids = new Set(main.map(({ pid, tid }) => `${pid} ${tid}`));
  const tasks = traceEvents.filter(
    ({ name, pid, tid, dur }) => name === 'ThreadControllerImpl::RunTask' && dur && ids.has(`${pid} ${tid}`),
  );
  const sorted = (of) => tasks.map((task) => of(task) / 1000).sort((a, b) => a - b);
  return { clock: sorted(({ dur }) => dur), processor: sorted(({ tdur }) => tdur ?? 0) };
}

/// Shares of the pixels: `drawn` of the first that are not the ground's colour, `differing` between the two.
export function compare(page, first, second) {
  return page.evaluate(
    async (pictures) => {
      const [a, b] = await Promise.all(
        pictures.map(async (text) => {
          const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
          const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
          const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
          canvas.drawImage(bitmap, 0, 0);
          return canvas.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }),
      );
      const differ = (x, i, y, j) => [0, 1, 2].some((k) => Math.abs(x[i + k] - y[j + k]) > 16);
      let drawn = 0;
      let differing = 0;
      for (let i = 0; i < a.length; i += 4) {
        if (differ(a, i, a, 0)) ++drawn;
        if (i >= b.length || differ(a, i, b, i)) ++differing;
      }
      return {
        drawn: (4 * drawn) / a.length,
        differing: (4 * differing) / a.length,
      };
    },
    [first.toString('base64'), second.toString('base64')],
  );
}

/// Drags the mesh by so many pixels.
export async function drag(page, right, down) {
  const box = await page.locator('#panels').boundingBox();
  const [x, y] = [box.x + box.width / 4, box.y + box.height / 4];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 5; ++step) await page.mouse.move(x + (right * step) / 5, y + (down * step) / 5);
  await page.mouse.up();
}

/// Drops a file on the page, as from the desktop.
export const drop = (page, name, bytes) => dropAll(page, [[name, bytes]]);

/// Drops files together; each is a name and bytes.
export async function dropAll(page, files) {
  await dropCarried(page, await carry(page, files));
}

/// Files in the page, ready for dropCarried; each is a name and bytes.
export const carry = (page, files) =>
  page.evaluateHandle(
    (dropped) => {
      const data = new DataTransfer();
      for (const [name, text] of dropped)
        data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
      return data;
    },
    files.map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]),
  );

export async function dropCarried(page, transfer) {
  await page.dispatchEvent('#stage', 'dragover', { dataTransfer: transfer });
  await page.dispatchEvent('#stage', 'drop', { dataTransfer: transfer });
}

/// Runs a command line in a new folder, with these variables besides; resolves with the bytes of the file that it wrote.
export async function run(command, file, variables = {}) {
  const folder = mkdtempSync(join(tmpdir(), 'papilio-web-'));
  try {
    const options = {
      cwd: folder,
      env: { ...process.env, no_proxy: '*', ...variables },
      timeout: patience,
    };
    await promisify(execFile)('bash', ['-c', command], options);
    return readFileSync(join(folder, file));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/// What `papilio compare` says of two Draco meshes.
export async function surfaceDistances(first, second) {
  const folder = mkdtempSync(join(tmpdir(), 'papilio-web-'));
  try {
    const files = [first, second].map((bytes, i) => {
      writeFileSync(join(folder, `${i}.drc`), bytes);
      return join(folder, `${i}.drc`);
    });
    const { stdout } = await promisify(execFile)(join(build, 'papilio'), ['compare', '--json', ...files]);
    return JSON.parse(stdout);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
