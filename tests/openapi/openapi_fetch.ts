// openapi_fetch.js SERVER IN OUT: refines a mesh through a client made by openapi-typescript and openapi-fetch.
import { readFile, writeFile } from 'node:fs/promises';
import createClient from 'openapi-fetch';
import type { paths } from './generated/papilio.js';

const [server, input, output] = process.argv.slice(2) as [string, string, string];

// The generator types bytes as string, and openapi-fetch writes every body as JSON unless `bodySerializer` is given.
const client = createClient<paths>({ baseUrl: server, bodySerializer: (body) => body });
const { data, error } = await client.POST('/v1/refine', {
  params: { query: { levels: 2, flatness: [0.8, 0.9], 'view.eye': [0, 0, 3] } },
  headers: { 'Content-Type': 'application/x-draco' },
  body: (await readFile(input)) as unknown as string,
  parseAs: 'arrayBuffer',
});
if (data === undefined) throw new Error(error.detail);
await writeFile(output, new Uint8Array(data));
