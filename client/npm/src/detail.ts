// papilio/detail: packed models, made by `papilio pack`, decoded level by level in a worker.

export { compileDecoder, DetailDecoder } from './detail/decoder.js';
export type { CodedLevel, DecodedTriangles, NormalStyle } from './detail/decoder.js';
export { isPacked, readPacked } from './detail/packed_file.js';
export type { PackedFile, PackedLevel, Piece, Reach, ReadOptions } from './detail/packed_file.js';
export { openPacked, PackedModel } from './detail/packed_model.js';
export type { DecodeOptions, LevelInfo, OpenOptions } from './detail/packed_model.js';
export { withLevels, withSurface } from './detail/packed_writer.js';
export type { DracoSurface } from './detail/packed_writer.js';
