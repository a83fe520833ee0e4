import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

import { defineConfig, type Plugin } from 'vite';

// Drops Draco's decoders in JavaScript and for glTF only: the page uses the WebAssembly decoder.
function withoutUnusedDecoders(): Plugin {
  return {
    name: 'without-unused-decoders',
    generateBundle(_, bundle) {
      for (const [name, file] of Object.entries(bundle)) {
        const from = file.type === 'asset' ? file.originalFileNames.join() : '';
        if (/draco\/(gltf\/|draco_decoder\.js)/.test(from)) delete bundle[name];
      }
    },
  };
}

// A .gz beside each file that becomes smaller by it.
function gzipped(): Plugin {
  return {
    name: 'gzipped',
    enforce: 'post',
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        for (const [name, file] of Object.entries(bundle)) {
          const source = Buffer.from(file.type === 'chunk' ? file.code : file.source);
          const small = gzipSync(source, { level: 9 });
          if (small.length < 0.9 * source.length)
            this.emitFile({ type: 'asset', fileName: `${name}.gz`, source: small });
        }
      },
    },
  };
}

// The npm package, as ./dev builds it.
const built = process.env.PAPILIO_PACKAGE ?? fileURLToPath(new URL('../../build/npm', import.meta.url));

export default defineConfig({
  resolve: {
    alias: [{ find: /^papilio\/(client|detail|files|three|wasm)$/, replacement: `${built}/dist/$1.js` }],
    dedupe: ['three'], // the package has none of its own
  },
  base: './', // behind a proxy the page may be anywhere
  build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1000, emptyOutDir: true },
  plugins: [withoutUnusedDecoders(), gzipped()],
  worker: { format: 'es' },
});
