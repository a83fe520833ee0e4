// papilio/wasm: refinement in the browser, without a server.

export { CoarseMesh, Kernel, KernelError } from './kernel.js';
export type {
  Attribute,
  AttributeKind,
  Fault,
  Hooks,
  Refined,
  RefinedTriangles,
  Statistics,
  Triangles,
} from './kernel.js';
export { queryOf } from './parameters.js';
export type { Parameters } from './parameters.js';
export { Refiner } from './refiner.js';
export type { OpenMesh, RefineOptions, RefinerOptions } from './refiner.js';
