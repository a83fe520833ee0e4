// A cube in the formats that the viewer opens, made here: 8 vertices, 12 triangles.

import { createRequire } from 'node:module';

const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, (i >> 2) & 1]);
// Counter-clockwise seen from outside.
const quads = [
  [0, 2, 3, 1],
  [4, 5, 7, 6],
  [0, 1, 5, 4],
  [2, 6, 7, 3],
  [0, 4, 6, 2],
  [1, 3, 7, 5],
];
const triangles = quads.flatMap(([a, b, c, d]) => [
  [a, b, c],
  [a, c, d],
]);

const lines = (rows) => rows.map((row) => row.join(' ')).join('\n');

export function cubeObj() {
  return `${lines(corners.map((p) => ['v', ...p]))}\n${lines(quads.map((q) => ['f', ...q.map((i) => i + 1)]))}\n`;
}

export const cubeOff = () => `OFF\n# a cube\n8 6 0\n${lines(corners)}\n${lines(quads.map((q) => [4, ...q]))}\n`;

/// With texture coordinates on its faces, of which no two agree at a corner.
export function texturedCubePly() {
  const head = `ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n`;
  const lists = 'property list uchar int vertex_indices\nproperty list uchar float texcoord\n';
  const rows = triangles.map((t, i) => [3, ...t, 6, ...[0, 0, 1, 0, 0, 1].map((x) => x / (i + 1))]);
  return `${head}element face 12\n${lists}end_header\n${lines(corners)}\n${lines(rows)}\n`;
}

export function cubePly() {
  const head = `ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n`;
  return `${head}element face 12\nproperty list uchar int vertex_indices\nend_header\n${lines(corners)}\n${lines(
    triangles.map((t) => [3, ...t]),
  )}\n`;
}

export function cubeStl() {
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(triangles.length, 80);
  triangles.forEach((triangle, t) =>
    triangle.forEach((corner, k) =>
      corners[corner].forEach((x, axis) => bytes.writeFloatLE(x, 84 + 50 * t + 12 + 12 * k + 4 * axis)),
    ),
  );
  return bytes;
}

/// A PNG of one red pixel.
const redPng = Buffer.from(
  'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC',
  'base64',
);

/// A cube; with a texture, red. `change`: makes something else of it, of the glTF document.
export function cubeGlb({ isTextured = false, change = () => {} } = {}) {
  const positions = Buffer.from(new Float32Array(corners.flat()).buffer);
  const indices = Buffer.from(new Uint16Array(triangles.flat()).buffer);
  const places = Buffer.alloc(2 * 4 * corners.length); // of all corners in the picture
  const joints = Buffer.alloc(4 * corners.length); // all the first
  const weights = Buffer.from(new Float32Array(corners.flatMap(() => [1, 0, 0, 0])).buffer);
  const image = redPng;
  const binary = Buffer.concat([
    positions,
    indices,
    places,
    joints,
    weights,
    image,
    Buffer.alloc((4 - (image.length % 4)) % 4),
  ]);
  let begin = 0;
  const viewOf = ({ length: byteLength }) => {
    const view = { buffer: 0, byteOffset: begin, byteLength };
    begin += byteLength;
    return view;
  };
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, scale: [2, 2, 2] }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    buffers: [{ byteLength: binary.length }],
    bufferViews: [positions, indices, places, joints, weights, image].map(viewOf),
    accessors: [
      {
        bufferView: 0,
        componentType: 5126,
        count: 8,
        type: 'VEC3',
        min: [0, 0, 0],
        max: [1, 1, 1],
      },
      { bufferView: 1, componentType: 5123, count: 36, type: 'SCALAR' },
      { bufferView: 2, componentType: 5126, count: 8, type: 'VEC2' },
      { bufferView: 3, componentType: 5121, count: 8, type: 'VEC4' },
      { bufferView: 4, componentType: 5126, count: 8, type: 'VEC4' },
    ],
  };
  if (isTextured) {
    const primitive = json.meshes[0].primitives[0];
    primitive.attributes.TEXCOORD_0 = 2;
    primitive.material = 0;
    json.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0 } }];
    json.textures = [{ source: 0 }];
    json.images = [{ bufferView: 5, mimeType: 'image/png' }];
  }
  change(json);
  return glbOf(json, binary);
}

/// A .glb file of a document and its binary.
function glbOf(json, binary) {
  const text = Buffer.from(JSON.stringify(json));
  const padded = [
    [text, ' '],
    [binary, '\0'],
  ].map(([bytes, fill]) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, fill)]));
  const word = (...values) => Buffer.from(new Uint32Array(values).buffer);
  const all = padded.flatMap((bytes, i) => [word(bytes.length, i ? 0x004e4942 : 0x4e4f534a), bytes]);
  return Buffer.concat([word(0x46546c67, 2, 12 + all.reduce((sum, part) => sum + part.length, 0)), ...all]);
}

const quantizedCorners = new Int16Array(corners.flatMap((p) => [...p.map((x) => 1000 * x), 0]));
const quantizedIndices = new Uint16Array(triangles.flat());
const quantizedCube = (extensions) => ({
  asset: { version: '2.0' },
  extensionsUsed: extensions,
  extensionsRequired: extensions,
  scene: 0,
  scenes: [{ nodes: [0] }],
  nodes: [{ mesh: 0, scale: [0.001, 0.001, 0.001] }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
  accessors: [
    { bufferView: 0, componentType: 5122, count: 8, type: 'VEC3', min: [0, 0, 0], max: [1000, 1000, 1000] },
    { bufferView: 1, componentType: 5123, count: 36, type: 'SCALAR' },
  ],
});

/// A cube whose positions are 16-bit integers.
export function quantizedCubeGlb() {
  const [positions, indices] = [quantizedCorners, quantizedIndices].map(({ buffer }) => Buffer.from(buffer));
  const json = quantizedCube(['KHR_mesh_quantization']);
  json.buffers = [{ byteLength: positions.length + indices.length }];
  json.bufferViews = [
    { buffer: 0, byteLength: positions.length, byteStride: 8 },
    { buffer: 0, byteOffset: positions.length, byteLength: indices.length },
  ];
  return glbOf(json, Buffer.concat([positions, indices]));
}

/// The quantized cube in meshoptimizer's compression.
export async function compressedCubeGlb() {
  const { resolve } = createRequire(new URL('../../client/web/package.json', import.meta.url));
  const { MeshoptEncoder } = await import(resolve('meshoptimizer'));
  await MeshoptEncoder.ready;
  const bytesOf = ({ buffer }) => new Uint8Array(buffer);
  const arrays = [
    { source: bytesOf(quantizedCorners), count: 8, byteStride: 8, mode: 'ATTRIBUTES' },
    { source: bytesOf(quantizedIndices), count: 36, byteStride: 2, mode: 'TRIANGLES' },
  ];
  const json = quantizedCube(['KHR_mesh_quantization', 'EXT_meshopt_compression']);
  let binary = Buffer.alloc(0);
  let sourceBytes = 0;
  json.bufferViews = arrays.map(({ source, count, byteStride, mode }) => {
    const packed = MeshoptEncoder.encodeGltfBuffer(source, count, byteStride, mode);
    const extension = { buffer: 0, byteOffset: binary.length, byteLength: packed.length, byteStride, count, mode };
    const view = { buffer: 1, byteOffset: sourceBytes, byteLength: source.length };
    if (mode === 'ATTRIBUTES') view.byteStride = byteStride;
    binary = Buffer.concat([binary, packed, Buffer.alloc((4 - (packed.length % 4)) % 4)]);
    sourceBytes += source.length;
    return { ...view, extensions: { EXT_meshopt_compression: extension } };
  });
  const fallback = { EXT_meshopt_compression: { fallback: true } };
  json.buffers = [{ byteLength: binary.length }, { byteLength: sourceBytes, extensions: fallback }];
  return glbOf(json, binary);
}

/// Two cubes beside each other, called first and second. `change`: of the glTF document.
export const twoCubesGlb = (change = () => {}) =>
  cubeGlb({
    change: (json) => {
      change(json);
      json.scenes[0].nodes = [0, 1];
      json.nodes = [
        { name: 'first', mesh: 0 },
        { name: 'second', mesh: 0, translation: [1.5, 0, 0] },
      ];
    },
  });

/// A cube that hangs on a bone.
export const skinnedGlb = () =>
  cubeGlb({
    change: (json) => {
      json.scenes[0].nodes = [0, 1];
      json.nodes = [{ mesh: 0, skin: 0 }, {}];
      json.skins = [{ joints: [1] }];
      Object.assign(json.meshes[0].primitives[0].attributes, { JOINTS_0: 3, WEIGHTS_0: 4 });
    },
  });

/// A textured cube as .gltf, .bin and .png.
export function cubeGltf() {
  const glb = cubeGlb({ isTextured: true });
  const length = glb.readUInt32LE(12);
  const json = JSON.parse(glb.subarray(20, 20 + length).toString());
  const binary = glb.subarray(28 + length);
  const { byteOffset, byteLength } = json.bufferViews[5];
  json.buffers[0].uri = 'data/cube%20one.bin';
  json.images = [{ uri: 'red.png' }];
  return [
    ['cube one.bin', binary],
    ['cube.gltf', Buffer.from(JSON.stringify(json))],
    ['red.png', binary.subarray(byteOffset, byteOffset + byteLength)],
  ];
}
