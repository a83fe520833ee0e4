// Table and bars that compare the costs of the meshes on screen.

import { element } from './elements';
import type { Panel, Shown } from './panel';

type Row = [name: string, value: (shown: Shown) => string | null, title?: string];

const whole = (n: number) => n.toLocaleString('en', { maximumFractionDigits: 0 });
const significant = (n: number | undefined) => (n === undefined ? null : String(Number(n.toPrecision(2))));
const milliseconds = (n: number | undefined) => (n === undefined ? null : n.toFixed(n < 10 ? 1 : 0));

/// Returns the bytes received from the server for a mesh.
export const bytesOf = (shown: Shown) => shown.encoded?.bytes.length ?? 0;

/// Returns table and bars. `uniformFaces`: faces of the uniform result; `uniformBytes`: its bytes, null if not fetched.
export function figures(panels: Panel[], uniformFaces: number, uniformBytes: number | null): Node[] {
  const shown = panels.flatMap((panel) => (panel.shown ? [{ panel, shown: panel.shown }] : []));
  if (shown.length === 0) return [];
  const saved = (n: number, of: number | null) => (of ? `${((1 - n / of) * 100).toFixed(1)} %` : null);
  const rows: Row[] = [
    ['faces', (one) => whole(one.faces)],
    ['vertices', (one) => whole(one.vertices)],
    ['bytes', (one) => whole(bytesOf(one)), 'That were sent for it; none for what is made here'],
    [
      'all levels',
      (one) => whole(one.levels.reduce((sum, { bytes }) => sum + bytes.length, 0)),
      'Bytes of all levels that came, this one with them',
    ],
    ['fewer faces', (one) => saved(one.faces, uniformFaces), 'Than the uniform result'],
    ['fewer bytes', (one) => saved(bytesOf(one), uniformBytes), 'Than the uniform result'],
    ['decode ms', (one) => milliseconds(one.timing.decode), 'Of the server'],
    ['refine ms', (one) => milliseconds(one.timing.refine), 'Of the server, or of this browser'],
    ['encode ms', (one) => milliseconds(one.timing.encode), 'Of the server'],
    ['round trip ms', (one) => milliseconds(one.roundTrip ?? undefined), 'From the request to the mesh, here'],
    [
      'error',
      (one) => (one.summary ? `${significant(100 * one.summary.error)} %` : null),
      'Left, as the server says: a share of the diagonal',
    ],
    ['error px', (one) => significant(one.summary?.error_pixels), 'Left, in pixels of the view'],
  ];
  const table = element('table');
  const head = table.createTHead().insertRow();
  head.append(element('td'));
  for (const { panel } of shown) {
    const cell = element('th', '', panel.shortTitle);
    cell.scope = 'col';
    head.append(cell);
  }
  const body = table.createTBody();
  for (const [name, value, title] of rows) {
    const values = shown.map((one) => value(one.shown));
    if (values.every((text) => text === null)) continue;
    const row = body.insertRow();
    const cell = element('th', '', name);
    cell.scope = 'row';
    if (title) cell.title = title;
    row.append(cell, ...values.map((text) => element('td', '', text ?? '–')));
  }
  const bars = element('div', 'bars');
  bars.setAttribute('aria-hidden', 'true'); // the table has the numbers
  const most = Math.max(...shown.map((one) => one.shown.faces));
  const mostBytes = Math.max(...shown.map((one) => bytesOf(one.shown)));
  for (const { panel, shown: one } of shown) {
    bars.append(element('span', '', panel.shortTitle));
    const pair = element('span', 'pair');
    pair.append(bar('faces', one.faces / most), bar('bytes', bytesOf(one) / mostBytes));
    bars.append(pair);
  }
  const key = element('p', 'bar-key');
  key.setAttribute('aria-hidden', 'true');
  key.append(element('i', 'faces'), ' faces ', element('i', 'bytes'), ' bytes');
  const scroll = element('div', 'scroll');
  scroll.tabIndex = 0;
  scroll.setAttribute('role', 'group');
  scroll.setAttribute('aria-label', 'Figures of the meshes');
  scroll.append(table);
  return [scroll, bars, key];
}

function bar(kind: string, share: number): HTMLElement {
  const made = element('i', kind);
  made.style.width = `${Math.max(0.5, 100 * share)}%`;
  return made;
}
