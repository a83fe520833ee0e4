// Decoding of the server's answers.

import { decodeDraco } from './draco';
import type { Decoded, Encoded } from './model';
import { decodeScene } from './scene';

/// Decodes a mesh or scene. Rejects with a Problem if the bytes are damaged. The first scene fetches the loader of
/// scenes.
export async function decode({ kind, bytes }: Encoded): Promise<Decoded> {
  if (kind === 'draco') return decodeDraco(bytes);
  return decodeScene(bytes);
}
