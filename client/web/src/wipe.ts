// Wipe between two meshes in one picture.

import { find } from './elements';

export class Wipe {
  /// Function called with the border of the first picture, as a share of the width.
  onChange: (share: number) => void = () => {};
  #surface = find('stage');
  #input = find<HTMLInputElement>('wipe');

  constructor() {
    this.#input.addEventListener('input', () => this.#moved());
    new ResizeObserver(() => this.#moved()).observe(this.#surface);
    // The press must not rotate the mesh.
    this.#input.addEventListener('pointerdown', (event) => event.stopPropagation());
  }

  set isShown(isShown: boolean) {
    find('wipe-line').hidden = this.#input.hidden = !isShown;
    this.#moved();
  }

  get share(): number {
    // Middle of the handle, which stays within the picture.
    const width = Math.max(1, this.#surface.clientWidth);
    const handle = 0.5 * parseFloat(getComputedStyle(this.#input).getPropertyValue('--handle')) || 0;
    return (handle + (Number(this.#input.value) / 1000) * (width - 2 * handle)) / width;
  }

  #moved(): void {
    find('wipe-line').style.left = `${100 * this.share}%`;
    this.onChange(this.share);
  }
}
