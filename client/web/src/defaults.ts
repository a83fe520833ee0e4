// What the page shows before anybody has chosen, and the words for what can be chosen.

import { type Look, modes, type State } from './link';

export const lookTitles: Record<Look, string> = {
  shaded: 'Shaded',
  wireframe: 'Edges',
  level: 'By level',
  distance: 'By distance to uniform',
};

/// What a user who has set nothing sees.
export const defaults: State = {
  mesh: 'mug',
  modes: [...modes],
  look: 'wireframe',
  camera: null,
  frozen: null,
  values: new Map([
    ['levels', '3'],
    ['tolerance', '0.001'],
    ['view.error_pixels', '0.5'],
    ['view.edge_pixels', '0'],
  ]),
};
