// Panel of the distance between the visible level and an original that the user opens: in numbers and as colours.

import { button, element } from './elements';
import { takeDrops } from './input';
import type { OpenMesh } from './mesh';
import { extensions, meshAmong, noFile } from './open_file';
import type { Original, TwoSided } from './original';
import type { DistanceColours } from './pictures';

const significant = (n: number) => String(Number(n.toPrecision(3)));

export class ComparePanel {
  /// Function called when the colours change.
  onColours: () => void = () => {};
  onProblem: (error: unknown) => void = () => {};
  #mesh: OpenMesh | null = null;
  #original: Original | null = null;
  #measured: { mesh: OpenMesh; original: Original; distances: TwoSided } | null = null;
  #colours: DistanceColours | null = null;
  #isMeasuring = false;
  /// Count of openings and closings, by which an outdated opening is recognized.
  #opening = 0;
  #colouring = 0;
  readonly #section = element('section');
  readonly #words = element('p');
  readonly #coloured = element('input');
  readonly #more = element('div', 'compare-more');

  /// `place`: element that receives the panel, and on which the original may be dropped.
  constructor(place: HTMLElement) {
    const title = element('h2', '', 'Distance to the original');
    title.id = 'compare-title';
    this.#section.id = 'compare';
    this.#section.setAttribute('aria-labelledby', title.id);
    const [label, picked] = this.#chooser();
    const row = element('div', 'compare-row');
    row.append(label, picked, element('span', '', 'or drop it here'));
    this.#words.id = 'compare-words';
    this.#words.setAttribute('role', 'status');
    this.#coloured.type = 'checkbox';
    this.#coloured.addEventListener('change', () => this.#tellColours());
    const check = element('label', 'check');
    check.append(this.#coloured, ' Colour the model by this distance');
    this.#more.append(
      check,
      button('Stop comparing', () => this.#forget()),
    );
    this.#section.append(title, row, this.#words, this.#more);
    this.#section.hidden = true;
    place.append(this.#section);
    takeDrops(place, (files) => void this.#open(files));
    this.#forget();
  }

  /// Returns the colours of the visible level; null if they are switched off or not measured.
  get colours(): DistanceColours | null {
    return this.#colours;
  }

  /// Starts with a new file, whose original is unknown; hides the panel unless the file is a packed model.
  show(mesh: OpenMesh): void {
    this.#mesh = mesh.packed && mesh;
    this.#section.hidden = mesh.packed === null;
    this.#forget();
  }

  /// Switches to another level of the same model.
  follow(mesh: OpenMesh): void {
    this.#mesh = mesh;
    void this.#measure();
  }

  #chooser(): [HTMLLabelElement, HTMLInputElement] {
    const [label, picked] = [element('label', 'button', 'Compare with the original…'), element('input', 'unseen')];
    label.htmlFor = picked.id = 'original-file';
    Object.assign(picked, { type: 'file', multiple: true, accept: `${extensions.join()},.bin,.png,.jpg,.jpeg,.webp` });
    picked.addEventListener('change', () => {
      const files = [...(picked.files ?? [])];
      picked.value = ''; // the same file may be chosen again
      if (files.length > 0) void this.#open(files);
    });
    return [label, picked];
  }

  /// Opens an original; keeps the previous one on failure.
  async #open(files: File[]): Promise<void> {
    if (this.#mesh === null) return;
    const opening = ++this.#opening;
    const isLatest = () => opening === this.#opening;
    if (files.length === 0) return this.onProblem(noFile());
    const file = meshAmong(files);
    const before = this.#words.textContent;
    this.#say(`Reading ${file.name} …`);
    try {
      const { Original } = await import('./original');
      const original = await Original.open(file, files);
      if (!isLatest()) return original.close();
      this.#original?.close();
      this.#original = original;
      this.#more.hidden = false;
      await this.#measure();
    } catch (error) {
      if (!isLatest()) return;
      this.#say(before ?? '');
      this.onProblem(error);
    }
  }

  #forget(): void {
    ++this.#opening;
    this.#original?.close();
    this.#original = this.#measured = null;
    this.#coloured.checked = false;
    this.#more.hidden = true;
    this.#say('');
    this.#tellColours();
  }

  /// Measures the visible level, one level at a time.
  async #measure(): Promise<void> {
    if (this.#isMeasuring) return;
    this.#isMeasuring = true;
    while (this.#mesh !== null && this.#original !== null) {
      const [mesh, original] = [this.#mesh, this.#original];
      if (this.#measured?.mesh === mesh && this.#measured.original === original) break;
      this.#measured = null;
      this.#say(`Measuring the distance to ${original.name} …`, true);
      this.#tellColours();
      try {
        const distances = await original.measure(mesh.geometry);
        this.#measured = { mesh, original, distances };
      } catch (error) {
        if (original !== this.#original) continue; // the original was closed
        this.#forget();
        this.onProblem(error);
      }
      if (this.#isCurrent()) this.#tell();
    }
    this.#isMeasuring = false;
  }

  #isCurrent(): boolean {
    return this.#measured !== null && this.#measured.mesh === this.#mesh && this.#measured.original === this.#original;
  }

  #tell(): void {
    const { original, distances } = this.#measured!;
    const { rms, largest, diagonal } = distances;
    const share = (distance: number) => `${significant(diagonal > 0 ? (100 * distance) / diagonal : 0)} %`;
    this.#say(
      `Between this level and ${original.name}, the larger of both directions: RMS distance ${share(rms)} of the ` +
        `original's diagonal (${significant(rms)} in the units of the file), largest ${share(largest)} ` +
        `(${significant(largest)}).`,
    );
    this.#tellColours();
  }

  #say(words: string, isBusy = false): void {
    this.#words.textContent = words;
    this.#section.setAttribute('aria-busy', String(isBusy));
  }

  #tellColours(): void {
    const wanted = this.#coloured.checked && this.#isCurrent() ? this.#measured : null;
    if (wanted?.mesh.decoded === this.#colours?.decoded && wanted?.distances.ofFaces === this.#colours?.ofFaces) return;
    this.#colours = wanted && {
      id: ++this.#colouring,
      decoded: wanted.mesh.decoded,
      ofFaces: wanted.distances.ofFaces,
      diagonal: wanted.distances.diagonal,
    };
    this.onColours();
  }
}
