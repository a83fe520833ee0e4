// Where meshes are drawn: one canvas, one renderer and one camera for all panels, so that they always look the same way.

import {
  AmbientLight,
  Box3,
  type BufferGeometry,
  CameraHelper,
  DirectionalLight,
  type Object3D,
  OrthographicCamera,
  PerspectiveCamera,
  PMREMGenerator,
  Quaternion,
  Scene,
  Sphere,
  Spherical,
  type Texture,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';

import type { Camera, Frozen } from './link';

/// How long the camera must have been still to be at rest, in milliseconds.
const rest = 200;

interface View {
  scene: Scene;
  light: DirectionalLight;
  ambient: AmbientLight;
  content: Object3D | null;
  frustum: CameraHelper | null;
}

/// How the picture is made, apart from where the camera is.
export interface Lens {
  fovY: number; // degrees
  isOrthographic: boolean;
  up: [number, number, number];
}

export class Stage {
  /// The camera has come to rest somewhere else, or the panels have another size.
  onRest: () => void = () => {};
  /// The camera moves.
  onMove: () => void = () => {};
  #renderer: WebGLRenderer;
  /// Light from all sides; made when the first scene comes.
  #room: Texture | null = null;
  #surface: HTMLElement;
  #camera = new PerspectiveCamera(45);
  #controls: OrbitControls;
  #lens: Lens = { fovY: 45, isOrthographic: false, up: [0, 1, 0] };
  #views = new Map<HTMLElement, View>();
  /// Those on screen.
  #panels: HTMLElement[] = [];
  #sphere = new Sphere(new Vector3(), 1);
  /// What the camera is to show the whole of.
  #framed: BufferGeometry | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /// A finger or a button is down: the camera is not at rest, however still.
  #isHeld = false;
  #isDue = false;

  /// `surface` is as large as the canvas; on it the mesh is turned. Throws where the browser has no WebGL.
  constructor(canvas: HTMLCanvasElement, surface: HTMLElement) {
    this.#surface = surface;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#controls = this.#makeControls();
    new ResizeObserver(() => this.#moved()).observe(surface);
  }

  /// The panels on screen: what each shows is drawn where it lies. Others keep what they show.
  setPanels(elements: HTMLElement[]): void {
    this.#panels = elements;
    for (const element of elements) {
      if (this.#views.has(element)) continue;
      const scene = new Scene();
      const light = new DirectionalLight(0xffffff, 2.4);
      const ambient = new AmbientLight(0xffffff, 0.7);
      scene.add(ambient, light, light.target);
      this.#views.set(element, { scene, light, ambient, content: null, frustum: null });
    }
    this.draw();
  }

  /// Draws this in the panel from now on, and frees what was there.
  show(element: HTMLElement, content: Object3D | null): void {
    const view = this.#views.get(element);
    if (view === undefined) return;
    if (view.content) view.scene.remove(view.content);
    dispose(view.content);
    view.content = content;
    if (content) view.scene.add(content);
    // Metals show what is round them.
    const isLit = hasMaterials(content);
    view.scene.environment = isLit ? this.#roomLight() : null;
    view.scene.environmentIntensity = 0.5; // white stays below white
    view.light.intensity = isLit ? 1.5 : 2.4;
    view.ambient.intensity = isLit ? 0 : 0.7;
    this.draw();
  }

  /// Draws the frustum of a camera that is not the one looked through; null: none.
  showFrustum(camera: Frozen | null): void {
    for (const view of this.#views.values()) {
      if (view.frustum) view.scene.remove(view.frustum);
      view.frustum?.dispose();
      view.frustum = null;
      if (camera === null) continue;
      const distance = new Vector3(...camera.eye).distanceTo(new Vector3(...camera.target));
      const aspect = camera.pixels[0] / camera.pixels[1];
      const looking = new PerspectiveCamera(this.#lens.fovY, aspect, distance / 8, distance);
      looking.up.set(...this.#lens.up);
      looking.position.set(...camera.eye);
      looking.lookAt(new Vector3(...camera.target));
      looking.updateMatrixWorld();
      view.frustum = new CameraHelper(looking);
      view.scene.add(view.frustum);
    }
    this.draw();
  }

  setLens(lens: Lens): void {
    const isTurned = lens.up.some((x, i) => x !== this.#lens.up[i]);
    this.#lens = lens;
    if (isTurned) {
      const { eye, target } = this.camera;
      this.#controls.dispose(); // they take the camera's up when they are made
      this.#controls = this.#makeControls();
      this.camera = { eye, target };
    }
    this.draw();
  }

  get camera(): Camera {
    return { eye: this.#camera.position.toArray(), target: this.#controls.target.toArray() };
  }

  set camera({ eye, target }: Camera) {
    this.#camera.position.set(...eye);
    this.#controls.target.set(...target);
    this.#controls.update();
    this.draw();
  }

  /// Pixels of the panel's picture, width and height.
  pixelsOf(element: HTMLElement): [number, number] {
    const bounds = element.getBoundingClientRect();
    return [bounds.width, bounds.height].map((n) => Math.max(1, Math.round(n * devicePixelRatio))) as [number, number];
  }

  /// Looks at this mesh from now on, from where all of it is seen.
  frame(geometry: BufferGeometry): void {
    new Box3().setFromBufferAttribute(geometry.getAttribute('position') as never).getBoundingSphere(this.#sphere);
    this.#sphere.radius = Math.max(this.#sphere.radius, 1e-30);
    this.#framed = geometry;
    this.resetCamera();
  }

  resetCamera(): void {
    const position = this.#framed?.getAttribute('position');
    if (position === undefined) return;
    const aspect = Math.min(...this.#panels.map(aspectOf));
    const high = 0.9 * Math.tan((this.#lens.fovY * Math.PI) / 360); // the caption takes the rest
    const wide = 0.95 * aspect * Math.tan((this.#lens.fovY * Math.PI) / 360);
    const up = new Vector3(...this.#lens.up).normalize();
    const axes = [new Vector3(0, 0, 1), new Vector3(1, 0, 0)];
    const front = axes.find((axis) => Math.abs(axis.dot(up)) < 0.8)!; // with y up, z
    const side = up.clone().cross(front).normalize();
    const towards = side.clone().cross(up).addScaledVector(side, 0.55).normalize().addScaledVector(up, 0.4).normalize();
    const right = up.clone().cross(towards).normalize();
    const above = towards.clone().cross(right);
    const { center } = this.#sphere;
    // From where the last vertex comes into the picture.
    let distance = 0;
    const point = new Vector3();
    for (let v = 0; v < position.count; ++v) {
      point.fromBufferAttribute(position, v).sub(center);
      const across = Math.max(Math.abs(point.dot(above)) / high, Math.abs(point.dot(right)) / wide);
      distance = Math.max(distance, point.dot(towards) + across);
    }
    const eye = towards.multiplyScalar(distance).add(center);
    this.camera = { eye: eye.toArray(), target: center.toArray() };
  }

  /// Turns about the target; angles in radians.
  orbit(right: number, up: number): void {
    // Spherical coordinates are about y.
    const upright = new Quaternion().setFromUnitVectors(this.#camera.up.clone().normalize(), new Vector3(0, 1, 0));
    const arm = this.#camera.position.clone().sub(this.#controls.target).applyQuaternion(upright);
    const at = new Spherical().setFromVector3(arm);
    at.theta += right;
    at.phi -= up;
    arm.setFromSpherical(at.makeSafe()).applyQuaternion(upright.invert());
    this.#camera.position.copy(this.#controls.target).add(arm);
    this.#controls.update();
  }

  /// Moves camera and target, in shares of their distance.
  pan(right: number, up: number): void {
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    const step = new Vector3(right * distance, up * distance, 0).applyQuaternion(this.#camera.quaternion);
    this.#camera.position.add(step);
    this.#controls.target.add(step);
    this.#controls.update();
  }

  zoom(factor: number): void {
    this.#camera.position.sub(this.#controls.target).multiplyScalar(factor).add(this.#controls.target);
    this.#controls.update();
  }

  draw(): void {
    if (this.#isDue) return;
    this.#isDue = true;
    requestAnimationFrame(() => {
      this.#isDue = false;
      this.#drawNow();
    });
  }

  #roomLight(): Texture {
    if (this.#room === null) {
      const generator = new PMREMGenerator(this.#renderer);
      this.#room = generator.fromScene(new RoomEnvironment(), 0.04).texture;
      generator.dispose();
    }
    return this.#room;
  }

  #makeControls(): OrbitControls {
    this.#isHeld = false;
    this.#camera.up.set(...this.#lens.up);
    const controls = new OrbitControls(this.#camera, this.#surface);
    controls.zoomToCursor = false;
    controls.addEventListener('start', () => (this.#isHeld = true));
    controls.addEventListener('end', () => {
      this.#isHeld = false;
      this.#moved();
    });
    controls.addEventListener('change', () => {
      this.onMove();
      this.#moved();
    });
    return controls;
  }

  #moved(): void {
    this.draw();
    clearTimeout(this.#timer);
    if (!this.#isHeld) this.#timer = setTimeout(() => this.onRest(), rest);
  }

  #drawNow(): void {
    const bounds = this.#surface.getBoundingClientRect();
    this.#renderer.setPixelRatio(devicePixelRatio);
    this.#renderer.setSize(bounds.width, bounds.height, false);
    this.#renderer.setScissorTest(true);
    const toTarget = this.#camera.position.distanceTo(this.#controls.target);
    const toMesh = this.#camera.position.distanceTo(this.#sphere.center);
    this.#camera.fov = this.#lens.fovY;
    this.#camera.near = Math.max(toMesh - 3 * this.#sphere.radius, toTarget / 1000);
    this.#camera.far = Math.max(toMesh + 3 * this.#sphere.radius, 2 * toTarget);
    for (const element of this.#panels) {
      const { scene, light } = this.#views.get(element)!;
      const at = element.getBoundingClientRect();
      const place = [at.left - bounds.left, bounds.bottom - at.bottom, at.width, at.height] as const;
      this.#renderer.setViewport(...place);
      this.#renderer.setScissor(...place);
      this.#camera.aspect = aspectOf(element);
      this.#camera.updateProjectionMatrix();
      this.#camera.updateMatrixWorld();
      // From over the left shoulder.
      light.position.set(-0.5, 0.7, 0.6).multiplyScalar(toTarget).applyMatrix4(this.#camera.matrixWorld);
      light.target.position.copy(this.#controls.target);
      this.#renderer.render(scene, this.#lens.isOrthographic ? this.#orthographic(toTarget) : this.#camera);
    }
  }

  /// Shows at every depth what perspective shows at the target.
  #orthographic(toTarget: number): OrthographicCamera {
    const height = toTarget * Math.tan((this.#camera.fov * Math.PI) / 360);
    const width = height * this.#camera.aspect;
    const camera = new OrthographicCamera(-width, width, height, -height, this.#camera.near, this.#camera.far);
    camera.position.copy(this.#camera.position);
    camera.quaternion.copy(this.#camera.quaternion);
    camera.updateMatrixWorld();
    return camera;
  }
}

function aspectOf(element: HTMLElement): number {
  const { width, height } = element.getBoundingClientRect();
  return Math.max(width, 1) / Math.max(height, 1);
}

/// Whether it is a scene with materials of its own, or has one.
function hasMaterials(content: Object3D | null): boolean {
  return content !== null && [content, ...content.children].some(({ userData }) => userData.hasMaterials === true);
}

/// Scenes with materials of their own are shown again in other looks, and freed by those who decoded them.
function dispose(content: Object3D | null): void {
  if (content === null || content.userData.hasMaterials === true) return;
  for (const child of [...content.children]) dispose(child);
  const { geometry, material } = content as { geometry?: { dispose(): void }; material?: { dispose(): void } };
  geometry?.dispose();
  material?.dispose();
}
