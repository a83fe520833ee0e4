// Alert above the whole page.

import { button, element, find } from './elements';

export class Alert {
  constructor() {
    find('alert-close').addEventListener('click', () => this.hide());
  }

  /// Shows a problem. `again`: function behind a button to retry.
  show(words: string, again?: () => void): void {
    find('alert').hidden = false;
    find('alert-text').replaceChildren(element('span', '', words));
    if (again === undefined) return;
    const retry = button('Try again', () => {
      this.hide();
      again();
    });
    find('alert-text').append(' ', retry);
  }

  hide(): void {
    find('alert').hidden = true;
    find('alert-text').replaceChildren();
  }
}
