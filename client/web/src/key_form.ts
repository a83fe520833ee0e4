// The access key, where the server wants one.

import { find } from './elements';
import { setKey } from './service';

/// `onKey`: the user has given another, which is sent from now on.
export function listenToKey(onKey: () => void): void {
  const key = find<HTMLInputElement>('key');
  find('key-form').addEventListener('submit', (event) => event.preventDefault()); // Enter is a change too
  key.addEventListener('change', () => {
    setKey(key.value.trim());
    onKey();
  });
}

export function askForKey(): void {
  find('key-form').hidden = false;
}
