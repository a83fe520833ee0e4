// Panel of a mesh: its request, to the server or to the kernel in this browser, and the result.

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

/// Longest pause in seconds before a busy or silent server is retried; pauses double up to it.
const longestPause = 60;

/// Decoded mesh, and its costs.
export interface Shown {
  mesh: OpenMesh;
  decoded: Decoded;
  readonly geometry: BufferGeometry;
  /// Encoded mesh; null if this browser refined it.
  encoded: Encoded | null;
  vertices: number;
  faces: number;
  /// Milliseconds by stage, on the server or in the kernel; empty for the coarse mesh.
  timing: Record<string, number>;
  /// Milliseconds from the request to the decoded mesh.
  roundTrip: number | null;
  /// Summary; null while further levels may arrive, and for the coarse mesh.
  summary: Summary | null;
  /// Whether the error in pixels is an estimate: the surface was not compared with the uniform one.
  isEstimate: boolean;
  /// Meshes up to this one, the coarse mesh first; for a scene only this one, for a mesh refined in this browser none.
  levels: Encoded[];
}

/// Request of a panel.
export interface Request {
  /// Query for the server; null: the coarse mesh as it is.
  query: string | null;
  /// Function that refines in this browser; null: the server refines.
  make: ((signal: AbortSignal) => Promise<Made>) | null;
  /// Whether `make` is finished and shown even if another request follows: the camera or the detail moves.
  isPassing: boolean;
  note: string;
}

interface Asked {
  mesh: OpenMesh;
  request: Request;
}

export class Panel {
  readonly element: HTMLElement;
  readonly title: string;
  /// Title for narrow places.
  readonly shortTitle: string;
  /// Function called when the mesh or the state has changed.
  onChange: () => void = () => {};
  onProblem: (problem: Problem) => void = () => {};
  /// Prepares the drawing of a mesh, which is shown afterwards.
  prepare: (decoded: Decoded) => Promise<void> = async () => {};
  /// Function called when the user enlarges the panel, or restores all.
  onEnlarge: () => void = () => {};
  shown: Shown | null = null;
  /// Reason why the last request failed; null: it succeeded, or is pending.
  problem: Problem | null = null;
  #asked: Asked | null = null;
  #isMaking = false;
  #abort: AbortController | null = null;
  #retries = 0;
  #retryTimer: ReturnType<typeof setTimeout> | undefined;
  #caption: HTMLElement;
  #note: HTMLElement;
  /// Note from the caller of ask().
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
    const title = head.appendChild(element('h2', '', this.shortTitle));
    title.append(element('span', 'rest', this.title.slice(this.shortTitle.length)));
    this.#caption = head.appendChild(element('span', 'caption'));
    head.append(element('span', 'space'));
    const actions = head.appendChild(element('span', 'actions'));
    this.#enlarge = actions.appendChild(button('', () => this.onEnlarge()));
    this.#save = actions.appendChild(button('Save', () => void this.#saveFile()));
    this.#save.setAttribute('aria-label', `Save the ${this.title.toLowerCase()} mesh to a file`);
    this.#save.hidden = true;
    this.setEnlarged(false);
    // The press must not start a rotation, which would capture the pointer.
    this.element.addEventListener('pointerdown', (event) => event.stopPropagation());
    this.#note = element('p', 'note');
    this.#message = element('div', 'message');
    this.#message.setAttribute('role', 'status');
    this.#legend = element('div', 'legend');
    this.element.append(head, this.#note, this.#message, this.#legend);
    this.#tell('idle');
  }

  /// Requests a mesh unless it is visible or pending. Aborts the pending request, but a refinement in this browser of a
  /// passing picture is finished and shown before the latest request starts. The visible mesh stays until a better one is
  /// ready.
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

  /// Cancels the pending request.
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

  /// Sets whether the panel is the only one on screen.
  setEnlarged(isEnlarged: boolean): void {
    this.#enlarge.textContent = isEnlarged ? 'Side by side' : 'Enlarge';
    this.#enlarge.setAttribute('aria-label', isEnlarged ? 'Show all meshes side by side' : `Show ${this.title} alone`);
  }

  /// Returns [faces] the levels of the visible mesh.
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

  /// Refines in this browser until the latest request is visible.
  async #makeLatest(): Promise<void> {
    this.#isMaking = true;
    for (let isLatest = false; !isLatest; ) {
      const asked = this.#asked;
      if (!asked?.request.make) break;
      try {
        const { signal } = asked.request.isPassing ? new AbortController() : this.#abort!;
        const made = await asked.request.make(signal);
        await this.prepare(made.decoded);
        if (asked.mesh === this.#asked?.mesh && this.#asked.request.make) this.#show(shownOf(asked, made));
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
        faces: decoded.faces, // the server counts each mesh of a scene once
        timing: levels[level].timing,
        roundTrip: summary && performance.now() - began,
        summary,
        isEstimate: isUnverified(query),
        levels: encoded,
      });
    };
    // Shows levels better than the visible one. While one is decoded, only the last of the others is kept.
    const showBetter = async () => {
      for (let level = -1; level + 1 < levels.length; ) {
        level = levels.length - 1;
        if (this.shown?.mesh === mesh && levels[level].faces <= this.shown.faces) continue;
        latest = { level, decoded: await this.#decode(levels[level].encoded) };
        signal.throwIfAborted();
        show(level, latest.decoded, null);
      }
    };
    let showing: Promise<void> | null = null;
    const onLevel = (level: Level) => {
      levels.push(level);
      this.#tell('busy', `level ${levels.length - 1}`);
      showing ??= showBetter().finally(() => (showing = null));
      showing.catch(() => {}); // errors are shown below
    };
    const summary = await mesh.refine(query, onLevel, signal);
    await showing;
    const last = levels.length - 1;
    const made = latest as { level: number; decoded: Decoded } | null;
    const decoded = made?.level === last ? made.decoded : await this.#decode(levels[last].encoded);
    signal.throwIfAborted();
    show(last, decoded, summary);
    this.#retries = 0;
    this.#tell('done');
  }

  async #decode(encoded: Encoded): Promise<Decoded> {
    const decoded = await decode(encoded);
    await this.prepare(decoded);
    return decoded;
  }

  #show(shown: Shown): void {
    const before = this.shown?.decoded;
    if (before !== shown.decoded && before !== this.shown?.mesh.decoded) before?.dispose();
    this.shown = shown;
    this.#caption.replaceChildren(shown.faces.toLocaleString('en'), element('span', 'rest', ' faces'));
    this.element.dataset.faces = String(shown.faces);
    this.element.dataset.by = shown.encoded === null ? 'here' : 'server';
    this.element.dataset.estimate = String(shown.isEstimate);
    this.#save.hidden = false;
    this.#showNote();
    this.onChange();
  }

  #showNote(): void {
    const note = [this.#givenNote, this.shown?.summary?.unreached ?? ''].join(' ').trim();
    if (note !== this.#note.textContent) this.#note.textContent = note; // setting an equal text costs a layout
  }

  #tell(state: 'idle' | 'busy' | 'done' | 'failed', doing = ''): void {
    this.element.dataset.state = state;
    this.element.setAttribute('aria-busy', String(state === 'busy'));
    this.element.style.setProperty('--doing', JSON.stringify(doing));
    if (state !== 'busy') this.onChange();
  }

  /// `again`: what the user may try again; a refinement is also tried by itself.
  #fail(error: unknown, again: (() => void) | null = null): void {
    const problem =
      error instanceof Problem
        ? error
        : new Problem('unexpected', error instanceof Error ? error.message : String(error));
    this.problem = problem;
    const retry = button('Try again', again ?? (() => this.#start()));
    this.#message.replaceChildren(element('p', '', problem.message), retry);
    this.#tell('failed');
    this.onProblem(problem);
    if (problem.retryAfter === null || again !== null) return;
    const pause = Math.max(1, Math.ceil(problem.retryAfter)) * 2 ** this.#retries++;
    this.#countDown(Math.min(pause, longestPause), retry);
  }

  #countDown(seconds: number, again: HTMLButtonElement): void {
    if (seconds === 0) return this.#start();
    again.textContent = `Try again (by itself in ${seconds} s)`;
    this.#retryTimer = setTimeout(() => this.#countDown(seconds - 1, again), 1000);
  }

  /// Saves the mesh; the server encodes a mesh refined in this browser.
  async #saveFile(): Promise<void> {
    const { shown } = this;
    if (shown === null) return;
    let encoded = shown.encoded;
    this.#message.replaceChildren();
    try {
      if (encoded === null) {
        const { query } = this.#asked!.request;
        await shown.mesh.refine(query!, (level) => (encoded = level.encoded), new AbortController().signal);
      }
    } catch (error) {
      this.#fail(error, () => void this.#saveFile());
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

function isUnverified(query: string): boolean {
  return /(^|&)view\.verify=false/.test(query);
}

function shownOf({ mesh, request }: Asked, { decoded, summary, milliseconds }: Made): Shown {
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
    isEstimate: isUnverified(request.query!),
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
    isEstimate: false,
    levels: [mesh.encoded],
  };
}
