// Real scenes for the tests: hands and controllers from npm, what Debian packs of others.

import { execFileSync } from 'node:child_process';
import path from 'node:path';

const here = new URL('.', import.meta.url).pathname;
export const papilio = path.join(process.env.PAPILIO_BUILD ?? path.join(here, '../../build/release'), 'papilio');
export const models = path.join(here, '../../build/deps/scenes/usr/share/assimp/models/glTF2');
const gltfpack = path.join(here, '../../build/deps/scenes/usr/bin/gltfpack');
const profiles = path.join(here, 'node_modules/@webxr-input-profiles/assets/dist/profiles');

export const hands = ['generic-hand/left.glb', 'generic-hand/right.glb'].map((name) => path.join(profiles, name));
const controllers = [
  'generic-button/none.glb',
  'generic-trigger/none.glb',
  'generic-trigger-squeeze/none.glb',
  'htc-vive/none.glb',
  'htc-vive-focus/none.glb',
  'magicleap-one/none.glb',
  'oculus-go/none.glb',
  'oculus-touch/left.glb',
  'oculus-touch-v2/right.glb',
  'oculus-touch-v3/left.glb',
  'samsung-gearvr/none.glb',
  'valve-index/left.glb',
];
const others = [
  '2CylinderEngine-glTF-Binary/2CylinderEngine.glb',
  'glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf',
  'BoxTextured-glTF-Binary/BoxTextured.glb',
  'BoxTextured-glTF-Embedded/BoxTextured.gltf',
  'glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf',
  'glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf',
  'glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_06.gltf',
  'glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_11.gltf',
  'simple_skin/simple_skin.gltf',
];
/** .obj files, their numbers of materials and images, and what the validator says of their own normals. */
const obj = path.join(models, '../OBJ');
export const objects = [
  [path.join(obj, 'spider.obj'), 4, 4, ['ACCESSOR_VECTOR3_NON_UNIT']],
  [path.join(obj, 'regr01.obj'), 12, 0, []],
  [path.join(obj, 'box_mat_with_spaces.obj'), 1, 0, []],
  [path.join(obj, 'cube_usemtl.obj'), 3, 0, []],
  [path.join(obj, 'empty_mat.obj'), 1, 0, []],
];
export const animated = [
  path.join(models, 'simple_skin/simple_skin.gltf'),
  path.join(models, 'glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf'),
];
export const scenes = [
  ...hands,
  ...controllers.map((name) => path.join(profiles, name)),
  ...others.map((name) => path.join(models, name)),
];

/** Scenes that others compress, and how gltfpack does: quantised, by meshopt in two ways, and as floats. */
export const compressible = ['generic-hand/left.glb', 'oculus-touch-v3/left.glb'].map((name) =>
  path.join(profiles, name),
);
export const packings = [[], ['-c'], ['-cc'], ['-noq']];
export const pack = (input, output, options) =>
  execFileSync(gltfpack, ['-i', input, '-o', output, ...options], { stdio: 'ignore' });

/** Refines a scene by the command line; returns the statistics. */
export function refine(input, output, flags) {
  return JSON.parse(execFileSync(papilio, ['refine', input, '-o', output, '--json', ...flags], { stdio: 'pipe' }));
}

export const nameOf = (file) => `${path.basename(path.dirname(file))}/${path.basename(file)}`;
