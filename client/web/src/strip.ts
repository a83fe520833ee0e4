// Strip at the picture: costs and findings of the refined mesh in one line.

import { element } from './elements';
import { bytesOf } from './figures';
import type { Shown } from './panel';

const whole = (n: number) => n.toLocaleString('en', { maximumFractionDigits: 0 });

/// Returns the costs. `coarseFaces`: faces of the coarse mesh.
export function costOf(shown: Shown, coarseFaces: number): Node[] {
  const { summary, timing } = shown;
  const bytes = bytesOf(shown);
  const took = Object.values(timing).reduce((sum, one) => sum + one, 0);
  const parts = [`${whole(coarseFaces)} → ${whole(shown.faces)} faces`];
  parts.push(shown.encoded === null ? '0 bytes sent: refined here' : `${whole(bytes)} bytes from the server`);
  if (took > 0) parts.push(`${took.toFixed(took < 10 ? 1 : 0)} ms`);
  if (summary?.error_pixels !== undefined) {
    const nearness = shown.isEstimate ? 'about' : 'within';
    parts.push(`${nearness} ${Number(summary.error_pixels.toPrecision(2))} px`);
  }
  const nodes: Node[] = parts.map((text) => element('span', '', text));
  const found = summary?.shape && mechanicalIn(summary.shape);
  if (found) nodes.push(element('span', 'found', found));
  return nodes;
}

/// Returns what is said of mechanical components, from Papilio-Shape: "mechanical: 2 of 14 components"; null of others.
export function mechanicalIn(shape: string): string | null {
  if (!shape.startsWith('mechanical')) return null;
  const [few, all] = (/(\d+) of (\d+)/.exec(shape) ?? ['', '1', '1']).slice(1).map(Number);
  if (few === all) return 'This looks mechanical: its hard edges stay sharp.';
  return `${few} of ${all} pieces ${few === 1 ? 'looks mechanical: its' : 'look mechanical: their'} hard edges stay sharp.`;
}
