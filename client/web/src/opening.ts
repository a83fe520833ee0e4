// A file as a mesh that is open.

import { decode } from './decode';
import { OpenMesh } from './mesh';
import type { Encoded } from './model';

/// Rejects with a Problem where the bytes are damaged. What packed models need is fetched with the first scene.
export async function openMesh(name: string, encoded: Encoded): Promise<OpenMesh> {
  if (encoded.kind === 'scene') {
    const { isPacked, openPackedMesh } = await import('./packed');
    if (isPacked(encoded.bytes)) return openPackedMesh(name, encoded.bytes);
  }
  return new OpenMesh(name, encoded, await decode(encoded));
}
