// A proxy in front of a real server that holds answers back until the test lets them go.

import { once } from 'node:events';
import { createServer, request } from 'node:http';

/// `holdAfter(url)`: how many bytes of this answer go through at once; the rest waits for `release`. Infinity: all.
export async function startProxy(target, holdAfter) {
  let release;
  const released = new Promise((resolve) => (release = resolve));
  const proxy = createServer((incoming, outgoing) => {
    const { hostname, port } = new URL(target);
    const upstream = request(
      {
        hostname,
        port,
        path: incoming.url,
        method: incoming.method,
        headers: incoming.headers,
      },
      async (answer) => {
        let left = holdAfter(incoming.url);
        if (left === 0) await released;
        outgoing.writeHead(answer.statusCode, answer.headers);
        for await (const chunk of answer) {
          const now = chunk.subarray(0, left);
          left -= now.length;
          if (now.length > 0) outgoing.write(now);
          if (now.length === chunk.length) continue;
          await released;
          left = Infinity;
          outgoing.write(chunk.subarray(now.length));
        }
        outgoing.end();
      },
    );
    upstream.on('error', () => outgoing.destroy());
    outgoing.on('close', () => upstream.destroy());
    incoming.pipe(upstream);
  });
  proxy.listen(0, '127.0.0.1');
  await once(proxy, 'listening');
  return {
    url: `http://127.0.0.1:${proxy.address().port}/`,
    release,
    stop: () => {
      proxy.closeAllConnections();
      proxy.close();
    },
  };
}
