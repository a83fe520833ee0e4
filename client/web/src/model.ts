// Model: a Draco mesh, a glTF scene or a packed model; its bytes and its decoded form.

import type { BufferGeometry, Object3D } from 'three';

export type Bytes = Uint8Array<ArrayBuffer>;

/// File in a format of the server. A packed model is refined as its decoded mesh.
export interface Encoded {
  kind: 'draco' | 'scene' | 'packed';
  bytes: Bytes;
  /// Names of material libraries that the file refers to, of which none was given.
  libraries?: string[];
}

export const mediaTypes = {
  draco: 'application/x-draco',
  scene: 'model/gltf-binary',
  packed: 'model/gltf-binary',
} as const;
export const extensionOf = { draco: '.drc', scene: '.glb', packed: '.glb' } as const;

/// Returns the kind of a media type; null for others.
export function kindOf(mediaType: string | null): Encoded['kind'] | null {
  if (mediaType === mediaTypes.draco) return 'draco';
  return mediaType === mediaTypes.scene ? 'scene' : null;
}

/// Decoded file.
export interface Decoded {
  /// All triangles as one indexed mesh, in the scene's coordinates.
  readonly geometry: BufferGeometry;
  /// Scene with its materials; null for a mesh.
  scene: Object3D | null;
  /// Number of vertices; each mesh counts once, however often it is shown.
  vertices: number;
  /// Number of faces that are drawn: a mesh counts as often as it is shown, without degenerate faces.
  faces: number;
  /// Names of files that the scene refers to and does not contain.
  missing: string[];
  /// Frees the memory on the graphics card.
  dispose(): void;
}
