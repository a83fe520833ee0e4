// Main controls: fineness, hard edges, place of refinement, and look.

import { addChoice, find } from './elements';
import { arrangementTitles, groundTitles, lookTitles, placeTitles } from './defaults';
import { arrangements, grounds, type Look, looks, places, type State } from './link';
import type { Values } from './parameters';

/// Time without a step after which the slider is at rest, in milliseconds.
const rest = 200;
/// Ends of the slider, in pixels of error.
const [coarsest, finest] = [16, 0.125];

export class Controls {
  /// Function called when the user chooses another of these.
  onChoice: (choice: Partial<Pick<State, 'arrangement' | 'look' | 'where' | 'ground'>>) => void = () => {};
  /// Function called when the user sets a parameter; null: its default.
  onParameter: (name: string, value: string | null) => void = () => {};
  /// Function called when the slider of detail rests.
  onRest: () => void = () => {};
  /// Whether the slider has moved since it was last at rest.
  isMoving = false;
  #detail = find<HTMLInputElement>('detail');
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.#detail.addEventListener('input', () => {
      this.#moved();
      const pixels = coarsest * (finest / coarsest) ** (Number(this.#detail.value) / 100);
      this.onParameter('view.error_pixels', String(Number(pixels.toPrecision(2))));
    });
    const radio = (id: string, name: string, value: string, title: string, choose: () => void) =>
      addChoice(find(id), { type: 'radio', name, value }, title, choose);
    radio('edges', 'edges', 'keep', 'keep', () => this.onParameter('shape', null));
    radio('edges', 'edges', 'round', 'round', () => this.onParameter('shape', 'organic'));
    for (const where of places) radio('places', 'where', where, placeTitles[where], () => this.onChoice({ where }));
    for (const arrangement of arrangements)
      radio('arrangements', 'as', arrangement, arrangementTitles[arrangement], () => this.onChoice({ arrangement }));
    for (const look of looks) radio('looks', 'look', look, lookTitles[look], () => this.onChoice({ look }));
    for (const ground of grounds)
      radio('grounds', 'ground', ground, groundTitles[ground], () => this.onChoice({ ground }));
  }

  #moved(): void {
    this.isMoving = true;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.isMoving = false;
      this.onRest();
    }, rest);
  }

  /// Shows the choices. `look`: the current look; `isScene`: whether levels arrive only with the result.
  show({ arrangement, where, ground, values }: State, look: Look, isScene: boolean): void {
    const chosen = new Map<string, string>([
      ['as', arrangement],
      ['where', where],
      ['ground', ground],
      ['look', look],
      ['edges', edgesOf(values)],
    ]);
    for (const [name, value] of chosen)
      for (const input of document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)) {
        input.checked = input.value === value;
        if (name !== 'look' || input.value !== 'level') continue;
        input.disabled = isScene;
        input.parentElement!.title = isScene ? 'The levels of a scene do not arrive one by one.' : '';
      }
    const pixels = Number(values.get('view.error_pixels') ?? NaN);
    find('detail-words').textContent = Number.isNaN(pixels)
      ? 'as Advanced says'
      : `within ${pixels} pixel${pixels === 1 ? '' : 's'}`;
    if (Number.isNaN(pixels) || this.#detail === document.activeElement) return;
    this.#detail.value = String((100 * Math.log(pixels / coarsest)) / Math.log(finest / coarsest));
  }
}

/// Returns the choice for hard edges; empty if neither matches the shape.
function edgesOf(values: Values): string {
  const shape = values.get('shape') ?? 'auto';
  return shape === 'auto' ? 'keep' : shape === 'organic' ? 'round' : '';
}
