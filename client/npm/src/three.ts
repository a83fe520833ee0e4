// papilio/three: models that refine themselves to the camera, for three.js.

export { PapilioLoader } from './three/loader.js';
export type { PapilioLoaderOptions } from './three/loader.js';
export { dracoDecoder, geometryOf, sceneNormals, showLevel } from './three/packed.js';
export { isInstanced, Parts, smooth } from './three/parts.js';
export type { Part, RefinedPart } from './three/parts.js';
export { RefinedModel } from './three/refined_model.js';
export type { ModelStatistics, RefinedModelEvents, Source } from './three/refined_model.js';
export { viewOf } from './three/view.js';
