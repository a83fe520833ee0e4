// Conversion between geometries of three.js and meshes of the kernel.

import { BufferAttribute, BufferGeometry, type InterleavedBufferAttribute } from 'three';

import type { Attribute, RefinedTriangles, Triangles } from '../kernel.js';

type Values = BufferAttribute | InterleavedBufferAttribute;

/// Place of one of the kernel's attributes in the geometries: an attribute, one of its morph targets, or the number of
/// a point's geometry.
interface Place {
  name: string;
  target: number | null;
}
const part: Place = { name: '', target: null };

/// Arrays of adjoining geometries as one mesh, and the places of its attributes.
export interface Arrays {
  triangles: Triangles;
  places: Place[];
  hasNormals: boolean;
}

/// Mark of normals that were computed for the coarse mesh: refined meshes get their own.
export const computedNormals = 'papilioComputedNormals';

export function hasNormals(geometry: BufferGeometry): boolean {
  return geometry.attributes.normal?.itemSize === 3 && geometry.userData[computedNormals] !== true;
}

/// Returns whether the kernel can refine the geometry: it has triangles, and no groups of different materials.
export function isRefinable(geometry: BufferGeometry): boolean {
  return geometry.attributes.position?.itemSize === 3 && geometry.groups.length === 0 && cornersOf(geometry) > 0;
}

/// Name in three.js of the smoothing groups of a scene (proto/gltf/surface.h), and the group of faces without one.
const smoothingGroups = '_smoothing_group';
const defaultGroup = 1;

/// Returns the kind of a geometry's attribute.
function kindOf(name: string, { itemSize }: Values): Attribute['kind'] {
  if (name === 'normal') return 'normals';
  return name === smoothingGroups && itemSize === 1 ? 'smoothing-groups' : 'values';
}

/// Joins refinable geometries to one mesh; all must have normals, or none. Points of equal position are one vertex, so
/// that they stay together. Missing values are 0, missing smoothing groups 1.
export function arraysOf(geometries: readonly BufferGeometry[]): Arrays {
  const counts = geometries.map((geometry) => geometry.attributes.position!.count);
  const points = counts.reduce((sum, count) => sum + count, 0);
  const firsts = counts.map((_, g) => counts.slice(0, g).reduce((sum, count) => sum + count, 0));
  const positions = new Float32Array(3 * points);
  const triangles: number[] = [];
  const attributes = new Map<string, Attribute & { place: Place; values: Float64Array }>();
  const add = (g: number, place: Place, kind: Attribute['kind'], components: number, values: ArrayLike<number>) => {
    const key = `${place.name} ${place.target}`;
    const known = attributes.get(key);
    const missing = kind === 'smoothing-groups' ? defaultGroup : 0;
    const all = known ?? { place, kind, components, values: new Float64Array(points * components).fill(missing) };
    attributes.set(key, all);
    for (let p = 0; p < counts[g]!; ++p)
      for (let c = 0; c < Math.min(components, all.components); ++c)
        all.values[(firsts[g]! + p) * all.components + c] = values[p * components + c]!;
  };
  for (const [g, geometry] of geometries.entries()) {
    positions.set(valuesOf(geometry.attributes.position!), 3 * firsts[g]!);
    for (let i = 0; i < cornersOf(geometry); ++i) triangles.push(firsts[g]! + (geometry.index?.getX(i) ?? i));
    for (const [name, of] of Object.entries(geometry.attributes) as [string, Values][])
      if (name === 'normal' ? hasNormals(geometry) : name !== 'position')
        add(g, { name, target: null }, kindOf(name, of), of.itemSize, valuesOf(of));
    for (const [name, targets] of Object.entries(geometry.morphAttributes) as [string, Values[]][])
      for (const [target, of] of targets.entries()) {
        const values = valuesOf(of);
        const base = geometry.attributes[name];
        if (!geometry.morphTargetsRelative && base) valuesOf(base).forEach((value, i) => (values[i]! -= value));
        add(g, { name, target }, name === 'position' ? 'displacements' : 'values', of.itemSize, values);
      }
    if (geometries.length > 1) add(g, part, 'values', 1, new Float64Array(counts[g]!).fill(g));
  }
  return {
    triangles: {
      positions,
      triangles: new Uint32Array(triangles),
      attributes: [...attributes.values()].map(({ kind, components, values }) => ({ kind, components, values })),
    },
    places: [...attributes.values()].map(({ place }) => place),
    hasNormals: hasNormals(geometries[0]!),
  };
}

/// Returns the refined geometry of each geometry of `coarse`, which were refined as one mesh.
export function geometriesOf(
  refined: RefinedTriangles,
  { places }: Arrays,
  coarse: readonly BufferGeometry[],
): BufferGeometry[] {
  const parts = refined.attributes[places.indexOf(part)]?.values;
  return coarse.map((geometry, g) => {
    // All points of a face belong to one geometry: adjoining geometries have separate points.
    const { points, triangles } =
      parts === undefined ? { points: null, triangles: refined.triangles } : only(refined, parts, g);
    const made = new BufferGeometry();
    made.setIndex(new BufferAttribute(triangles, 1));
    made.setAttribute('position', new BufferAttribute(taken(refined.positions, 3, points, 3), 3));
    made.morphTargetsRelative = true;
    const [targets, madeTargets] = [geometry, made].map((one) => one.morphAttributes as Record<string, Values[]>);
    for (const [i, { components, values }] of refined.attributes.entries()) {
      const place = places[i] ?? { name: 'normal', target: null }; // appended to a mesh without normals
      const { name, target } = place;
      const own = target === null ? geometry.attributes[name] : targets![name]?.[target];
      if (place === part || (own === undefined && i < places.length)) continue;
      const size = own?.itemSize ?? components;
      const attribute = new BufferAttribute(taken(values, components, points, size), size);
      if (target === null) made.setAttribute(name, attribute);
      else (madeTargets![name] ??= [])[target] = attribute;
    }
    // Computing it again would cost as much as the upload. The surface bulges over the coarse mesh by less than this.
    if (geometry.boundingSphere === null) geometry.computeBoundingSphere();
    made.boundingSphere = geometry.boundingSphere!.clone();
    made.boundingSphere.radius *= 1.25;
    return made;
  });
}

/// Faces of one part, and their points.
function only(
  { positions, triangles }: RefinedTriangles,
  parts: ArrayLike<number>,
  wanted: number,
): { points: Uint32Array; triangles: Uint32Array<ArrayBuffer> } {
  const numbers = new Uint32Array(positions.length / 3); // 0: not of the part
  const points = new Uint32Array(numbers.length);
  const corners = new Uint32Array(triangles.length);
  let [pointCount, cornerCount] = [0, 0];
  for (let i = 0; i < triangles.length; ++i) {
    const point = triangles[i]!;
    if (Math.round(parts[point]!) !== wanted) continue;
    if (numbers[point] === 0) {
      points[pointCount++] = point;
      numbers[point] = pointCount;
    }
    corners[cornerCount++] = numbers[point]! - 1;
  }
  return { points: points.subarray(0, pointCount), triangles: corners.slice(0, cornerCount) };
}

/// Returns the first `size` components of these points; null: of all points.
function taken(
  values: Float32Array | Float64Array,
  components: number,
  points: Uint32Array | null,
  size: number,
): Float32Array<ArrayBuffer> {
  if (points === null && size === components)
    return (values instanceof Float32Array ? values : new Float32Array(values)) as Float32Array<ArrayBuffer>;
  const count = points?.length ?? values.length / components;
  const made = new Float32Array(count * size);
  for (let p = 0; p < count; ++p)
    for (let c = 0; c < size; ++c) made[p * size + c] = values[(points ? points[p]! : p) * components + c]!;
  return made;
}

function cornersOf(geometry: BufferGeometry): number {
  const corners = geometry.index?.count ?? geometry.attributes.position!.count;
  return corners - (corners % 3);
}

/// Returns [points * components] the values as numbers, from any storage type.
function valuesOf(attribute: Values): Float64Array {
  const { count, itemSize } = attribute;
  const values = new Float64Array(count * itemSize);
  for (let i = 0; i < count; ++i)
    for (let c = 0; c < itemSize; ++c) values[i * itemSize + c] = attribute.getComponent(i, c);
  return values;
}
