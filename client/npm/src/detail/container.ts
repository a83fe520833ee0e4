// Container of a packed model: a glTF 2.0 binary file with JSON and a binary chunk.

import { Problem } from '../client.js';

/// Unchecked value of the JSON.
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json | undefined };

export interface Container {
  json: Json;
  /// Binary chunk; of a cut file, its available part.
  binary: Uint8Array<ArrayBuffer>;
}

const [glbMagic, jsonChunk, binaryChunk] = [0x46546c67, 0x4e4f534a, 0x004e4942];
const headBytes = 20;

/// Returns whether the bytes start like a .glb file.
export function isGlb(bytes: Uint8Array): boolean {
  return bytes.length >= 4 && viewOf(bytes).getUint32(0, true) === glbMagic;
}

/// Reads a .glb file. `mayBeCut`: whether it may end inside its binary chunk. Throws Problem.
export function readContainer(bytes: Uint8Array<ArrayBuffer>, mayBeCut: boolean): Container {
  if (!isGlb(bytes)) throw damaged('The bytes do not begin with glTF.');
  if (bytes.length < headBytes)
    throw damaged(`The .glb file has ${bytes.length} bytes; at least ${headBytes} are required.`);
  const view = viewOf(bytes);
  const word = (at: number) => view.getUint32(at, true);
  if (word(4) !== 2)
    throw new Problem('mesh_unsupported', `The .glb file has version ${word(4)}; only version 2 is supported.`);
  const length = word(8);
  if (length !== bytes.length && (!mayBeCut || length < bytes.length))
    throw damaged(`The .glb header declares ${length} bytes, and there are ${bytes.length}.`);
  let json: Uint8Array | null = null;
  let binary: Uint8Array<ArrayBuffer> | null = null;
  for (let at = 12, chunk = 0; at < bytes.length; ++chunk) {
    if (bytes.length - at < 8) throw damaged(`The .glb file ends inside the header of a chunk, at byte ${at}.`);
    const [declared, type] = [word(at), word(at + 4)];
    at += 8;
    const left = bytes.length - at;
    const isCut = mayBeCut && type === binaryChunk && declared > left;
    if (declared > left && !isCut)
      throw damaged(`A chunk at byte ${at} declares ${declared} bytes, and ${left} are left.`);
    const content = bytes.subarray(at, at + Math.min(declared, left));
    at += content.length;
    if (chunk === 0 && type !== jsonChunk) throw damaged('The first chunk of the .glb file is not JSON.');
    if (chunk === 0) json = content;
    else if (type === jsonChunk || (type === binaryChunk && chunk !== 1))
      throw damaged('The .glb file has a second JSON chunk, or a BIN chunk that is not the second chunk.');
    else if (type === binaryChunk) binary = content;
  }
  return { json: parse(json!), binary: binary ?? new Uint8Array() };
}

/// Returns the bytes of a .glb file.
export function writeContainer(json: Json, binary: Uint8Array): Uint8Array<ArrayBuffer> {
  const padded = (length: number) => Math.ceil(length / 4) * 4;
  const text = new TextEncoder().encode(JSON.stringify(json));
  const jsonBytes = padded(text.length);
  const file = new Uint8Array(headBytes + jsonBytes + 8 + padded(binary.length));
  const view = viewOf(file);
  const words = [glbMagic, 2, file.length, jsonBytes, jsonChunk];
  for (const [i, word] of words.entries()) view.setUint32(4 * i, word, true);
  file.fill(0x20, headBytes, headBytes + jsonBytes);
  file.set(text, headBytes);
  view.setUint32(headBytes + jsonBytes, padded(binary.length), true);
  view.setUint32(headBytes + jsonBytes + 4, binaryChunk, true);
  file.set(binary, headBytes + jsonBytes + 8);
  return file;
}

function parse(text: Uint8Array): Json {
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(text), (_, value: Json) => {
      if (value === Infinity || value === -Infinity) throw new RangeError(); // such as 1e999
      return value;
    }) as Json;
  } catch {
    throw damaged('The first chunk of the .glb file is not valid JSON.');
  }
}

function damaged(what: string): Problem {
  return new Problem('mesh_not_gltf', `${what} Provide the whole .glb file, or pack the model again.`);
}

function viewOf(bytes: Uint8Array): DataView {
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}
