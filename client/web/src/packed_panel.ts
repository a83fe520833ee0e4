// Panel of a packed model: bytes and distances of its levels, and a slider between them.

import type { LevelInfo } from 'papilio/detail';

import { ComparePanel } from './compare_panel';
import './packed.css';
import { element } from './elements';
import type { OpenMesh } from './mesh';

const whole = (n: number) => n.toLocaleString('en', { maximumFractionDigits: 0 });
/// Returns a share of the diagonal in per cent.
const percent = (share: number) => `${Number((100 * share).toPrecision(2))} %`;

export class PackedPanel {
  /// Function called with another level, decoded.
  onLevel: (mesh: OpenMesh) => void = () => {};
  onProblem: (error: unknown) => void = () => {};
  readonly compare: ComparePanel;
  #mesh: OpenMesh | null = null;
  #wanted = 0;
  #isDecoding = false;
  readonly #section = element('section');
  readonly #slider = element('input');
  readonly #output = element('output');
  readonly #words = element('p');
  readonly #table = element('table');

  /// `place`: element that receives the panel.
  constructor(place: HTMLElement) {
    const title = element('h2', '', 'Packed model');
    const label = element('label', '', 'Levels of detail');
    title.id = 'packed-title';
    label.htmlFor = this.#slider.id = 'packed-level';
    this.#output.htmlFor.add(this.#slider.id);
    this.#words.id = 'packed-words';
    this.#words.setAttribute('role', 'status');
    Object.assign(this.#slider, { type: 'range', min: '0', step: '1' });
    this.#slider.addEventListener('input', () => void this.#want(Number(this.#slider.value)));
    const row = element('div', 'packed-row');
    row.append(label, this.#output, this.#slider, element('span', '', 'base'), element('span', '', 'all'));
    const scroll = element('div', 'scroll');
    scroll.tabIndex = 0;
    scroll.setAttribute('role', 'group');
    scroll.setAttribute('aria-label', 'Levels of the packed model');
    scroll.append(this.#table);
    const note = element(
      'p',
      'packed-note',
      'Distances are to the original, as shares of the diagonal of its box: the root of the mean square (RMS), and the ' +
        'largest. What is refined is the level that is shown.',
    );
    this.#section.setAttribute('aria-labelledby', title.id);
    this.#section.hidden = true;
    this.#section.append(title, row, this.#words, scroll, note);
    place.append(this.#section);
    this.compare = new ComparePanel(place);
  }

  /// Shows an open mesh; hides the panel unless it is a packed model.
  show(mesh: OpenMesh): void {
    this.#mesh = mesh.packed && mesh;
    this.compare.show(mesh);
    this.#section.hidden = mesh.packed === null;
    if (mesh.packed === null) return;
    const { level, model } = mesh.packed;
    this.#wanted = level;
    this.#slider.max = String(model.levels.length);
    this.#slider.value = String(level);
    this.#slider.disabled = model.levels.length === 0;
    this.#fill([model.base, ...model.levels]);
    this.#tell();
  }

  /// Decodes the last level requested, one level at a time.
  async #want(level: number): Promise<void> {
    this.#wanted = level;
    this.#tell();
    if (this.#isDecoding) return;
    this.#isDecoding = true;
    this.#section.setAttribute('aria-busy', 'true');
    while (this.#mesh !== null && this.#mesh.packed!.level !== this.#wanted) {
      const from = this.#mesh;
      const { levelOf } = await import('./packed');
      const made = await levelOf(from.name, from.packed!, this.#wanted).catch((error: unknown) => {
        if (from === this.#mesh) this.#fail(from.packed!.level, error);
        return null;
      });
      if (made === null || from !== this.#mesh) continue; // another file may be open now
      this.#mesh = made;
      this.onLevel(made);
      this.compare.follow(made);
    }
    this.#isDecoding = false;
    this.#section.setAttribute('aria-busy', 'false');
    this.#tell();
  }

  /// Reports an error; the visible level stays.
  #fail(level: number, error: unknown): void {
    this.#wanted = level;
    this.#slider.value = String(level);
    this.onProblem(error);
  }

  #fill(levels: readonly LevelInfo[]): void {
    const head = element('thead').appendChild(element('tr'));
    head.append(element('td'));
    for (const title of ['bytes', 'faces', 'RMS', 'largest']) {
      const cell = element('th', '', title);
      cell.scope = 'col';
      head.append(cell);
    }
    const body = element('tbody');
    for (const [l, { bytes, faces, rms, largest }] of levels.entries()) {
      const cell = element('th', '', l === 0 ? 'base' : `level ${l}`);
      cell.scope = 'row';
      const texts = [(l === 0 ? '' : '+ ') + whole(bytes), whole(faces), percent(rms), percent(largest)];
      body.insertRow().append(cell, ...texts.map((text) => element('td', '', text)));
    }
    this.#table.replaceChildren(head.parentElement!, body);
  }

  /// Shows the level of the slider.
  #tell(): void {
    const { packed } = this.#mesh ?? {};
    if (!packed) return;
    const { model, file } = packed;
    const all = [model.base, ...model.levels];
    const { rms, largest, faces } = all[this.#wanted];
    const bytes = all.slice(0, this.#wanted + 1).reduce((sum, one) => sum + one.bytes, 0);
    this.#output.textContent = `${this.#wanted} of ${model.levels.length}`;
    this.#slider.setAttribute('aria-valuetext', this.#wanted === 0 ? 'base' : this.#output.textContent);
    this.#words.textContent =
      `${whole(faces)} faces from ${whole(bytes)} bytes, of ${whole(file.length)} in the file. ` +
      `RMS distance to the original ${percent(rms)} of the diagonal, largest ${percent(largest)}.`;
    for (const [l, row] of [...this.#table.tBodies[0].rows].entries())
      if (l === this.#wanted) row.setAttribute('aria-current', 'true');
      else row.removeAttribute('aria-current');
  }
}
