// Keys and files as input.

import { find } from './elements';
import type { Stage } from './stage';

/// Handles keys while the picture has the focus: arrows rotate, Shift and arrows move, + and - zoom, Home shows the
/// whole mesh.
export function listenToKeys(surface: HTMLElement, stage: Stage): void {
  const turn = Math.PI / 24;
  const step = 1 / 20;
  const arrows: Record<string, [right: number, up: number]> = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
  };
  surface.addEventListener('keydown', (event) => {
    if (event.target !== event.currentTarget || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) stage.pan(step * arrow[0], step * arrow[1]);
    else if (arrow) stage.orbit(turn * arrow[0], turn * arrow[1]);
    else if (event.key === '+' || event.key === '=') stage.zoom(1 / 1.1);
    else if (event.key === '-') stage.zoom(1.1);
    else if (event.key === 'Home') stage.resetCamera();
    else return;
    event.preventDefault();
  });
}

/// Handles files that are picked, or dropped on the page outside elements with takeDrops. `onFiles`: called with an
/// empty array if no files were dropped.
export function listenToFiles(onFiles: (files: File[]) => void): void {
  const picked = find<HTMLInputElement>('file');
  picked.addEventListener('change', () => {
    if (picked.files?.length) onFiles([...picked.files]);
    picked.value = ''; // the same file may be opened again
  });
  const hint = find('drop-hint');
  document.addEventListener('dragover', (event) => {
    hint.hidden = event.defaultPrevented;
    event.preventDefault();
  });
  document.addEventListener('dragleave', (event) => {
    if (event.relatedTarget === null) hint.hidden = true;
  });
  document.addEventListener('drop', (event) => {
    hint.hidden = true;
    if (event.defaultPrevented) return;
    event.preventDefault();
    onFiles([...(event.dataTransfer?.files ?? [])]);
  });
}

/// Handles files dropped on an element, instead of the page.
export function takeDrops(element: HTMLElement, onFiles: (files: File[]) => void): void {
  element.addEventListener('dragover', (event) => event.preventDefault());
  element.addEventListener('drop', (event) => {
    event.preventDefault();
    onFiles([...(event.dataTransfer?.files ?? [])]);
  });
}
