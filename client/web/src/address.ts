// Address of the page, which is a link to its state.

import { type State, toHash } from './link';

/// Writes a state into the page's address, unless it is there: writing takes milliseconds.
export function writeAddress(state: State): void {
  const hash = `#${toHash(state)}`;
  if (hash !== location.hash) history.replaceState(null, '', hash);
}
