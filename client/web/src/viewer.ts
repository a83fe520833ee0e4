// The page: what is open, what is shown of it, and what the user has set.

import { commandRows, copy } from './commands';
import { decode } from './decode';
import { defaults, lookTitles } from './defaults';
import { fetchDecoder } from './draco';
import { addChoice, button, element, find } from './elements';
import { figures } from './figures';
import { listenToDrops, listenToKeys } from './input';
import {
  curlOf,
  type Frozen,
  fromHash,
  isStored,
  type Look,
  looks,
  type Mode,
  modes,
  shortest,
  type State,
  toHash,
} from './link';
import { OpenMesh } from './mesh';
import { type Encoded, extensionOf } from './model';
import { extensions, readMeshFile } from './open_file';
import { Panel } from './panel';
import { ParameterForm } from './parameter_form';
import { queryOf } from './parameters';
import { Pictures } from './pictures';
import { levelsOf, noteFor, valuesFor } from './requests';
import { fetchInfo, fetchSample, fetchStored, hasKey, type Info, Problem, setKey } from './service';
import { Stage } from './stage';

export class Viewer {
  #state: State = fromHash(location.hash, defaults);
  #info: Info | null = null;
  #mesh: OpenMesh | null = null;
  #panels = new Map(modes.map((mode) => [mode, new Panel(mode)]));
  #form = new ParameterForm(find<HTMLFormElement>('parameters'));
  #stage: Stage;
  #pictures: Pictures;
  /// How many meshes were asked to be opened.
  #opening = 0;

  /// Throws where the browser has no WebGL.
  constructor() {
    this.#stage = new Stage(find<HTMLCanvasElement>('canvas'), find('panels'));
    this.#pictures = new Pictures(this.#stage);
    this.#stage.onMove = () => this.#showCamera();
    this.#stage.onRest = () => this.#cameraRests();
    for (const panel of this.#panels.values()) {
      panel.onChange = () => this.#showResults();
      panel.onProblem = (problem) => this.#point(problem);
      panel.onEnlarge = () => this.#setModes(this.#state.modes.length > 1 ? [panel.mode] : [...modes]);
    }
    this.#makeChoices();
    this.#listen();
    this.#setPanels();
  }

  /// Fetches what is to be there first; again what could not be had.
  async start(): Promise<void> {
    fetchDecoder().catch(() => {}); // told by what is decoded
    const info = this.#info === null ? this.#fetchInfo() : null;
    await Promise.all([info, this.#mesh === null ? this.#openNamed(this.#state.mesh) : null]);
  }

  // Opening

  async #fetchInfo(): Promise<void> {
    try {
      this.#info = await fetchInfo();
    } catch (error) {
      this.#tell(error, () => void this.start());
      return;
    }
    this.#showParameters();
    const samples = this.#info.samples.map(({ name, faces }) => new Option(`${name} (${faces} faces)`, name));
    find('sample').replaceChildren(...samples);
    this.#nameMesh();
    this.#refresh();
  }

  /// A sample, or a mesh that is stored.
  async #openNamed(name: string): Promise<void> {
    await this.#open(name, true, () => (isStored(name) ? fetchStored(name) : fetchSample(name)));
  }

  async #openFile(file: File): Promise<void> {
    const most = this.#info?.limits.max_body_bytes ?? Infinity;
    await this.#open(file.name, false, () => readMeshFile(file, most));
  }

  /// What is open stays so unless all goes well.
  async #open(name: string, isNamed: boolean, read: () => Promise<Encoded>): Promise<void> {
    const opening = ++this.#opening;
    const isLatest = () => opening === this.#opening;
    find('stage').setAttribute('aria-busy', 'true');
    try {
      const encoded = await read();
      const decoded = await decode(encoded).catch((error: unknown) => {
        if (isNamed || !(error instanceof Problem) || error.code === 'unreachable') throw error;
        throw new Problem(error.code, `${name} cannot be read: ${error.message}`);
      });
      if (isLatest()) this.#show(new OpenMesh(name, encoded, decoded), isNamed);
    } catch (error) {
      const again = () => (this.#mesh === null ? this.start() : this.#open(name, isNamed, read));
      if (isLatest()) this.#tell(error, () => void again());
      if (isLatest()) this.#nameMesh();
    } finally {
      if (isLatest()) find('stage').setAttribute('aria-busy', 'false');
    }
  }

  #show(mesh: OpenMesh, isNamed: boolean): void {
    // The first one may come with a link's camera.
    if (this.#mesh !== null) this.#state.camera = this.#state.frozen = null;
    this.#mesh?.decoded.dispose();
    this.#mesh = mesh;
    this.#showParameters();
    this.#showChoices();
    this.#state.mesh = isNamed ? mesh.name : '';
    const { missing } = mesh.decoded;
    this.#alert(missing.length > 0 ? `${mesh.name} has no ${missing.join(', ')} inside, which is shown white.` : null);
    this.#setLens();
    this.#stage.frame(mesh.geometry);
    if (this.#state.camera) this.#stage.camera = this.#state.camera;
    this.#showFrozen();
    this.#showCamera();
    this.#nameMesh();
    this.#refresh();
  }

  /// Some parameters are of scenes alone.
  #showParameters(): void {
    const ofScenes = ['output.compress', 'split_instances'];
    const isScene = this.#mesh?.isScene ?? false;
    this.#form.setKinds((this.#info?.parameters ?? []).filter(({ name }) => isScene || !ofScenes.includes(name)));
    this.#form.setValues(this.#state.values);
    if (!isScene) for (const name of ofScenes) this.#state.values.delete(name);
  }

  #nameMesh(): void {
    const select = find<HTMLSelectElement>('sample');
    const name = this.#mesh?.name ?? this.#state.mesh;
    const words = isStored(name) ? `stored ${name.slice(0, 8)}` : name;
    select.querySelector('option[data-own]')?.remove();
    if (![...select.options].some((option) => option.value === name)) {
      const option = new Option(words, name);
      option.dataset.own = '';
      select.add(option);
    }
    select.value = name;
    document.title = `${words} – Papilio`;
  }

  // Asking

  /// Asks for what is shown and not there yet.
  #refresh(): void {
    this.#setLens();
    this.#writeLink();
    const mesh = this.#mesh;
    if (mesh === null) return;
    const { values, look } = this.#state;
    for (const [mode, panel] of this.#panels) {
      const isNeeded = this.#state.modes.includes(mode) || (mode === 'uniform' && look === 'distance');
      if (!isNeeded) panel.stop();
      else if (mode === 'coarse') panel.ask(mesh, null);
      else if (this.#info) panel.ask(mesh, this.#queryFor(mode, this.#info), noteFor(mode, values));
    }
    void this.#writeCommands(mesh);
  }

  #queryFor(mode: Mode, info: Info): string {
    const view = this.#state.frozen ?? this.#view();
    return queryOf(valuesFor(mode, this.#state.values, view), info.parameters);
  }

  /// What the camera sees now, in the panel that is for it.
  #view(): Frozen {
    const panel = this.#visible().find(({ mode }) => mode === 'view') ?? this.#visible()[0];
    return { ...this.#stage.camera, pixels: this.#stage.pixelsOf(panel.element) };
  }

  #setLens(): void {
    const { values } = this.#state;
    const up = (values.get('view.up') ?? '').split(',').map(Number);
    const isUp = up.length === 3 && up.every(Number.isFinite) && up.some((x) => x !== 0);
    const fovY = Number(values.get('view.fov_y') ?? 45);
    this.#stage.setLens({
      fovY: fovY > 0 && fovY < 180 ? fovY : 45,
      isOrthographic: values.get('view.projection') === 'orthographic',
      up: isUp ? (up as [number, number, number]) : [0, 1, 0],
    });
  }

  #cameraRests(): void {
    if (this.#mesh === null) return;
    this.#state.camera = this.#stage.camera;
    this.#showCamera();
    this.#refresh();
  }

  // Showing

  /// Of scenes the levels do not come one by one.
  #look(): Look {
    return this.#mesh?.isScene && this.#state.look === 'level' ? 'shaded' : this.#state.look;
  }

  #setPanels(): void {
    const shown = this.#visible();
    for (const panel of shown) panel.setEnlarged(shown.length === 1);
    const container = find('panels');
    container.dataset.count = String(shown.length);
    container.replaceChildren(...shown.map((panel) => panel.element));
    this.#stage.setPanels(shown.map((panel) => panel.element));
    this.#showFrozen();
    this.#showResults();
  }

  #visible(): Panel[] {
    return this.#state.modes.map((mode) => this.#panels.get(mode)!);
  }

  /// Pictures and figures of what has come.
  #showResults(): void {
    const mesh = this.#mesh;
    const latest = this.#panels.get('uniform')!.shown;
    const uniform = latest !== null && latest.mesh === mesh && latest.summary !== null ? latest : null;
    const levels = levelsOf(this.#state.values);
    const failure = this.#panels.get('uniform')!.problem;
    const missing = failure ? `no uniform result: ${failure.message}` : 'waiting for the uniform result …';
    this.#pictures
      .draw(this.#visible(), this.#look(), levels, uniform ?? missing)
      .catch((error: unknown) => this.#tell(error));
    if (mesh === null) return;
    const current = this.#visible().filter((panel) => panel.shown?.mesh === mesh);
    const uniformFaces = uniform?.faces ?? mesh.decoded.faces * 4 ** levels;
    find('figures').replaceChildren(...figures(current, uniformFaces, uniform?.encoded.bytes.length ?? null));
  }

  /// Where the camera is, in the form.
  #showCamera(): void {
    const { eye, target, pixels } = this.#view();
    this.#form.setPlaceholder('view.eye', eye.map(shortest).join(','));
    this.#form.setPlaceholder('view.target', target.map(shortest).join(','));
    this.#form.setPlaceholder('view.viewport', pixels.join(','));
  }

  #showFrozen(): void {
    find<HTMLInputElement>('frozen').checked = this.#state.frozen !== null;
    this.#stage.showFrustum(this.#state.frozen);
  }

  #writeLink(): void {
    history.replaceState(null, '', `#${toHash(this.#state)}`);
  }

  async #writeCommands(mesh: OpenMesh): Promise<void> {
    const id = await mesh.id.catch(() => null); // the panels tell
    if (mesh !== this.#mesh || this.#info === null) return;
    if (this.#state.mesh === '' && id !== null) {
      this.#state.mesh = id; // a file's mesh has a name in links once it is stored
      this.#writeLink();
    }
    const base = new URL('.', location.href).href;
    const { kind } = mesh.encoded;
    const file = mesh.name.endsWith(extensionOf[kind]) ? mesh.name : `mesh${extensionOf[kind]}`;
    const commands = this.#visible().map(({ mode, title }) => {
      const query = mode === 'coarse' ? null : this.#queryFor(mode, this.#info!);
      return { mode, title, text: curlOf(base, query, { id, file, kind }, hasKey()) };
    });
    find('commands').replaceChildren(...commandRows(commands.filter(({ text }) => text !== '')));
  }

  // The user

  #makeChoices(): void {
    for (const mode of modes) {
      const title = this.#panels.get(mode)!.title;
      addChoice(find('modes'), { type: 'checkbox', name: 'mode', value: mode }, title, (isOn) => {
        const others = this.#state.modes.filter((one) => one !== mode);
        this.#setModes(isOn || others.length === 0 ? [...others, mode] : others);
      });
    }
    for (const look of looks)
      addChoice(find('looks'), { type: 'radio', name: 'look', value: look }, lookTitles[look], () => {
        this.#state.look = look;
        this.#showResults();
        this.#refresh();
      });
    this.#showChoices();
  }

  #showChoices(): void {
    for (const input of document.querySelectorAll<HTMLInputElement>('input[name=mode], input[name=look]')) {
      input.checked = [...this.#state.modes, this.#look()].some((value) => value === input.value);
      input.disabled = input.value === 'level' && this.#mesh?.isScene === true;
    }
  }

  #setModes(chosen: Mode[]): void {
    this.#state.modes = modes.filter((mode) => chosen.includes(mode));
    this.#showChoices();
    this.#setPanels();
    this.#refresh();
  }

  #listen(): void {
    const stage = this.#stage;
    const select = find<HTMLSelectElement>('sample');
    select.addEventListener('change', () => void this.#openNamed(select.value));
    const file = find<HTMLInputElement>('file');
    file.addEventListener('change', () => {
      if (file.files?.[0]) void this.#openFile(file.files[0]);
      file.value = ''; // the same file may be opened again
    });
    listenToDrops((dropped) => {
      if (dropped) void this.#openFile(dropped);
      else this.#alert(`That is no file. Drop one of ${extensions.join(', ')}.`);
    });
    listenToKeys(find('stage'), stage);
    const frozen = find<HTMLInputElement>('frozen');
    frozen.addEventListener('change', () => {
      this.#state.frozen = frozen.checked ? this.#view() : null;
      this.#showFrozen();
      this.#refresh();
    });
    find('reset-camera').addEventListener('click', () => stage.resetCamera());
    const copyLink = find<HTMLButtonElement>('copy-link');
    copyLink.addEventListener('click', () => void copy(location.href, copyLink));
    find('alert-close').addEventListener('click', () => this.#alert(null));
    const key = find<HTMLInputElement>('key');
    find('key-form').addEventListener('submit', (event) => event.preventDefault()); // Enter is a change too
    key.addEventListener('change', () => this.#setKey(key.value.trim()));
    this.#form.onChange = (name, value) => this.#setParameter(name, value);
    window.addEventListener('hashchange', () => void this.#followLink());
  }

  #setKey(key: string): void {
    setKey(key);
    this.#alert(null);
    for (const panel of this.#panels.values()) panel.stop();
    if (this.#mesh === null) void this.#openNamed(this.#state.mesh);
    else this.#refresh();
  }

  #setParameter(name: string, value: string | null): void {
    // These two are where the camera is, which is turned by hand as well: they move it, and nothing else keeps them.
    if ((name === 'view.eye' || name === 'view.target') && value !== null) {
      const point = value.split(',').map(Number) as [number, number, number];
      this.#stage.camera = { ...this.#stage.camera, [name === 'view.eye' ? 'eye' : 'target']: point };
      find<HTMLInputElement>(`parameter-${name}`).value = '';
      return;
    }
    if (value === null) this.#state.values.delete(name);
    else this.#state.values.set(name, value);
    this.#refresh();
  }

  /// The address was changed by hand.
  async #followLink(): Promise<void> {
    const { mesh } = this.#state;
    const next = fromHash(location.hash, defaults);
    if (next.mesh !== mesh) await this.#openNamed(next.mesh);
    this.#state = { ...next, mesh: this.#state.mesh };
    this.#form.setValues(this.#state.values);
    this.#showChoices();
    if (next.camera) this.#stage.camera = next.camera;
    this.#setPanels();
    this.#refresh();
  }

  // Telling

  #tell(error: unknown, again?: () => void): void {
    if (error instanceof Problem) this.#point(error);
    const mayDoBetter = error instanceof Problem && error.retryAfter !== null;
    this.#alert(error instanceof Error ? error.message : String(error), mayDoBetter ? again : undefined);
  }

  /// Shows where something can be done about it.
  #point(problem: Problem): void {
    if (problem.parameter) this.#form.setFault(problem.parameter, problem.message);
    if (problem.code === 'unauthorized' || problem.code === 'forbidden') find('key-form').hidden = false;
  }

  /// Null: nothing is wrong any more.
  #alert(words: string | null, again?: () => void): void {
    find('alert').hidden = words === null;
    find('alert-text').replaceChildren(element('span', '', words ?? ''));
    if (again === undefined) return;
    const retry = button('Try again', () => {
      this.#alert(null);
      again();
    });
    find('alert-text').append(' ', retry);
  }
}
