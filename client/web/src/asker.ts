// Asks for what panels are to show: of the server, or of the kernel here.

import { cameraOf, type Lens } from './camera';
import type { Here } from './here';
import type { Frozen, Look, Mode, State } from './link';
import type { OpenMesh } from './mesh';
import type { Panel, Request } from './panel';
import { queryOf, type Values } from './parameters';
import { forMoving, noteFor, valuesFor } from './requests';
import type { Info } from './service';

/// What of the page decides what is asked for.
export interface Page {
  state: State;
  look: Look;
  /// What the camera sees now.
  view: Frozen;
}

export class Asker {
  /// There is something other to ask: the kernel has the mesh.
  onChange: () => void = () => {};
  /// Of the server; null until it has come.
  info: Info | null = null;
  #mesh: OpenMesh | null = null;
  /// Undefined until it is known; null where this browser cannot refine the mesh.
  #here: Here | null | undefined = null;

  constructor(private readonly page: () => Page) {}

  /// Also where the user has chosen again who refines.
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

  /// Asks for what this panel is for.
  ask(panel: Panel): void {
    const { mode } = panel;
    const { state } = this.page();
    const note = noteFor(mode, state.values);
    if (this.#mesh === null) return;
    // What this browser may refine is not sent anywhere before that is known. A scene is in one picture at a time.
    const isUndecided = mode === 'view' && state.where === 'here' && this.#here === undefined;
    if (isUndecided && this.#mesh.isScene) return;
    if (mode === 'coarse' || isUndecided) panel.ask(this.#mesh, { query: null, make: null, note });
    else if (this.info !== null)
      panel.ask(this.#mesh, { query: this.queryFor(mode), make: mode === 'view' ? this.#maker() : null, note });
  }

  /// Whether the picture is refined here, as the camera moves.
  get isLive(): boolean {
    return this.#maker() !== null && this.page().state.frozen === null;
  }

  /// Of the server. There must be a mesh, and info.
  queryFor(mode: Mode): string {
    const { state, view } = this.page();
    const values = valuesFor(mode, state.values, state.frozen ?? view, this.#mesh!.decoded.faces);
    return queryOf(values, this.info!.parameters);
  }

  /// Where this browser can and the user wants it so: for looks that need no more than the surface.
  #maker(): Request['make'] {
    const { state, look, view } = this.page();
    const here = this.#here;
    if (state.where !== 'here' || !here || look === 'level' || look === 'distance') return null;
    if (!here.does(state.values)) return null;
    const seen = state.frozen ?? view;
    const values = forMoving(state.values);
    return () => here.refine(values, cameraOf(seen, lensOf(values)), seen.pixels);
  }
}

/// How the picture is made, by what the user has set.
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
