// Serves pages of these tests, the package, and three.js with the package's modules under their names.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { meshes } from '../web/browser.mjs';
import { build, root } from './requests.mjs';

const types = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.wasm': 'application/wasm',
  '.json': 'application/json',
};
const folders = { npm: 'build/npm', three: 'client/web/node_modules/three', tests: 'tests/npm' };

/// `more`: files besides, by path. Pages below /isolated/ may share memory with their workers. Resolves with the server's
/// address and how to stop it.
export async function startFiles(more = {}) {
  const server = createServer((request, response) => {
    const name = new URL(request.url, 'http://here').pathname.replace(/^\/isolated/, '');
    const [, folder, ...rest] = name.split('/');
    try {
      const bytes = more[name] ?? readFileSync(path.join(root, folders[folder], ...rest));
      response.setHeader('Content-Type', types[path.extname(name)] ?? 'application/octet-stream');
      response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
      if (request.url.startsWith('/isolated')) response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  return { url: `http://127.0.0.1:${server.address().port}`, stop: () => server.close() };
}

/// The coarse bunny, 600 faces, as a scene.
export function bunnyGlb() {
  const folder = mkdtempSync(path.join(tmpdir(), 'papilio-npm-'));
  const file = path.join(folder, 'bunny.glb');
  try {
    execFileSync(path.join(build, 'papilio'), ['convert', path.join(meshes, 'bunny600.drc'), file]);
    return readFileSync(file);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/// A page whose scripts import the package and three.js by name.
export const page = (body = '') => `<!doctype html>
<meta charset="utf-8" />
<title>papilio</title>
<script type="importmap">
  { "imports": {
    "papilio/client": "/npm/dist/client.js", "papilio/wasm": "/npm/dist/wasm.js", "papilio/three": "/npm/dist/three.js",
    "papilio/detail": "/npm/dist/detail.js", "papilio/files": "/npm/dist/files.js",
    "three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"
  } }
</script>
${body}`;
