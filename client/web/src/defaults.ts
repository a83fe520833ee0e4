// Initial state of the page, and labels of its choices.

import type { Arrangement, Ground, Look, Place, State } from './link';

export const lookTitles: Record<Look, string> = {
  shaded: 'Shaded',
  wireframe: 'Edges',
  level: 'By level',
  distance: 'By distance to uniform',
};
export const arrangementTitles: Record<Arrangement, string> = {
  wipe: 'One picture, before and after',
  panels: 'Side by side',
};
export const placeTitles: Record<Place, string> = { here: 'in this browser', server: 'on the server' };
export const groundTitles: Record<Ground, string> = { page: 'Plain', light: 'Light', dark: 'Dark', studio: 'Studio' };

/// State of a page on which the user has set nothing.
export const defaults: State = {
  mesh: 'knot',
  modes: ['coarse', 'view'],
  arrangement: 'wipe',
  look: 'shaded',
  where: 'here',
  ground: 'page',
  camera: null,
  frozen: null,
  values: new Map([
    ['view.error_pixels', '0.5'],
    ['output.normals', 'true'],
  ]),
};
