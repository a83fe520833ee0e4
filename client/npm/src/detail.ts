// papilio/detail: decoder of packed models, made by `papilio pack`, level by level in a worker.

export { decodeBase, joinPrimitives } from './detail/base.js';
export type { DracoDecoder } from './detail/base.js';
export { compileDecoder, DetailDecoder } from './detail/decoder.js';
export type { BaseTriangles, CodedLevel, DecodedTriangles, NormalStyle } from './detail/decoder.js';
export { isPacked, readPacked } from './detail/packed_file.js';
export type { PackedFile, PackedLevel, PackedPrimitive, Piece, Reach, ReadOptions } from './detail/packed_file.js';
export { openPacked, PackedModel } from './detail/packed_model.js';
export type { DecodeOptions, LevelInfo, OpenOptions } from './detail/packed_model.js';
export { withLevels, withSurfaces } from './detail/packed_writer.js';
export type { DracoSurface } from './detail/packed_writer.js';
