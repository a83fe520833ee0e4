// Files dropped or picked by the user: .drc meshes and .glb scenes as they are, .gltf files with their references and
// .obj files with their materials or smoothing groups as a .glb, other formats as Draco meshes of positions and
// triangles.

import { encode } from './draco';
import { packGlb } from './gltf_files';
import type { Encoded } from './model';
import { sceneOf } from './obj_scene';
import { Problem } from './service';
import { readFile, triangleFormats, welded } from './triangle_files';

export const extensions = ['.drc', '.obj', '.ply', '.stl', '.off', '.glb', '.gltf'];

const extensionIn = (name: string) => /\.[^.]*$/.exec(name.toLowerCase())?.[0] ?? '';

/// Returns the problem of a drop without files.
export const noFile = () => new Problem('unsupported', `That is no file. Drop one of ${extensions.join(', ')}.`);

/// Returns the mesh among files dropped together; it refers to the others.
export function meshAmong(files: readonly File[]): File {
  return files.find(({ name }) => extensions.includes(extensionIn(name))) ?? files[0];
}

/// Reads a mesh. `files`: files dropped or picked together, including `file`. `maxBytes`: the server's limit. Rejects
/// with a Problem.
export async function readMeshFile(file: File, files: readonly File[], maxBytes: number): Promise<Encoded> {
  const extension = formatOf(file);
  if (triangleFormats.includes(extension)) {
    const read = await readFile(file.name, extension, await file.arrayBuffer());
    return (
      (await sceneOf(file.name.replace(/\.[^.]*$/, ''), read, files)) ?? {
        kind: 'draco',
        bytes: await encode(welded(read)),
        libraries: read.libraries,
      }
    );
  }
  if (extension !== '.gltf' && file.size > maxBytes)
    throw new Problem('body_too_large', `${file.name} has ${file.size} bytes; this server takes ${maxBytes}.`);
  return readEncoded(file, files);
}

/// Returns the extension of a name. Throws a Problem if no mesh has this extension, or the file is empty.
export function formatOf(file: File): string {
  const extension = extensionIn(file.name);
  if (!extensions.includes(extension))
    throw new Problem('unsupported', `${file.name} is no mesh file. Open one of ${extensions.join(', ')}.`);
  if (file.size === 0) throw new Problem('empty', `${file.name} is empty.`);
  return extension;
}

/// Reads a file that is not of triangleFormats: as it is, or a .gltf file as a .glb. Rejects with a Problem.
export async function readEncoded(file: File, files: readonly File[]): Promise<Encoded> {
  const extension = formatOf(file);
  if (extension === '.gltf') return { kind: 'scene', bytes: await packGlb(file, files) };
  return { kind: extension === '.drc' ? 'draco' : 'scene', bytes: new Uint8Array(await file.arrayBuffer()) };
}
