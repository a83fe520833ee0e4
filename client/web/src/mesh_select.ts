// List of the available meshes, and the name of the open one.

import { find } from './elements';
import { isStored } from './link';
import type { Sample } from './service';

export class MeshSelect {
  onChoice: (name: string) => void = () => {};
  #select = find<HTMLSelectElement>('sample');

  constructor() {
    this.#select.addEventListener('change', () => this.onChoice(this.#select.value));
  }

  set samples(samples: Sample[]) {
    this.#select.replaceChildren(...samples.map(({ name, faces }) => new Option(`${name} (${faces} faces)`, name)));
  }

  /// Sets the name of a sample or file, or the id of a stored mesh.
  set name(name: string) {
    const words = isStored(name) ? `stored ${name.slice(0, 8)}` : name;
    this.#select.querySelector('option[data-own]')?.remove();
    if (![...this.#select.options].some((option) => option.value === name)) {
      const option = new Option(words, name);
      option.dataset.own = '';
      this.#select.add(option);
    }
    this.#select.value = name;
    document.title = `${words} – Papilio`;
  }
}
