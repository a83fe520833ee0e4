// Pictures and figures of the results.

import { find, setChildren } from './elements';
import { figures } from './figures';
import type { Look } from './link';
import type { OpenMesh } from './mesh';
import type { Panel } from './panel';
import type { DistanceColours, Pictures } from './pictures';
import { costOf } from './strip';

export class Results {
  #figuresDue: ReturnType<typeof setTimeout> | undefined;

  constructor(readonly pictures: Pictures) {}

  /// Shows results. `uniform`: panel with the uniform result for comparison, on screen or not. Rejects if a mesh cannot
  /// be decoded.
  async show(
    mesh: OpenMesh | null,
    panels: Panel[],
    uniform: Panel,
    levels: number,
    look: Look,
    colours: DistanceColours | null,
  ): Promise<void> {
    const latest = uniform.shown;
    const reference = latest !== null && latest.mesh === mesh && latest.summary !== null ? latest : null;
    const { problem } = uniform;
    const missing = problem ? `no uniform result: ${problem.message}` : 'waiting for the uniform result …';
    if (mesh !== null) {
      const current = panels.filter((panel) => panel.shown?.mesh === mesh);
      const refined = current.filter(({ mode }) => mode !== 'coarse').at(-1)?.shown;
      setChildren(find('cost'), refined ? costOf(refined, mesh.decoded.faces) : []);
      // While the camera moves, each picture has new results: the tables are delayed.
      clearTimeout(this.#figuresDue);
      this.#figuresDue = setTimeout(() => {
        const faces = reference?.faces ?? mesh.decoded.faces * 4 ** levels;
        setChildren(find('figures'), figures(current, faces, reference?.encoded?.bytes.length ?? null));
      }, 100);
    }
    await this.pictures.draw(panels, look, levels, reference ?? missing, colours);
  }
}
