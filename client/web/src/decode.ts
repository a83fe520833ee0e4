// What the server gives, decoded.

import { decodeDraco } from './draco';
import type { Decoded, Encoded } from './model';
import { decodeScene } from './scene';

/// Rejects with a Problem where the bytes are damaged. The loader of scenes is fetched with the first one.
export async function decode({ kind, bytes }: Encoded): Promise<Decoded> {
  if (kind === 'draco') return decodeDraco(bytes);
  return decodeScene(bytes);
}
