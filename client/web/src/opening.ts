// Opening of a file as a mesh.

import { measureBoundsInTasks } from './bounds';
import { decode } from './decode';
import { OpenMesh } from './mesh';
import type { Encoded } from './model';

/// Opens a mesh. Rejects with a Problem if the bytes are damaged. The first scene fetches the decoder of packed models.
export async function openMesh(name: string, encoded: Encoded): Promise<OpenMesh> {
  if (encoded.kind === 'scene') {
    const { isPacked, openPackedMesh } = await import('./packed');
    if (isPacked(encoded.bytes)) return openPackedMesh(name, encoded.bytes);
  }
  const decoded = await decode(encoded);
  if (decoded.scene === null) await measureBoundsInTasks(decoded.geometry);
  return new OpenMesh(name, encoded, decoded);
}
