// Reader of a multipart/mixed answer as it arrives: yields each part as soon as it is complete.

export interface Part {
  headers: Headers;
  body: Uint8Array<ArrayBuffer>;
}

/// Returns the parameter `boundary` of a Content-Type; null if there is none.
export function boundaryOf(contentType: string): string | null {
  const match = /;\s*boundary=(?:"([^"]+)"|([^;\s]+))/i.exec(contentType);
  return match?.[1] ?? match?.[2] ?? null;
}

/// Yields the parts in their order. Each must have a Content-Length. Throws an Error if the answer ends too soon.
export async function* partsOf(stream: ReadableStream<Uint8Array>, boundary: string): AsyncGenerator<Part> {
  const bytes = new Bytes(stream.getReader());
  const delimiter = `--${boundary}`;
  for (;;) {
    const line = await bytes.line();
    if (line === '') continue;
    if (line === `${delimiter}--`) return bytes.end();
    if (line !== delimiter) throw new Error('The answer is not divided as it says.');
    const headers = new Headers();
    for (let field = await bytes.line(); field !== ''; field = await bytes.line()) {
      const colon = field.indexOf(':');
      headers.append(field.slice(0, colon), field.slice(colon + 1).trim());
    }
    const length = headers.get('Content-Length');
    if (length === null) throw new Error('A part of the answer does not say its length.');
    yield { headers, body: await bytes.take(Number(length)) };
  }
}

/// Buffer of received bytes of a stream that were not consumed.
class Bytes {
  #reader: ReadableStreamDefaultReader<Uint8Array>;
  #chunks: Uint8Array[] = [];
  #held = 0;

  constructor(reader: ReadableStreamDefaultReader<Uint8Array>) {
    this.#reader = reader;
  }

  async take(count: number): Promise<Uint8Array<ArrayBuffer>> {
    while (this.#held < count) await this.#more();
    const out = new Uint8Array(count);
    for (let at = 0; at < count; ) {
      const chunk = this.#chunks[0]!;
      const used = Math.min(chunk.length, count - at);
      out.set(chunk.subarray(0, used), at);
      at += used;
      if (used === chunk.length) this.#chunks.shift();
      else this.#chunks[0] = chunk.subarray(used);
    }
    this.#held -= count;
    return out;
  }

  /// Consumes a line, and returns it without its end.
  async line(): Promise<string> {
    let text = '';
    for (;;) {
      const byte = String.fromCharCode((await this.take(1))[0]!);
      if (byte === '\n') return text.endsWith('\r') ? text.slice(0, -1) : text;
      text += byte;
    }
  }

  /// Reads to the end, so that the connection can be used again.
  async end(): Promise<void> {
    while (!(await this.#reader.read()).done);
  }

  async #more(): Promise<void> {
    const { done, value } = await this.#reader.read();
    if (done) throw new Error('The answer ended too soon.');
    this.#chunks.push(value);
    this.#held += value.length;
  }
}
