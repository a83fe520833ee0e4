// Commands that request the meshes on screen, to be copied.

import { button, element } from './elements';
import { curlOf, type Mode } from './link';
import type { OpenMesh } from './mesh';
import { extensionOf } from './model';
import { hasKey } from './service';

export interface Command {
  mode: string;
  title: string;
  text: string;
}

/// Returns the commands. `id`: id of the stored mesh, or null. `queryFor`: returns null for the mesh as it is.
export function commandsFor(
  mesh: OpenMesh,
  id: string | null,
  shown: readonly { mode: Mode; title: string }[],
  queryFor: (mode: Mode) => string | null,
): Command[] {
  const base = new URL('.', location.href).href;
  const kind = mesh.sentKind;
  const file = mesh.name.endsWith(extensionOf[kind]) ? mesh.name : `mesh${extensionOf[kind]}`;
  return shown
    .map(({ mode, title }) => ({ mode, title, text: curlOf(base, queryFor(mode), { id, file, kind }, hasKey()) }))
    .filter(({ text }) => text !== '');
}

export function commandRows(commands: Command[]): HTMLElement[] {
  return commands.map(({ mode, title, text }) => {
    const row = element('div', 'command');
    row.dataset.mode = mode;
    const head = element('div', 'command-head');
    const code = element('pre', '', text);
    code.tabIndex = 0; // the element scrolls
    const copyButton = button('Copy', (pressed) => void copy(text, pressed, code));
    copyButton.setAttribute('aria-label', `Copy the command for ${title.toLowerCase()}`);
    head.append(element('span', '', title), copyButton);
    row.append(head, code);
    return row;
  });
}

/// Copies a text, and shows on the button whether it succeeded. If the browser forbids copying (over HTTP from another
/// machine), selects `shown` instead.
export async function copy(text: string, pressed: HTMLButtonElement, shown?: HTMLElement): Promise<void> {
  const before = pressed.textContent;
  try {
    await navigator.clipboard.writeText(text);
    pressed.textContent = 'Copied';
  } catch {
    pressed.textContent = shown ? 'Selected: press Ctrl C' : 'Copy the address bar';
    if (shown) getSelection()?.selectAllChildren(shown);
  }
  setTimeout(() => (pressed.textContent = before), 2000);
}
