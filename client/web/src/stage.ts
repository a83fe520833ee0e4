// Stage: one canvas, renderer and camera for all panels, so that they share the view.

import {
  AmbientLight,
  type BufferGeometry,
  CameraHelper,
  DirectionalLight,
  type Object3D,
  type OrthographicCamera,
  PerspectiveCamera,
  PMREMGenerator,
  Quaternion,
  Raycaster,
  ReinhardToneMapping,
  Scene,
  Sphere,
  Spherical,
  type Texture,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';

import { measureBounds } from './bounds';
import { cameraOf, type Lens, orthographic } from './camera';
import { framed } from './framing';
import { glide } from './glide';
import type { Camera, Frozen } from './link';

/// Milliseconds without motion after which the camera is at rest.
const rest = 200;

interface View {
  scene: Scene;
  light: DirectionalLight;
  ambient: AmbientLight;
  content: Object3D | null;
  frustum: CameraHelper | null;
}

export class Stage {
  /// Function called when the camera rests at another place, or the panels have another size.
  onRest: () => void = () => {};
  /// Whether the camera has moved since it was last at rest.
  isMoving = false;
  /// Function called while the camera moves.
  onMove: () => void = () => {};
  #renderer: WebGLRenderer;
  /// Ambient light; made with the first scene.
  #room: Texture | null = null;
  #surface: HTMLElement;
  #camera = new PerspectiveCamera(45);
  #controls: OrbitControls;
  #lens: Lens = { fovY: 45, isOrthographic: false, up: [0, 1, 0] };
  #views = new Map<HTMLElement, View>();
  /// Panels on screen.
  #panels: HTMLElement[] = [];
  #sphere = new Sphere(new Vector3(), 1);
  /// Camera of the last resetCamera().
  #fitted: Camera | null = null;
  /// Mesh that the camera frames.
  #framed: BufferGeometry | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /// Whether a finger or button is pressed: then the camera is never at rest.
  #isHeld = false;
  #isDue = false;
  /// Border between the first and the last panel's pictures in one place, as a share of the width; null: no wipe.
  #wipe: number | null = null;
  #stopGliding = () => {};

  /// `surface`: element of the canvas's size that receives the pointer. Throws if the browser has no WebGL.
  constructor(canvas: HTMLCanvasElement, surface: HTMLElement) {
    this.#surface = surface;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.debug.checkShaderErrors = false; // reading the logs waits for the graphics process
    this.#renderer.toneMapping = ReinhardToneMapping; // keeps shades in white areas
    this.#renderer.toneMappingExposure = 1.6;
    this.#controls = this.#makeControls();
    new ResizeObserver(() => this.#moved()).observe(surface);
    surface.addEventListener('dblclick', (event) => this.#focus(event));
    surface.addEventListener('pointerdown', () => this.#stopGliding());
    surface.addEventListener('wheel', () => this.#stopGliding(), { passive: true });
  }

  /// Sets the border of the wipe, as a share of the width; null: panels side by side.
  set wipe(share: number | null) {
    this.#wipe = share;
    // With several panels, the cursor is not at its place in the picture.
    this.#controls.zoomToCursor = share !== null || this.#panels.length === 1;
    this.draw();
  }

  /// Sets the panels on screen; each draws its content at its place. Others keep their content.
  setPanels(elements: HTMLElement[]): void {
    this.#panels = elements;
    for (const element of elements) if (!this.#views.has(element)) this.#views.set(element, makeView());
    if (this.#isFitted) this.resetCamera();
    this.draw();
  }

  /// Draws content in the panel, and frees the previous content.
  show(element: HTMLElement, content: Object3D | null): void {
    const view = this.#views.get(element);
    if (view === undefined) return;
    if (view.content) view.scene.remove(view.content);
    dispose(view.content);
    this.#fill(view, content);
    this.draw();
  }

  /// Compiles the shaders of contents before they are shown, one in each of several tasks.
  async compile(contents: Object3D[]): Promise<void> {
    for (const content of contents) {
      await new Promise((resolve) => setTimeout(resolve, 100)); // after pictures that are due
      const view = makeView();
      this.#fill(view, content);
      await this.#renderer.compileAsync(view.scene, this.#camera);
    }
  }

  #fill(view: View, content: Object3D | null): void {
    view.content = content;
    if (content) view.scene.add(content);
    // Metals reflect their surroundings.
    const isColoured = content?.userData.isColoured === true; // colours must stay readable
    view.scene.environment = isColoured ? null : this.#roomLight();
    view.scene.environmentIntensity = 0.5; // keeps white below saturation
    view.light.intensity = isColoured ? 2.4 : 1.5;
    view.ambient.intensity = isColoured ? 0.7 : 0;
  }

  /// Draws the frustum of a camera other than the current one; null: none.
  showFrustum(camera: Frozen | null): void {
    for (const view of this.#views.values()) {
      if (view.frustum) view.scene.remove(view.frustum);
      view.frustum?.dispose();
      view.frustum = null;
      if (camera === null) continue;
      view.frustum = new CameraHelper(cameraOf(camera, this.#lens, 1 / 8, 1));
      view.scene.add(view.frustum);
    }
    this.draw();
  }

  setLens(lens: Lens): void {
    const isTurned = lens.up.some((x, i) => x !== this.#lens.up[i]);
    this.#lens = lens;
    if (isTurned) {
      const { eye, target } = this.camera;
      this.#controls.dispose(); // the controls read the camera's up vector only when made
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

  /// Returns width and height of the panel's picture in pixels.
  pixelsOf(element: HTMLElement): [number, number] {
    const bounds = element.getBoundingClientRect();
    return [bounds.width, bounds.height].map((n) => Math.max(1, Math.round(n * devicePixelRatio))) as [number, number];
  }

  /// Places the camera so that all of a mesh is visible.
  frame(geometry: BufferGeometry): void {
    if (geometry.boundingBox === null) measureBounds(geometry);
    geometry.boundingBox!.getBoundingSphere(this.#sphere);
    this.#sphere.radius = Math.max(this.#sphere.radius, 1e-30);
    this.#framed = geometry;
    this.resetCamera();
  }

  resetCamera(): void {
    if (this.#framed === null) return;
    const [aspect, share] = [aspectOf, freeShareOf].map((of) => Math.min(...this.#panels.map(of)));
    this.camera = framed(this.#framed, this.#sphere, aspect, share, this.#lens);
    this.#fitted = this.camera;
  }

  /// Whether the camera is where resetCamera() placed it.
  get #isFitted(): boolean {
    const { eye, target } = this.camera;
    return (
      this.#fitted !== null &&
      [...eye, ...target].every((x, i) => x === [...this.#fitted!.eye, ...this.#fitted!.target][i])
    );
  }

  /// Rotates about the target; angles in radians.
  orbit(right: number, up: number): void {
    // Spherical coordinates have y as their axis.
    const upright = new Quaternion().setFromUnitVectors(this.#camera.up.clone().normalize(), new Vector3(0, 1, 0));
    const arm = this.#camera.position.clone().sub(this.#controls.target).applyQuaternion(upright);
    const at = new Spherical().setFromVector3(arm);
    at.theta += right;
    at.phi -= up;
    arm.setFromSpherical(at.makeSafe()).applyQuaternion(upright.invert());
    this.#camera.position.copy(this.#controls.target).add(arm);
    this.#controls.update();
  }

  /// Moves camera and target, in multiples of their distance.
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

  /// Resolves once the next picture is drawn.
  async drawn(): Promise<void> {
    this.draw();
    await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
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
    controls.zoomToCursor = this.#wipe !== null || this.#panels.length === 1;
    controls.addEventListener('start', () => (this.#isHeld = true));
    controls.addEventListener('end', () => {
      this.#isHeld = false;
      this.#moved();
    });
    controls.addEventListener('change', () => {
      this.isMoving = true;
      this.onMove();
      this.#moved();
    });
    return controls;
  }

  #moved(): void {
    this.draw();
    clearTimeout(this.#timer);
    if (this.#isHeld) return;
    this.#timer = setTimeout(() => {
      this.isMoving = false;
      this.onRest();
    }, rest);
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
    for (const [i, element] of this.#panels.entries()) {
      const { scene, light } = this.#views.get(element)!;
      const at = element.getBoundingClientRect();
      const [left, bottom] = [at.left - bounds.left, bounds.bottom - at.bottom];
      this.#renderer.setViewport(left, bottom, at.width, at.height);
      const [from, to] = this.#wipe === null ? [0, 1] : i === 0 ? [0, this.#wipe] : [this.#wipe, 1];
      this.#renderer.setScissor(left + from * at.width, bottom, (to - from) * at.width, at.height);
      const camera = this.#lookingAt(element);
      // Light from behind the left shoulder.
      light.position.set(-0.5, 0.7, 0.6).multiplyScalar(toTarget).applyMatrix4(this.#camera.matrixWorld);
      light.target.position.copy(this.#controls.target);
      this.#renderer.render(scene, camera);
    }
  }

  /// Returns the camera, with the projection for the panel's picture.
  #lookingAt(element: HTMLElement): PerspectiveCamera | OrthographicCamera {
    this.#camera.aspect = aspectOf(element);
    this.#camera.updateProjectionMatrix();
    this.#camera.updateMatrixWorld();
    if (!this.#lens.isOrthographic) return this.#camera;
    const toTarget = this.#camera.position.distanceTo(this.#controls.target);
    const camera = orthographic(this.#camera.fov, this.#camera.aspect, toTarget);
    camera.near = this.#camera.near;
    camera.far = this.#camera.far;
    camera.position.copy(this.#camera.position);
    camera.quaternion.copy(this.#camera.quaternion);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  /// Moves the target to the surface under the pointer, and halves the distance.
  #focus({ clientX, clientY }: MouseEvent): void {
    const isAt = (box: DOMRect) =>
      clientX >= box.left && clientX < box.right && clientY >= box.top && clientY < box.bottom;
    const element = this.#panels.filter((panel) => isAt(panel.getBoundingClientRect())).at(-1);
    const content = element && this.#views.get(element)?.content;
    if (!content) return;
    const box = element.getBoundingClientRect();
    const at = new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.#lookingAt(element));
    ray.params.Line.threshold = 0;
    const hit = ray.intersectObject(content, true).find(({ face }) => face);
    if (hit === undefined) return;
    const from = this.camera;
    const eye = new Vector3(...from.eye)
      .sub(new Vector3(...from.target))
      .multiplyScalar(0.5)
      .add(hit.point);
    this.#stopGliding();
    const to = { eye: eye.toArray(), target: hit.point.toArray() };
    this.#stopGliding = glide(from, to, (camera) => (this.camera = camera));
  }
}

function makeView(): View {
  const scene = new Scene();
  const light = new DirectionalLight(0xffffff, 2.4);
  const ambient = new AmbientLight(0xffffff, 0.7);
  scene.add(ambient, light, light.target);
  return { scene, light, ambient, content: null, frustum: null };
}

function aspectOf(element: HTMLElement): number {
  const { width, height } = element.getBoundingClientRect();
  return Math.max(width, 1) / Math.max(height, 1);
}

/// Returns the share of a panel's height, in its middle, between caption and buttons; at least a fifth.
function freeShareOf(element: HTMLElement): number {
  const { top, height } = element.getBoundingClientRect();
  const caption = element.firstElementChild!.getBoundingClientRect().bottom - top;
  return Math.min(0.9, Math.max(0.2, 1 - (2 * caption) / Math.max(height, 1)));
}

/// Frees content. Scenes with their own materials are kept: other looks show them, and their owners free them.
function dispose(content: Object3D | null): void {
  if (content === null || content.userData.hasMaterials === true) return;
  for (const child of [...content.children]) dispose(child);
  (content as { geometry?: { dispose(): void } }).geometry?.dispose(); // materials are shared by all pictures
}
