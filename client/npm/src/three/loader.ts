// Loader of models that refine themselves.

import {
  type BufferGeometry,
  FileLoader,
  Loader,
  type LoadingManager,
  LoaderUtils,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
} from 'three';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { type GLTF, GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

import { Client, type Encoded, Problem } from '../client.js';
import { isPacked } from '../detail/packed_file.js';
import { openPacked } from '../detail/packed_model.js';
import type { Parameters } from '../parameters.js';
import { Refiner } from '../refiner.js';
import { computedNormals } from './arrays.js';
import { dracoDecoder, geometryOf, sceneNormals, showLevel } from './packed.js';
import { RefinedModel } from './refined_model.js';

export interface PapilioLoaderOptions {
  /// Workers to refine in; default: workers shared by all loaders.
  refiner?: Refiner;
  /// Server that refines instead, or its address; only for .glb and .drc files.
  server?: Client | string;
  /// Parameters of the refinement; default `{ view: { error_pixels: 1 } }`.
  parameters?: Parameters;
  manager?: LoadingManager;
}

type Loaded = Pick<GLTF, 'animations'> & { scene: Object3D };

let shared: Promise<Refiner> | null = null;

/// Returns the workers of this page, started with the first model.
function sharedRefiner(): Promise<Refiner> {
  shared ??= Refiner.start({ workers: Math.min(4, Math.max(1, (navigator.hardwareConcurrency ?? 2) - 1)) });
  shared.catch(() => (shared = null)); // the next model retries
  return shared;
}

/// Loader of `.glb`, `.gltf` and `.drc` files, and of packed models with all their levels:
/// `scene.add(await new PapilioLoader().loadAsync('model.glb'))`.
export class PapilioLoader extends Loader<RefinedModel> {
  readonly #options: PapilioLoaderOptions;
  readonly #draco: DRACOLoader;
  readonly #gltf: GLTFLoader;

  constructor(options: PapilioLoaderOptions = {}) {
    super(options.manager);
    this.#options = options;
    this.#draco = new DRACOLoader(this.manager);
    this.#gltf = new GLTFLoader(this.manager).setDRACOLoader(this.#draco).setMeshoptDecoder(MeshoptDecoder);
  }

  /// GLTFLoader in use, for settings without an option here: KTX2 textures, plugins.
  get gltfLoader(): GLTFLoader {
    return this.#gltf;
  }

  /// DRACOLoader in use, for another path of its decoder.
  get dracoLoader(): DRACOLoader {
    return this.#draco;
  }

  override load(
    url: string,
    onLoad: (model: RefinedModel) => void,
    onProgress?: (event: ProgressEvent) => void,
    onError: (error: unknown) => void = (error) => console.error(error),
  ): void {
    const files = new FileLoader(this.manager)
      .setPath(this.path)
      .setResponseType('arraybuffer')
      .setRequestHeader(this.requestHeader)
      .setWithCredentials(this.withCredentials);
    const folder = this.resourcePath || LoaderUtils.extractUrlBase(LoaderUtils.resolveURL(url, this.path));
    const take = (file: string | ArrayBuffer) =>
      void this.parseAsync(file as ArrayBuffer, folder).then(onLoad, onError);
    files.load(url, take, onProgress, onError);
  }

  /// Parses a file. `folder`: folder of the files that a .gltf refers to.
  async parseAsync(file: ArrayBuffer, folder = ''): Promise<RefinedModel> {
    const { server, parameters } = this.#options;
    const encoded = encodedOf(file);
    const { scene, animations } = await this.#decode(file, encoded?.type, folder);
    let model: RefinedModel;
    if (server === undefined) {
      model = new RefinedModel(scene, { refiner: this.#options.refiner ?? (await sharedRefiner()) }, parameters);
    } else {
      if (encoded === null) throw new Problem('unsupported', 'A server takes .glb and .drc files alone.');
      const client = typeof server === 'string' ? new Client({ base: server }) : server;
      const decode = async (of: Encoded) => (await this.#decode(of.bytes.buffer, of.type, folder)).scene;
      model = new RefinedModel(scene, { client, encoded, decode }, parameters);
    }
    model.animations = animations;
    return model;
  }

  async #decode(file: ArrayBuffer, type: string | undefined, folder: string): Promise<Loaded> {
    if (type === 'model/gltf-binary' && isPacked(new Uint8Array(file))) return this.#decodePacked(file, folder);
    if (type !== 'application/x-draco') return this.#gltf.parseAsync(file, folder);
    const geometry = await new Promise<BufferGeometry>((resolve, reject) =>
      // The bytes are transferred to the decoder's worker.
      this.#draco.parse(file.slice(0), resolve, () =>
        reject(new Problem('mesh_not_draco', 'This Draco mesh is damaged.')),
      ),
    );
    return meshOf(geometry);
  }

  /// Returns the surface with all its levels, with the file's material if it has one.
  async #decodePacked(file: ArrayBuffer, folder: string): Promise<Loaded> {
    const model = await openPacked(new Uint8Array(file), { decodeDraco: dracoDecoder(this.#draco) });
    try {
      if (!model.hasMaterial) return meshOf(geometryOf(await model.decode(model.levels.length)));
      const [loaded, surface] = await Promise.all([
        this.#gltf.parseAsync(file, folder),
        model.decode(model.levels.length, { normals: sceneNormals(model) }),
      ]);
      showLevel(loaded.scene, geometryOf(surface));
      return loaded;
    } finally {
      model.close();
    }
  }
}

function meshOf(geometry: BufferGeometry): Loaded {
  if (!geometry.hasAttribute('normal')) {
    geometry.computeVertexNormals();
    geometry.userData[computedNormals] = true;
  }
  const material = new MeshStandardMaterial({ color: 0xb9c6d2, roughness: 0.6 });
  if (geometry.hasAttribute('color')) material.setValues({ color: 0xffffff, vertexColors: true });
  return { scene: new Mesh(geometry, material), animations: [] };
}

/// Returns the server's type of a file; null for a .gltf file.
function encodedOf(file: ArrayBuffer): Encoded | null {
  const magic = new TextDecoder().decode(new Uint8Array(file, 0, Math.min(5, file.byteLength)));
  const bytes = new Uint8Array(file);
  if (magic === 'DRACO') return { type: 'application/x-draco', bytes };
  if (magic.startsWith('glTF')) return { type: 'model/gltf-binary', bytes };
  return null;
}
