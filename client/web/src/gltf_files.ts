// Packing of a .gltf file with its buffers and images as one .glb.

import { glbOf, padded } from './glb';
import type { Bytes } from './model';
import { Problem } from './service';

interface Named {
  uri?: string;
  bufferView?: number;
  mimeType?: string;
}
interface Document {
  buffers?: { uri?: string; byteLength: number }[];
  bufferViews?: { buffer: number; byteOffset?: number; byteLength: number }[];
  images?: Named[];
}

const mediaTypes: Record<string, string> = {
  png: 'image/png',
  jpg: 'image/jpeg',
  jpeg: 'image/jpeg',
  webp: 'image/webp',
};

/// Packs a document. `files`: files dropped or picked with it, found by name. Rejects with a Problem if a buffer is
/// missing; a missing image remains a reference.
export async function packGlb(gltf: File, files: readonly File[]): Promise<Bytes> {
  let document: Document;
  try {
    document = JSON.parse(await gltf.text()) as Document;
  } catch {
    throw new Problem('damaged', `${gltf.name} is no glTF: it is not JSON.`);
  }
  const find = async (uri: string): Promise<Bytes | null> => {
    if (uri.startsWith('data:')) return new Uint8Array(await (await fetch(uri)).arrayBuffer());
    const name = decodeURIComponent(uri).split('/').at(-1);
    const file = files.find((one) => one.name === name);
    return file ? new Uint8Array(await file.arrayBuffer()) : null;
  };
  const chunks: Bytes[] = [];
  let length = 0;
  const append = (bytes: Bytes): number => {
    const at = length;
    chunks.push(bytes);
    length += padded(bytes.length);
    return at;
  };
  const views = (document.bufferViews ??= []);
  for (const [b, { uri, byteLength }] of (document.buffers ?? []).entries()) {
    const bytes = uri === undefined ? null : await find(uri);
    if (bytes === null || bytes.length < byteLength)
      throw new Problem('missing_file', `${gltf.name} needs ${uri ?? 'a buffer'}: drop or pick both files together.`);
    const at = append(bytes);
    for (const view of views)
      if (view.buffer === b) Object.assign(view, { buffer: -1, byteOffset: at + (view.byteOffset ?? 0) });
  }
  for (const image of document.images ?? []) {
    const bytes = image.uri === undefined ? null : await find(image.uri);
    if (bytes === null) continue;
    image.mimeType ??= mediaTypes[image.uri!.split('.').at(-1)!.toLowerCase()] ?? 'image/png';
    image.bufferView = views.push({ buffer: -1, byteOffset: append(bytes), byteLength: bytes.length }) - 1;
    delete image.uri;
  }
  for (const view of views) view.buffer = 0;
  document.buffers = [{ byteLength: length }];
  return glbOf(new TextEncoder().encode(JSON.stringify(document)), chunks, length);
}
