// Tree of a scene's parts by name, in which each can be hidden.

import type { Material, Mesh, Object3D } from 'three';

import { element, find } from './elements';
import { isMesh } from './scene';

/// Path of a part in its scene: indices of children, "0/2/1".
export type Path = string;

/// Most parts listed; longer lists are not usable.
const most = 500;

/// Shows the tree of a scene that has parts. `onHidden`: function called when the user hides or shows parts; initially
/// none are hidden.
export function showParts(scene: Object3D | null, onHidden: (hidden: ReadonlySet<Path>) => void): void {
  const hidden = new Set<Path>();
  onHidden(hidden);
  const tree =
    scene &&
    treeOf(scene, (path, isHidden) => {
      if (isHidden) hidden.add(path);
      else hidden.delete(path);
      onHidden(hidden);
    });
  find('parts-section').hidden = tree === null;
  find('parts').replaceChildren(...(tree ? [tree] : []));
}

/// Returns the tree; null if there is nothing to choose.
function treeOf(scene: Object3D, onToggle: (path: Path, isHidden: boolean) => void): HTMLElement | null {
  let meshes = 0;
  scene.traverse((object) => (meshes += Number(isMesh(object))));
  if (meshes < 2) return null;
  let left = most;
  const listOf = (parent: Object3D, path: Path): HTMLElement => {
    const list = element('ul');
    for (const [i, child] of parent.children.entries()) {
      if (left === 0 || !hasMesh(child)) continue;
      --left;
      const at = path === '' ? String(i) : `${path}/${i}`;
      const label = element('label');
      const input = element('input');
      input.type = 'checkbox';
      input.checked = true;
      input.addEventListener('change', () => onToggle(at, !input.checked));
      label.append(input, ` ${nameOf(child)}`);
      const item = element('li');
      item.append(label);
      if (child.children.some(hasMesh)) item.append(listOf(child, at));
      list.append(item);
    }
    return list;
  };
  return listOf(scene, '');
}

/// Returns the name of a part; of a mesh that three.js has numbered, its material's.
function nameOf(part: Object3D): string {
  if (!isMesh(part)) return part.name || 'Group';
  const numbered = part.name === '' || /^mesh_\d+(_\d+)?$/.test(part.name);
  const material = ([] as Material[]).concat((part as Mesh).material)[0]?.name;
  return (numbered && material) || part.name || 'Mesh';
}

/// Hides these parts of a scene, or of its refined copy, and shows the others.
export function hide(scene: Object3D, hidden: ReadonlySet<Path>): void {
  scene.traverse((object) => (object.visible = true));
  for (const path of hidden) {
    let at: Object3D | undefined = scene;
    for (const i of path.split('/')) at = at?.children[Number(i)];
    if (at) at.visible = false;
  }
}

function hasMesh(object: Object3D): boolean {
  return isMesh(object) || object.children.some(hasMesh);
}
