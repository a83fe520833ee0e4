// What is shown: a mesh as Draco, a glTF scene, or a packed model; its bytes, and what they are decoded to.

import type { BufferGeometry, Object3D } from 'three';

export type Bytes = Uint8Array<ArrayBuffer>;

/// A file as the server takes and gives it; a packed model is refined as the mesh that it is decoded to.
export interface Encoded {
  kind: 'draco' | 'scene' | 'packed';
  bytes: Bytes;
}

export const mediaTypes = {
  draco: 'application/x-draco',
  scene: 'model/gltf-binary',
  packed: 'model/gltf-binary',
} as const;
export const extensionOf = { draco: '.drc', scene: '.glb', packed: '.glb' } as const;

/// Null for other types.
export function kindOf(mediaType: string | null): Encoded['kind'] | null {
  if (mediaType === mediaTypes.draco) return 'draco';
  return mediaType === mediaTypes.scene ? 'scene' : null;
}

/// What a file is decoded to.
export interface Decoded {
  /// All triangles as one indexed mesh, where they are in the scene.
  readonly geometry: BufferGeometry;
  /// The scene with its materials; null for a mesh.
  scene: Object3D | null;
  /// Each mesh counted once, however often it is shown.
  vertices: number;
  faces: number;
  /// Files that the scene names, and that are not in it.
  missing: string[];
  /// Frees what it holds on the graphics card.
  dispose(): void;
}
