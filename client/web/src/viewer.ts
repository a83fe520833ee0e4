// Page: the open mesh, its panels, and the user's settings.

import { writeAddress } from './address';
import { Alert } from './alert';
import { Asker, lensOf } from './asker';
import { commandRows, commandsFor, copy } from './commands';
import { Controls } from './controls';
import { defaults } from './defaults';
import { fetchDecoder } from './draco';
import { addChoice, find } from './elements';
import { listenToFiles, listenToKeys } from './input';
import { askForKey, listenToKey } from './key_form';
import { type Frozen, fromHash, isStored, type Look, type Mode, modes, type State } from './link';
import type { OpenMesh } from './mesh';
import { MeshSelect } from './mesh_select';
import type { Encoded } from './model';
import { meshAmong, noFile, readMeshFile } from './open_file';
import { openMesh } from './opening';
import { PackedPanel } from './packed_panel';
import { Panel } from './panel';
import { ParameterForm } from './parameter_form';
import { pause } from './pause';
import { Pictures } from './pictures';
import { levelsOf } from './requests';
import { Results } from './results';
import { fetchInfo, fetchSample, fetchStored, Problem } from './service';
import { Stage } from './stage';
import { showParts } from './tree';
import { Wipe } from './wipe';

export class Viewer {
  #state: State = fromHash(location.hash, defaults);
  #mesh: OpenMesh | null = null;
  #panels = new Map(modes.map((mode) => [mode, new Panel(mode)]));
  #form = new ParameterForm(find<HTMLFormElement>('parameters'));
  #controls = new Controls();
  #alert = new Alert();
  #wipe = new Wipe();
  #stage: Stage;
  #pictures: Pictures;
  #results: Results;
  #select = new MeshSelect();
  #packed = new PackedPanel(find('packed'));
  #asker: Asker;
  /// Count of openings, by which an outdated one is recognized.
  #opening = 0;

  /// Throws if the browser has no WebGL.
  constructor() {
    this.#stage = new Stage(find<HTMLCanvasElement>('canvas'), find('panels'));
    this.#pictures = new Pictures(this.#stage);
    this.#results = new Results(this.#pictures);
    this.#asker = new Asker(() => ({
      state: this.#state,
      look: this.#look(),
      view: this.#view(),
      isMoving: this.#stage.isMoving || this.#controls.isMoving,
    }));
    this.#asker.onChange = () => this.#refresh();
    this.#stage.onMove = () => this.#cameraMoves();
    this.#stage.onRest = () => this.#cameraRests();
    for (const panel of this.#panels.values()) {
      panel.onChange = () => this.#showResults();
      panel.onProblem = (problem) => this.#point(problem);
      panel.prepare = (decoded) => this.#pictures.prepare(decoded, this.#look());
      panel.onEnlarge = () => {
        const isAlone = this.#visible().length === 1;
        this.#state.arrangement = 'panels';
        this.#setModes(isAlone ? [...modes] : [panel.mode]);
      };
    }
    this.#makeChoices();
    this.#listen();
    this.#setPanels();
  }

  /// Fetches the initial data, and retries what failed before.
  async start(): Promise<void> {
    fetchDecoder().catch(() => {}); // errors are shown by the decoding
    const info = this.#asker.info === null ? this.#fetchInfo() : null;
    await Promise.all([info, this.#mesh === null ? this.#openNamed(this.#state.mesh) : null]);
    await this.#pictures.compileLooks();
  }

  // Opening

  async #fetchInfo(): Promise<void> {
    try {
      this.#asker.info = await fetchInfo();
    } catch (error) {
      this.#tell(error, () => void this.start());
      return;
    }
    this.#showParameters();
    this.#select.samples = this.#asker.info.samples;
    this.#nameMesh();
    this.#refresh();
  }

  /// Opens a sample or a stored mesh.
  async #openNamed(name: string): Promise<void> {
    await this.#open(name, true, () => (isStored(name) ? fetchStored(name) : fetchSample(name)));
  }

  /// Opens a mesh with the files it refers to.
  async #openFiles(files: File[]): Promise<void> {
    const most = this.#asker.info?.limits.max_body_bytes ?? Infinity;
    const file = meshAmong(files);
    await this.#open(file.name.replace(/\.gltf$/i, '.glb'), false, () => readMeshFile(file, files, most));
  }

  /// Opens a mesh; keeps the previous one on failure.
  async #open(name: string, isNamed: boolean, read: () => Promise<Encoded>): Promise<void> {
    const opening = ++this.#opening;
    const isLatest = () => opening === this.#opening;
    find('stage').setAttribute('aria-busy', 'true');
    try {
      const encoded = await read();
      const mesh = await openMesh(name, encoded).catch((error: unknown) => {
        if (isNamed || !(error instanceof Problem) || error.code === 'unreachable') throw error;
        throw new Problem(error.code, `${name} cannot be read: ${error.message}`);
      });
      if (isLatest()) this.#show(mesh, isNamed);
      else mesh.close();
    } catch (error) {
      const again = () => (this.#mesh === null ? this.start() : this.#open(name, isNamed, read));
      if (isLatest()) this.#tell(error, () => void again());
      if (isLatest()) this.#nameMesh();
    } finally {
      if (isLatest()) find('stage').setAttribute('aria-busy', 'false');
    }
  }

  #show(mesh: OpenMesh, isNamed: boolean): void {
    // The camera of a link is kept for the first mesh.
    if (this.#mesh !== null) this.#state.camera = this.#state.frozen = null;
    this.#mesh?.close();
    this.#take(mesh);
    this.#packed.show(mesh);
    this.#showParameters();
    this.#showChoices();
    showParts(mesh.decoded.scene, (hidden) => (this.#pictures.hidden = hidden));
    this.#state.mesh = isNamed ? mesh.name : '';
    if (mesh.hint !== '') this.#alert.show(mesh.hint);
    else this.#alert.hide();
    this.#stage.setLens(lensOf(this.#state.values));
    this.#stage.frame(mesh.geometry);
    if (this.#state.camera) this.#stage.camera = this.#state.camera;
    this.#showFrozen();
    this.#form.setView(this.#view());
    this.#nameMesh();
    this.#refresh();
  }

  #take(mesh: OpenMesh): void {
    this.#mesh = mesh;
    this.#asker.mesh = mesh;
  }

  /// Shows parameters; some apply only to scenes.
  #showParameters(): void {
    const ofScenes = ['output.compress', 'split_instances'];
    const isScene = this.#mesh?.isScene ?? false;
    this.#form.setKinds((this.#asker.info?.parameters ?? []).filter(({ name }) => isScene || !ofScenes.includes(name)));
    this.#form.setValues(this.#state.values);
    if (!isScene) for (const name of ofScenes) this.#state.values.delete(name);
  }

  #nameMesh(): void {
    this.#select.name = this.#mesh?.name ?? this.#state.mesh;
  }

  // Asking

  /// Requests the visible meshes that are missing.
  #refresh(): void {
    this.#stage.setLens(lensOf(this.#state.values));
    writeAddress(this.#state);
    const mesh = this.#mesh;
    if (mesh === null) return;
    for (const [mode, panel] of this.#panels) {
      const isNeeded = this.#visible().includes(panel) || (mode === 'uniform' && this.#state.look === 'distance');
      if (!isNeeded) panel.stop();
      else this.#asker.ask(panel);
    }
    void this.#writeCommands(mesh);
  }

  /// Returns the view of the current camera, in the panel for which it refines.
  #view(): Frozen {
    const panel = this.#visible().find(({ mode }) => mode === 'view') ?? this.#visible()[0];
    return { ...this.#stage.camera, pixels: this.#stage.pixelsOf(panel.element) };
  }

  /// Requests refinements in this browser for the moved camera.
  #cameraMoves(): void {
    this.#form.setView(this.#view());
    const panel = this.#panels.get('view')!;
    if (this.#visible().includes(panel) && this.#asker.isLive) this.#asker.ask(panel);
  }

  #cameraRests(): void {
    if (this.#mesh === null) return;
    this.#state.camera = this.#stage.camera;
    this.#form.setView(this.#view());
    this.#refresh();
  }

  // Showing

  /// Returns the look; scenes have none by level, as their levels do not arrive separately.
  #look(): Look {
    return this.#mesh?.isScene && this.#state.look === 'level' ? 'shaded' : this.#state.look;
  }

  #setPanels(): void {
    const shown = this.#visible();
    const isWiped = this.#state.arrangement === 'wipe' && shown.length > 1;
    for (const panel of shown) panel.setEnlarged(shown.length === 1);
    const container = find('panels');
    container.dataset.as = isWiped ? 'wipe' : 'panels';
    container.dataset.count = String(shown.length);
    container.replaceChildren(...shown.map((panel) => panel.element));
    this.#stage.setPanels(shown.map((panel) => panel.element));
    this.#wipe.isShown = isWiped;
    this.#stage.wipe = isWiped ? this.#wipe.share : null;
    find('stage').dataset.ground = this.#state.ground;
    this.#showFrozen();
    this.#showResults();
  }

  /// Returns the visible panels: with a wipe, the first and the last chosen; a single one is paired with coarse.
  #visible(): Panel[] {
    const { arrangement } = this.#state;
    let chosen = this.#state.modes;
    if (arrangement === 'wipe') chosen = chosen.length > 1 ? [chosen[0], chosen.at(-1)!] : ['coarse', 'view'];
    return chosen.map((mode) => this.#panels.get(mode)!);
  }

  #showResults(): void {
    const levels = levelsOf(this.#state.values, this.#mesh?.decoded.faces ?? 0);
    const uniform = this.#panels.get('uniform')!;
    this.#results
      .show(this.#mesh, this.#visible(), uniform, levels, this.#look(), this.#packed.compare.colours)
      .catch((error: unknown) => this.#tell(error));
  }

  #showFrozen(): void {
    find<HTMLInputElement>('frozen').checked = this.#state.frozen !== null;
    this.#stage.showFrustum(this.#state.frozen);
  }

  /// Stores the mesh, which gives a file's mesh its name in links. Returns null if the server cannot store it.
  async #store(mesh: OpenMesh): Promise<string | null> {
    const id = await mesh.id.catch(() => null); // the panels report errors
    if (mesh === this.#mesh && this.#state.mesh === '' && id !== null) {
      this.#state.mesh = id;
      writeAddress(this.#state);
    }
    return id;
  }

  /// Writes the commands if they are visible: otherwise a mesh refined in this browser would be sent.
  async #writeCommands(mesh: OpenMesh): Promise<void> {
    if (!find<HTMLDetailsElement>('advanced').open) return;
    await pause(); // sending a large mesh takes several milliseconds
    if (mesh !== this.#mesh) return;
    const id = await this.#store(mesh);
    if (mesh !== this.#mesh || this.#asker.info === null) return;
    const queryFor = (mode: Mode) => (mode === 'coarse' ? null : this.#asker.queryFor(mode));
    find('commands').replaceChildren(...commandRows(commandsFor(mesh, id, this.#visible(), queryFor)));
  }

  // The user

  #makeChoices(): void {
    for (const mode of modes) {
      const title = this.#panels.get(mode)!.title;
      addChoice(find('modes'), { type: 'checkbox', name: 'mode', value: mode }, title, (isOn) => {
        const others = this.#visible()
          .map((panel) => panel.mode)
          .filter((one) => one !== mode);
        this.#state.arrangement = 'panels';
        this.#setModes(isOn || others.length === 0 ? [...others, mode] : others);
      });
    }
    this.#controls.onChoice = (choice) => {
      Object.assign(this.#state, choice);
      if (choice.arrangement === 'panels' && this.#visible().length < 3) this.#state.modes = [...modes];
      if (choice.arrangement === 'wipe') this.#state.modes = ['coarse', 'view'];
      if (this.#mesh) this.#asker.mesh = this.#mesh;
      this.#showChoices();
      this.#setPanels();
      this.#refresh();
    };
    this.#controls.onParameter = (name, value) => {
      this.#setParameter(name, value);
      this.#form.setValues(this.#state.values);
    };
    this.#controls.onRest = () => this.#refresh();
    this.#showChoices();
  }

  #showChoices(): void {
    for (const input of document.querySelectorAll<HTMLInputElement>('input[name=mode]'))
      input.checked = this.#visible().some(({ mode }) => mode === input.value);
    this.#controls.show(this.#state, this.#look(), this.#mesh?.isScene === true);
  }

  #setModes(chosen: Mode[]): void {
    this.#state.modes = modes.filter((mode) => chosen.includes(mode));
    this.#showChoices();
    this.#setPanels();
    this.#refresh();
  }

  #listen(): void {
    const stage = this.#stage;
    this.#select.onChoice = (name) => void this.#openNamed(name);
    this.#packed.onProblem = this.#packed.compare.onProblem = (error) => this.#tell(error);
    this.#packed.compare.onColours = () => this.#showResults();
    this.#packed.onLevel = (mesh) => {
      this.#mesh?.dispose();
      this.#take(mesh);
      this.#refresh();
    };
    listenToFiles((files) => (files.length > 0 ? void this.#openFiles(files) : this.#tell(noFile())));
    listenToKeys(find('stage'), stage);
    const frozen = find<HTMLInputElement>('frozen');
    frozen.addEventListener('change', () => {
      this.#state.frozen = frozen.checked ? this.#view() : null;
      this.#showFrozen();
      this.#refresh();
    });
    find('reset-camera').addEventListener('click', () => stage.resetCamera());
    const copyLink = find<HTMLButtonElement>('copy-link');
    copyLink.addEventListener('click', async () => {
      if (this.#mesh !== null) await this.#store(this.#mesh);
      void copy(location.href, copyLink);
    });
    find('advanced').addEventListener('toggle', () => this.#mesh && void this.#writeCommands(this.#mesh));
    this.#wipe.onChange = (share) => {
      if (this.#state.arrangement === 'wipe') stage.wipe = share;
    };
    listenToKey(() => this.#keyChanged());
    this.#form.onChange = (name, value) => this.#setParameter(name, value);
    window.addEventListener('hashchange', () => void this.#followLink());
  }

  #keyChanged(): void {
    this.#alert.hide();
    for (const panel of this.#panels.values()) panel.stop();
    if (this.#mesh === null) void this.#openNamed(this.#state.mesh);
    else this.#refresh();
  }

  #setParameter(name: string, value: string | null): void {
    // These two move the camera, and are stored nowhere else.
    if ((name === 'view.eye' || name === 'view.target') && value !== null) {
      const point = value.split(',').map(Number) as [number, number, number];
      this.#stage.camera = { ...this.#stage.camera, [name === 'view.eye' ? 'eye' : 'target']: point };
      find<HTMLInputElement>(`parameter-${name}`).value = '';
      return;
    }
    if (value === null) this.#state.values.delete(name);
    else this.#state.values.set(name, value);
    this.#showChoices();
    this.#refresh();
  }

  /// Opens the state of an address that the user changed.
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
    this.#alert.show(error instanceof Error ? error.message : String(error), mayDoBetter ? again : undefined);
  }

  /// Marks the parameter at fault, or asks for the access key.
  #point(problem: Problem): void {
    if (problem.parameter) this.#form.setFault(problem.parameter, problem.message);
    if (problem.code === 'unauthorized' || problem.code === 'forbidden') askForKey();
  }
}
