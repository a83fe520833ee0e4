// Form for the access key of a server.

import { find } from './elements';
import { setKey } from './service';

/// `onKey`: function called after the user has entered another key, which later requests send.
export function listenToKey(onKey: () => void): void {
  const key = find<HTMLInputElement>('key');
  find('key-form').addEventListener('submit', (event) => event.preventDefault()); // Enter also triggers change
  key.addEventListener('change', () => {
    setKey(key.value.trim());
    onKey();
  });
}

export function askForKey(): void {
  find('key-form').hidden = false;
}
