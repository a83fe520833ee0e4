// Binary glTF container: its check and its writer.

import type { Bytes } from './model';
import { Problem } from './service';

const [magic, jsonChunk, binaryChunk] = [0x46546c67, 0x4e4f534a, 0x004e4942];
const [headerBytes, chunkHeaderBytes] = [12, 8];

export const padded = (length: number) => (length + 3) & ~3;

/// Throws a Problem, in the server's words, if the bytes are not a .glb file or not all of it: three's loader would
/// complain about JSON or an array.
export function requireWholeGlb(bytes: Uint8Array): void {
  const words = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const refuse = (what: string) => {
    throw new Problem('mesh_not_gltf', `${what} Provide the whole .glb file, or export it again.`);
  };
  if (bytes.length < 4 || words.getUint32(0, true) !== magic) refuse('The bytes do not begin with glTF.');
  const least = headerBytes + chunkHeaderBytes;
  if (bytes.length < least) refuse(`The .glb file has ${bytes.length} bytes; at least ${least} are required.`);
  const declared = words.getUint32(8, true);
  if (declared !== bytes.length) refuse(`The .glb header declares ${declared} bytes, and there are ${bytes.length}.`);
  for (let at = headerBytes; at < bytes.length; ) {
    if (bytes.length - at < chunkHeaderBytes) refuse(`The .glb file ends inside the header of a chunk, at byte ${at}.`);
    const length = words.getUint32(at, true);
    at += chunkHeaderBytes;
    const left = bytes.length - at;
    if (length > left) refuse(`A chunk at byte ${at} declares ${length} bytes, and ${left} are left.`);
    at += length;
  }
}

/// Returns a .glb file. `chunks`: contents of its buffer, each padded; `binaryLength`: their padded bytes.
export function glbOf(json: Uint8Array, chunks: Bytes[], binaryLength: number): Bytes {
  const jsonLength = padded(json.length);
  const glb = new Uint8Array(28 + jsonLength + binaryLength);
  const words = new DataView(glb.buffer);
  const head = [magic, 2, glb.length, jsonLength, jsonChunk];
  for (const [i, word] of head.entries()) words.setUint32(4 * i, word, true);
  glb.fill(0x20, 20, 20 + jsonLength);
  glb.set(json, 20);
  words.setUint32(20 + jsonLength, binaryLength, true);
  words.setUint32(24 + jsonLength, binaryChunk, true);
  let at = 28 + jsonLength;
  for (const chunk of chunks) {
    glb.set(chunk, at);
    at += padded(chunk.length);
  }
  return glb;
}
