// Draco in the browser: three.js's decoder in workers, and draco3d's encoder, fetched when a mesh of another format is
// opened.

import encoderWasmUrl from 'draco3d/draco_encoder.wasm?url';
import encoderUrl from 'draco3d/draco_encoder_nodejs.js?url';
import { type Box3, type BufferGeometry, Vector3 } from 'three';
import { DRACOLoader } from 'three/examples/jsm/loaders/DRACOLoader.js';

import type { Bytes, Decoded } from './model';
import { Problem } from './service';

let loader = new DRACOLoader();

/// Fetches the decoder in parallel with other files. Rejects with a Problem if it is not available.
export async function fetchDecoder(): Promise<DRACOLoader> {
  const fetching = loader;
  try {
    // Awaits the decoder's own promise: if it fails, all later decoding fails too.
    await (fetching.preload() as DRACOLoader & { decoderPending: Promise<void> }).decoderPending;
  } catch {
    if (loader === fetching) loader = new DRACOLoader(); // for the next attempt
    throw new Problem('unreachable', 'The server cannot be reached: the Draco decoder did not come.', {
      retryAfter: 2,
    });
  }
  return fetching;
}

/// Decodes a mesh: positions and, if present, normals. Rejects with a Problem if the bytes are not a mesh.
export async function decodeDraco(draco: Bytes): Promise<Decoded> {
  const decoder = await fetchDecoder();
  const geometry = await new Promise<BufferGeometry>((resolve, reject) => {
    const refuse = () => reject(new Problem('mesh_not_draco', 'This is no Draco mesh, or it is damaged.'));
    decoder.parse(draco.slice().buffer, resolve, refuse); // the copy is transferred to the worker
  });
  if (geometry.index === null || geometry.index.count === 0 || !geometry.hasAttribute('position'))
    throw new Problem('mesh_unsupported', 'There are no triangles in this file, only points.');
  for (const name of Object.keys(geometry.attributes))
    if (name !== 'position' && name !== 'normal') geometry.deleteAttribute(name);
  return {
    geometry,
    scene: null,
    vertices: geometry.getAttribute('position').count,
    faces: geometry.index.count / 3,
    missing: [],
    dispose: () => geometry.dispose(),
  };
}

// Part of draco3d's encoder that is called.
interface Encoder {
  SetSpeedOptions(encoding: number, decoding: number): void;
  SetEncodingMethod(method: number): void;
  SetAttributeQuantization(attribute: number, bits: number): void;
  SetAttributeExplicitQuantization(
    type: number,
    bits: number,
    components: number,
    origin: number[],
    range: number,
  ): void;
  EncodeMeshToDracoBuffer(mesh: unknown, out: DracoBytes): number;
}
interface DracoBytes {
  GetValue(at: number): number;
}
interface EncoderModule {
  Encoder: new () => Encoder;
  MeshBuilder: new () => {
    AddFacesToMesh(mesh: unknown, count: number, faces: Uint32Array): void;
    AddFloatAttributeToMesh(mesh: unknown, type: number, count: number, components: number, values: Float32Array): void;
    AddUInt8Attribute(mesh: unknown, type: number, count: number, components: number, values: Uint8Array): void;
  };
  Mesh: new () => unknown;
  DracoInt8Array: new () => DracoBytes;
  POSITION: number;
  TEX_COORD: number;
  COLOR: number;
  NORMAL: number;
  MESH_EDGEBREAKER_ENCODING: number;
  MESH_SEQUENTIAL_ENCODING: number;
  destroy(object: unknown): void;
}
declare global {
  var DracoEncoderModule: undefined | ((options: { locateFile: () => string }) => Promise<EncoderModule>);
}

let encoderModule: Promise<EncoderModule> | undefined;

async function loadEncoder(): Promise<EncoderModule> {
  await new Promise<void>((resolve, reject) => {
    const script = document.createElement('script');
    script.src = encoderUrl;
    script.onload = () => resolve();
    script.onerror = () =>
      reject(new Problem('unreachable', 'The encoder for other formats cannot be fetched.', { retryAfter: 2 }));
    document.head.append(script);
  });
  return globalThis.DracoEncoderModule!({ locateFile: () => encoderWasmUrl });
}

/// Surface to encode: positions [vertices * 3], triangles [faces * 3 vertices]; optional texture coordinates [vertices
/// * 2], colours and normals [vertices * 3].
export interface Surface {
  positions: Float32Array;
  triangles: Uint32Array;
  texcoords?: Float32Array;
  colours?: Uint8Array;
  normals?: Float32Array;
}

/// Encodes a Draco mesh with positions on a grid of 16 bits. Its attributes have the unique ids 0, 1, 2 in the
/// surface's order. `box`: box of the grid; default: box of the positions. Adjoining surfaces need one grid.
export async function encode(surface: Surface, box?: Box3): Promise<Bytes> {
  const { positions, triangles, texcoords, colours, normals } = surface;
  encoderModule ??= loadEncoder();
  encoderModule.catch(() => (encoderModule = undefined)); // the next attempt fetches it again
  const module = await encoderModule;
  const builder = new module.MeshBuilder();
  const mesh = new module.Mesh();
  const encoder = new module.Encoder();
  const out = new module.DracoInt8Array();
  try {
    builder.AddFacesToMesh(mesh, triangles.length / 3, triangles);
    const vertices = positions.length / 3;
    const add = (type: number, components: number, values: Float32Array, bits: number) => {
      builder.AddFloatAttributeToMesh(mesh, type, vertices, components, values);
      encoder.SetAttributeQuantization(type, bits);
    };
    add(module.POSITION, 3, positions, 16);
    const range = Math.max(...(box?.getSize(new Vector3()).toArray() ?? []));
    if (box) encoder.SetAttributeExplicitQuantization(module.POSITION, 16, 3, box.min.toArray(), range);
    if (texcoords) add(module.TEX_COORD, 2, texcoords, 14);
    if (colours) builder.AddUInt8Attribute(mesh, module.COLOR, vertices, 3, colours);
    if (normals) add(module.NORMAL, 3, normals, 10);
    encoder.SetSpeedOptions(5, 5);
    let length = 0;
    for (const method of [module.MESH_EDGEBREAKER_ENCODING, module.MESH_SEQUENTIAL_ENCODING]) {
      encoder.SetEncodingMethod(method);
      length = encoder.EncodeMeshToDracoBuffer(mesh, out);
      if (length > 0) break;
    }
    if (length === 0)
      throw new Problem('mesh_unusable', 'This mesh cannot be encoded: all its triangles are degenerate.');
    const bytes = new Uint8Array(length);
    for (let i = 0; i < length; ++i) bytes[i] = out.GetValue(i);
    return bytes;
  } finally {
    for (const object of [out, encoder, mesh, builder]) module.destroy(object);
  }
}
