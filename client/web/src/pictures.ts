// Pictures of the panels in the current look, with legends.

import type { Object3D } from 'three';

import { measureBounds } from './bounds';
import { distancesToUniform } from './distance';
import { coloured, findEdgesOf, hasFoundEdges, rampColour, sampleDrawings, shaded, withEdges } from './drawing';
import { element } from './elements';
import type { Look } from './link';
import type { OpenMesh } from './mesh';
import type { Decoded } from './model';
import type { Panel, Shown } from './panel';
import type { Stage } from './stage';
import { hide, type Path } from './tree';

/// Colours by distance, in every look: distances of a packed model's level from its original.
export interface DistanceColours {
  /// Number that differs for other colours.
  id: number;
  decoded: Decoded;
  /// [faces] in the unit of `diagonal`.
  ofFaces: Float32Array;
  diagonal: number;
}

export class Pictures {
  /// Distances by the mesh: the uniform mesh, and [faces] in mesh units.
  #distances = new WeakMap<Shown, { uniform: Shown; faces: Float32Array }>();
  #abort = new AbortController();
  /// Hidden parts of a scene.
  #hidden: ReadonlySet<Path> = new Set();
  /// Mesh and look of each panel's picture.
  #drawn = new Map<Panel, { shown: Shown; how: string }>();

  constructor(readonly stage: Stage) {}

  /// Compiles the shaders of all looks before they are first shown.
  compileLooks(): Promise<void> {
    return this.stage.compile(sampleDrawings());
  }

  set hidden(paths: ReadonlySet<Path>) {
    this.#hidden = paths;
    for (const { shown } of this.#drawn.values()) if (shown.decoded.scene) hide(shown.decoded.scene, paths);
    this.stage.draw();
  }

  /// Prepares the edges or levels of a look. An error is reported when the mesh is drawn.
  async prepare(decoded: Decoded, look: Look): Promise<void> {
    if (look === 'wireframe') await findEdgesOf(decoded).catch(() => {});
  }

  /// Draws panels, and cancels the previous drawing. `levels`: number requested. `uniform`: mesh that distances are
  /// measured to, or the reason why it is absent. Rejects if a mesh cannot be decoded.
  async draw(
    panels: Panel[],
    look: Look,
    levels: number,
    uniform: Shown | string,
    colours: DistanceColours | null,
  ): Promise<void> {
    this.#abort.abort();
    this.#abort = new AbortController();
    const { signal } = this.#abort;
    const all = panels.flatMap((panel) => (panel.shown ? [{ panel, shown: panel.shown }] : []));
    const pictures = all.filter(({ shown }) => shown.decoded !== colours?.decoded);
    try {
      for (const picture of all)
        if (picture.shown.decoded === colours?.decoded) await this.#drawColours(picture, colours, signal);
      if (look === 'level') await this.#drawLevels(pictures, Math.max(levels, 1), signal);
      else if (look === 'distance' && typeof uniform !== 'string') await this.#drawDistances(pictures, uniform, signal);
      else if (look === 'wireframe') await this.#drawEdges(pictures, signal);
      else for (const picture of pictures) this.#drawShaded(picture, look === 'distance' ? String(uniform) : '');
    } catch (error) {
      if (!signal.aborted) throw error;
    }
  }

  #drawShaded({ panel, shown }: Picture, words: string): void {
    this.#put({ panel, shown }, 'shaded', () => shaded(shown.decoded));
    panel.setLegend(words === '' ? [] : [element('span', '', words)]);
  }

  /// Draws edges; shades meshes until their edges are found, as the previous picture may be freed by then.
  async #drawEdges(pictures: Picture[], signal: AbortSignal): Promise<void> {
    const draw = (picture: Picture) => this.#put(picture, 'edges', () => withEdges(picture.shown.decoded));
    for (const picture of pictures) {
      if (hasFoundEdges(picture.shown.decoded)) draw(picture);
      else this.#drawShaded(picture, '');
      picture.panel.setLegend([]);
    }
    for (const picture of pictures) {
      await findEdgesOf(picture.shown.decoded);
      signal.throwIfAborted();
      draw(picture);
    }
  }

  async #drawColours(picture: Picture, { id, ofFaces, diagonal }: DistanceColours, signal: AbortSignal): Promise<void> {
    const { panel } = picture;
    const most = largestOf(ofFaces);
    await this.#putColours(picture, `colours ${id}`, (face) => Math.sqrt(ofFaces[face] / (most || 1)), signal);
    panel.setLegend(distanceLegend(most / diagonal, most / diagonal));
  }

  async #drawLevels(pictures: Picture[], levels: number, signal: AbortSignal): Promise<void> {
    for (const { panel, shown } of pictures) {
      const how = `levels ${levels}`;
      if (!this.#has({ panel, shown }, how)) {
        const ofFaces = await panel.levelsOfFaces(shown);
        signal.throwIfAborted();
        await this.#putColours({ panel, shown }, how, (face) => ofFaces[face] / levels, signal);
      }
      panel.setLegend(levelLegend(levels));
    }
  }

  async #drawDistances(pictures: Picture[], uniform: Shown, signal: AbortSignal): Promise<void> {
    for (const { panel, shown } of pictures) {
      if (this.#distances.get(shown)?.uniform === uniform) continue;
      panel.setLegend([element('span', '', 'measuring …')]);
      const faces =
        shown === uniform
          ? new Float32Array(shown.geometry.index!.count / 3)
          : await distancesToUniform(shown.geometry, uniform.geometry, signal);
      signal.throwIfAborted();
      this.#distances.set(shown, { uniform, faces });
    }
    // One scale for all, so that colours are comparable.
    const largest = pictures.map(({ shown }) => largestOf(this.#distances.get(shown)!.faces));
    const most = Math.max(...largest) || 1;
    const diagonal = diagonalOf(uniform.mesh);
    for (const [i, { panel, shown }] of pictures.entries()) {
      const { faces } = this.#distances.get(shown)!;
      const shareOf = (face: number) => Math.sqrt(faces[face] / most); // square root: makes small distances distinguishable
      await this.#putColours({ panel, shown }, `distances ${most}`, shareOf, signal);
      panel.setLegend(distanceLegend(largest[i] / diagonal, most / diagonal));
      await this.stage.drawn(); // one mesh a frame
      signal.throwIfAborted();
    }
  }

  #has({ panel, shown }: Picture, how: string): boolean {
    const drawn = this.#drawn.get(panel);
    return drawn?.shown === shown && drawn.how === how;
  }

  async #putColours(
    picture: Picture,
    how: string,
    shareOf: (face: number) => number,
    signal: AbortSignal,
  ): Promise<void> {
    if (this.#has(picture, how)) return;
    const made = await coloured(picture.shown.geometry, shareOf);
    signal.throwIfAborted();
    this.#put(picture, how, () => made);
  }

  #put(picture: Picture, how: string, make: () => Object3D): void {
    if (this.#has(picture, how)) return;
    this.#drawn.set(picture.panel, { shown: picture.shown, how });
    if (picture.shown.decoded.scene) hide(picture.shown.decoded.scene, this.#hidden);
    this.stage.show(picture.panel.element, make());
  }
}

interface Picture {
  panel: Panel;
  shown: Shown;
}

/// Returns the largest of distances, which are not negative.
function largestOf(distances: Float32Array): number {
  let most = 0;
  for (let i = 0; i < distances.length; ++i) if (distances[i] > most) most = distances[i];
  return most;
}

function diagonalOf(mesh: OpenMesh): number {
  if (mesh.geometry.boundingBox === null) measureBounds(mesh.geometry);
  const box = mesh.geometry.boundingBox!;
  return box.min.distanceTo(box.max);
}

function swatch(share: number, text: string): HTMLElement {
  const made = element('span', 'swatch', text);
  made.style.setProperty('--colour', rampColour(share));
  return made;
}

function levelLegend(most: number): Node[] {
  const swatches = Array.from({ length: most + 1 }, (_, level) => swatch(level / most, String(level)));
  return [element('span', '', 'level'), ...swatches];
}

/// Returns a legend; both arguments are shares of the diagonal.
function distanceLegend(largest: number, most: number): Node[] {
  const percent = (share: number) => `${Number((100 * share).toPrecision(2))} %`;
  const marks = [0, 1 / 4, 1].map((share) => swatch(Math.sqrt(share), percent(share * most)));
  return [...marks, element('span', '', `largest here ${percent(largest)} of the diagonal`)];
}
