// One of the meshes that are compared: what is asked for, of the server or of the kernel here, and what has come.

import type { BufferGeometry } from 'three';

import { decode } from './decode';
import { button, element } from './elements';
import { type Made, problemOf } from './here';
import { LevelsOfVertices } from './levels';
import type { Mode } from './link';
import type { OpenMesh } from './mesh';
import { type Decoded, type Encoded, extensionOf } from './model';
import { type Level, Problem, type Summary } from './service';

const titles: Record<Mode, string> = {
  coarse: 'Coarse',
  uniform: 'Uniform',
  adaptive: 'Adaptive',
  view: 'View-dependent',
};

/// A server that stays busy or silent is asked again by itself, after pauses that double up to this many seconds.
const longestPause = 60;

/// A mesh that can be shown, and what it cost.
export interface Shown {
  mesh: OpenMesh;
  decoded: Decoded;
  readonly geometry: BufferGeometry;
  /// Null for what was made in this browser: nothing was sent.
  encoded: Encoded | null;
  vertices: number;
  faces: number;
  /// Milliseconds by stage, of the server or of the kernel here; empty for the coarse mesh.
  timing: Record<string, number>;
  /// Milliseconds from the request to the decoded mesh.
  roundTrip: number | null;
  /// Null while further levels may come, and for the coarse mesh.
  summary: Summary | null;
  /// The meshes up to this one, coarse first; of a scene this one alone, of what was made here none.
  levels: Encoded[];
}

/// What a panel is asked to show.
export interface Request {
  /// Of the server; null: the coarse mesh as it is.
  query: string | null;
  /// Makes it in this browser, now; null: the server is asked.
  make: (() => Promise<Made>) | null;
  note: string;
}

export class Panel {
  readonly element: HTMLElement;
  readonly title: string;
  /// For where there is little room.
  readonly shortTitle: string;
  /// There is another mesh to be drawn, or another state to be told.
  onChange: () => void = () => {};
  onProblem: (problem: Problem) => void = () => {};
  /// The user wants this one alone, or all again.
  onEnlarge: () => void = () => {};
  shown: Shown | null = null;
  /// Why what was asked for last did not come; null: it has, or may yet.
  problem: Problem | null = null;
  #asked: { mesh: OpenMesh; request: Request } | null = null;
  #isMaking = false;
  #abort: AbortController | null = null;
  #retries = 0;
  #retryTimer: ReturnType<typeof setTimeout> | undefined;
  #caption: HTMLElement;
  #note: HTMLElement;
  /// From whoever asked for the mesh.
  #givenNote = '';
  #message: HTMLElement;
  #legend: HTMLElement;
  #save: HTMLButtonElement;
  #enlarge: HTMLButtonElement;

  constructor(readonly mode: Mode) {
    this.title = titles[mode];
    this.shortTitle = mode === 'view' ? 'View' : this.title;
    this.element = element('section', 'panel');
    this.element.dataset.mode = mode;
    this.element.setAttribute('aria-label', this.title);
    const head = element('div', 'panel-head');
    head.append(element('h2', '', this.title));
    this.#caption = head.appendChild(element('span', 'caption'));
    head.append(element('span', 'space'));
    const actions = head.appendChild(element('span', 'actions'));
    this.#enlarge = actions.appendChild(button('', () => this.onEnlarge()));
    this.#save = actions.appendChild(button('Save', () => void this.#saveFile()));
    this.#save.setAttribute('aria-label', `Save the ${this.title.toLowerCase()} mesh to a file`);
    this.#save.hidden = true;
    this.setEnlarged(false);
    // What is pressed here must not turn the mesh, which takes all that the pointer does from then on.
    this.element.addEventListener('pointerdown', (event) => event.stopPropagation());
    this.#note = element('p', 'note');
    this.#message = element('div', 'message');
    this.#message.setAttribute('role', 'status');
    this.#legend = element('div', 'legend');
    this.element.append(head, this.#note, this.#message, this.#legend);
    this.#tell('idle');
  }

  /// Asks for this unless it is what is shown or on its way. What is on its way from the server is aborted; what is being
  /// made here is shown when it is done, and then the latest is made. What is shown stays until there is better.
  ask(mesh: OpenMesh, request: Request): void {
    this.#givenNote = request.note;
    this.#showNote();
    const before = this.#asked;
    const isSame =
      before?.request.query === request.query && (before.request.make === null) === (request.make === null);
    if (before?.mesh === mesh && isSame) return;
    this.#asked = { mesh, request };
    this.#retries = 0;
    this.#start();
  }

  /// Gives up what is on its way.
  stop(): void {
    if (this.#asked === null) return;
    this.#abort?.abort();
    clearTimeout(this.#retryTimer);
    this.#asked = null;
    this.#tell('idle');
  }

  setLegend(content: Node[]): void {
    this.#legend.replaceChildren(...content);
  }

  /// Whether it is the only one on screen.
  setEnlarged(isEnlarged: boolean): void {
    this.#enlarge.textContent = isEnlarged ? 'Side by side' : 'Enlarge';
    this.#enlarge.setAttribute('aria-label', isEnlarged ? 'Show all meshes side by side' : `Show ${this.title} alone`);
  }

  /// [faces] of what is shown.
  async levelsOfFaces(shown: Shown): Promise<Uint8Array> {
    const vertices = new LevelsOfVertices();
    for (const [level, encoded] of shown.levels.entries()) {
      const isLast = level + 1 === shown.levels.length;
      vertices.add(isLast ? shown.geometry : (await decode(encoded)).geometry, level);
    }
    return vertices.ofFaces(shown.geometry);
  }

  #start(): void {
    this.#abort?.abort();
    clearTimeout(this.#retryTimer);
    const { mesh, request } = this.#asked!;
    const { query } = request;
    const abort = new AbortController();
    this.#abort = abort;
    this.#message.replaceChildren();
    this.problem = null;
    if (query === null) {
      this.#show(coarse(mesh));
      this.#tell('done');
      return;
    }
    this.#tell('busy');
    if (request.make !== null) {
      if (!this.#isMaking) void this.#makeLatest();
      return;
    }
    this.#refine(mesh, query, abort.signal).catch((error: unknown) => {
      if (abort.signal.aborted) return;
      this.#fail(error);
    });
  }

  /// Makes what is asked for here, until that is what is shown.
  async #makeLatest(): Promise<void> {
    this.#isMaking = true;
    for (let isLatest = false; !isLatest; ) {
      const asked = this.#asked;
      if (!asked?.request.make) break;
      try {
        const made = await asked.request.make();
        if (asked.mesh === this.#asked?.mesh && this.#asked.request.make) this.#show(shownOf(asked.mesh, made));
        else made.decoded.dispose();
        isLatest = asked === this.#asked;
        if (isLatest) this.#tell('done');
      } catch (error) {
        isLatest = asked === this.#asked;
        const problem = problemOf(error);
        if (isLatest && problem) this.#fail(problem);
        else if (isLatest) {
          this.#asked = { mesh: asked.mesh, request: { ...asked.request, make: null } };
          this.#start();
        }
      }
    }
    this.#isMaking = false;
  }

  async #refine(mesh: OpenMesh, query: string, signal: AbortSignal): Promise<void> {
    const began = performance.now();
    const levels: Level[] = [];
    let latest: { level: number; decoded: Decoded } | null = null;
    const show = (level: number, decoded: Decoded, summary: Summary | null) => {
      const encoded = levels.slice(0, level + 1).map((one) => one.encoded);
      this.#show({
        mesh,
        decoded,
        get geometry() {
          return decoded.geometry;
        },
        encoded: encoded[level],
        vertices: levels[level].vertices,
        faces: levels[level].faces,
        timing: levels[level].timing,
        roundTrip: summary && performance.now() - began,
        summary,
        levels: encoded,
      });
    };
    // Shows levels that are better than what is on screen. Those that come while one is decoded wait, and of those the
    // last is next.
    const showBetter = async () => {
      for (let level = -1; level + 1 < levels.length; ) {
        level = levels.length - 1;
        if (this.shown?.mesh === mesh && levels[level].faces <= this.shown.faces) continue;
        latest = { level, decoded: await decode(levels[level].encoded) };
        signal.throwIfAborted();
        show(level, latest.decoded, null);
      }
    };
    let showing: Promise<void> | null = null;
    const onLevel = (level: Level) => {
      levels.push(level);
      this.#tell('busy', `level ${levels.length - 1}`);
      showing ??= showBetter().finally(() => (showing = null));
      showing.catch(() => {}); // told below
    };
    const summary = await mesh.refine(query, onLevel, signal);
    await showing;
    const last = levels.length - 1;
    const made = latest as { level: number; decoded: Decoded } | null;
    const decoded = made?.level === last ? made.decoded : await decode(levels[last].encoded);
    signal.throwIfAborted();
    show(last, decoded, summary);
    this.#retries = 0;
    this.#tell('done');
  }

  #show(shown: Shown): void {
    const before = this.shown?.decoded;
    if (before !== shown.decoded && before !== this.shown?.mesh.decoded) before?.dispose();
    this.shown = shown;
    this.#caption.textContent = `${shown.faces.toLocaleString('en')} faces`;
    this.element.dataset.faces = String(shown.faces);
    this.element.dataset.by = shown.encoded === null ? 'here' : 'server';
    this.#save.hidden = false;
    this.#showNote();
    this.onChange();
  }

  #showNote(): void {
    const note = [this.#givenNote, this.shown?.summary?.unreached ?? ''].join(' ').trim();
    if (note !== this.#note.textContent) this.#note.textContent = note; // the same again costs a layout
  }

  #tell(state: 'idle' | 'busy' | 'done' | 'failed', doing = ''): void {
    this.element.dataset.state = state;
    this.element.setAttribute('aria-busy', String(state === 'busy'));
    this.element.style.setProperty('--doing', JSON.stringify(doing));
    if (state !== 'busy') this.onChange();
  }

  #fail(error: unknown): void {
    const problem =
      error instanceof Problem
        ? error
        : new Problem('unexpected', error instanceof Error ? error.message : String(error));
    this.problem = problem;
    const again = button('Try again', () => this.#start());
    this.#message.replaceChildren(element('p', '', problem.message), again);
    this.#tell('failed');
    this.onProblem(problem);
    if (problem.retryAfter === null) return;
    const pause = Math.max(1, Math.ceil(problem.retryAfter)) * 2 ** this.#retries++;
    this.#countDown(Math.min(pause, longestPause), again);
  }

  #countDown(seconds: number, again: HTMLButtonElement): void {
    if (seconds === 0) return this.#start();
    again.textContent = `Try again (by itself in ${seconds} s)`;
    this.#retryTimer = setTimeout(() => this.#countDown(seconds - 1, again), 1000);
  }

  /// What was made here is a file once the server has encoded it.
  async #saveFile(): Promise<void> {
    const { shown } = this;
    if (shown === null) return;
    let encoded = shown.encoded;
    try {
      if (encoded === null) {
        const { query } = this.#asked!.request;
        await shown.mesh.refine(query!, (level) => (encoded = level.encoded), new AbortController().signal);
      }
    } catch (error) {
      this.#fail(error);
      return;
    }
    const { kind, bytes } = encoded!;
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = `${shown.mesh.name.replace(/\.[^.]*$/, '')}-${this.mode}${extensionOf[kind]}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }
}

function shownOf(mesh: OpenMesh, { decoded, summary, milliseconds }: Made): Shown {
  return {
    mesh,
    decoded,
    get geometry() {
      return decoded.geometry;
    },
    encoded: null,
    vertices: decoded.vertices,
    faces: decoded.faces,
    timing: { refine: milliseconds },
    roundTrip: null,
    summary,
    levels: [],
  };
}

function coarse(mesh: OpenMesh): Shown {
  return {
    mesh,
    decoded: mesh.decoded,
    get geometry() {
      return mesh.geometry;
    },
    encoded: mesh.encoded,
    vertices: mesh.decoded.vertices,
    faces: mesh.decoded.faces,
    timing: {},
    roundTrip: null,
    summary: null,
    levels: [mesh.encoded],
  };
}
