// A cube in the formats that the viewer opens, made here: 8 vertices, 12 triangles.

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
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const word = (...values) => Buffer.from(new Uint32Array(values).buffer);
  const all = [word(padded.length, 0x4e4f534a), padded, word(binary.length, 0x004e4942), binary];
  const length = 12 + all.reduce((sum, part) => sum + part.length, 0);
  return Buffer.concat([word(0x46546c67, 2, length), ...all]);
}

/// Two cubes beside each other, called first and second.
export const twoCubesGlb = () =>
  cubeGlb({
    change: (json) => {
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
