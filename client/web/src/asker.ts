// Asker: chooses what panels request, from the server or from the kernel in this browser.

import { cameraOf, type Lens } from './camera';
import type { Here } from './here';
import type { Frozen, Look, Mode, State } from './link';
import type { OpenMesh } from './mesh';
import type { Panel, Request } from './panel';
import { queryOf, type Values } from './parameters';
import { forView, noteFor, valuesFor } from './requests';
import type { Info } from './service';

/// State of the page that decides the requests.
export interface Page {
  state: State;
  look: Look;
  /// View of the current camera.
  view: Frozen;
  /// Whether the camera or the slider of detail moves.
  isMoving: boolean;
}

export class Asker {
  /// Function called when requests change because the kernel has the mesh.
  onChange: () => void = () => {};
  /// Info of the server; null until it arrives.
  info: Info | null = null;
  #mesh: OpenMesh | null = null;
  /// Mesh in the kernel. Undefined while this is unknown; null if this browser cannot refine the mesh.
  #here: Here | null | undefined = null;

  constructor(private readonly page: () => Page) {}

  /// Opens the mesh in the kernel if this browser is to refine; call it again when this choice changes.
  set mesh(mesh: OpenMesh) {
    const isKnown = mesh === this.#mesh && this.#here !== null;
    this.#mesh = mesh;
    if (this.page().state.where !== 'here' || isKnown) return;
    this.#here = undefined;
    void mesh.here.then((here) => {
      if (mesh !== this.#mesh) return;
      this.#here = here;
      this.onChange();
    });
  }

  /// Requests the mesh of a panel.
  ask(panel: Panel): void {
    const { mode } = panel;
    const { state } = this.page();
    const note = noteFor(mode, state.values);
    if (this.#mesh === null) return;
    // Nothing is sent until it is known whether this browser can refine. A scene can be in only one picture.
    const isUndecided = mode === 'view' && state.where === 'here' && this.#here === undefined;
    if (isUndecided && this.#mesh.isScene) return;
    if (mode === 'coarse' || isUndecided) panel.ask(this.#mesh, { query: null, make: null, isPassing: false, note });
    else if (this.info !== null) {
      const make = mode === 'view' ? this.#maker() : null;
      const isPassing = make !== null && this.#isPassing;
      panel.ask(this.#mesh, { query: this.queryFor(mode, isPassing), make, isPassing, note });
    }
  }

  /// Returns whether the picture is refined in this browser, as the camera moves.
  get isLive(): boolean {
    return this.#maker() !== null && this.page().state.frozen === null;
  }

  /// Whether the picture follows what moves.
  get #isPassing(): boolean {
    const { state, isMoving } = this.page();
    return isMoving && state.frozen === null;
  }

  /// Returns the server's query; needs a mesh and info.
  queryFor(mode: Mode, isPassing = false): string {
    const { state, view } = this.page();
    const values = valuesFor(mode, state.values, state.frozen ?? view, this.#mesh!.decoded.faces, isPassing);
    return queryOf(values, this.info!.parameters);
  }

  /// Returns the function that refines in this browser. Null if the user chose the server, if this browser cannot
  /// refine the mesh, or if the look needs levels or distances.
  #maker(): Request['make'] {
    const { state, look, view } = this.page();
    const here = this.#here;
    if (state.where !== 'here' || !here || look === 'level' || look === 'distance') return null;
    if (!here.does(state.values)) return null;
    const seen = state.frozen ?? view;
    const values = forView(state.values, this.#isPassing);
    return (signal) => here.refine(values, cameraOf(seen, lensOf(values)), seen.pixels, signal);
  }
}

/// Returns how the picture is projected, by the parameters.
export function lensOf(values: Values): Lens {
  const up = (values.get('view.up') ?? '').split(',').map(Number);
  const isUp = up.length === 3 && up.every(Number.isFinite) && up.some((x) => x !== 0);
  const fovY = Number(values.get('view.fov_y') ?? 45);
  return {
    fovY: fovY > 0 && fovY < 180 ? fovY : 45,
    isOrthographic: values.get('view.projection') === 'orthographic',
    up: isUp ? (up as [number, number, number]) : [0, 1, 0],
  };
}
