// hey_api.js SERVER IN OUT: refines a mesh through a client made by @hey-api/openapi-ts.
import { readFile, writeFile } from 'node:fs/promises';
import { client } from './generated/papilio/client.gen.js';
import { refine } from './generated/papilio/sdk.gen.js';

const [server, input, output] = process.argv.slice(2) as [string, string, string];

client.setConfig({ baseUrl: server });
const { data } = await refine({
  query: { levels: 2, flatness: [0.8, 0.9], 'view.eye': [0, 0, 3] },
  body: new Blob([new Uint8Array(await readFile(input))]),
  throwOnError: true,
});
await writeFile(output, new Uint8Array(await data.arrayBuffer()));
