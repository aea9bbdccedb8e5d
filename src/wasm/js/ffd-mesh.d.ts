/** A failure. */
export class FfdError extends Error {
  /** The exit code of the program `ffd`, 1 to 7. */
  readonly code: number;
  /** The name of the file that is wrong, where there is one. */
  readonly file?: string;
  /** A JSON pointer (RFC 6901) into that file, where there is one. */
  readonly pointer?: string;
  /** Of a job: the report, where one was written, as with a quality gate that failed. */
  readonly report?: Report;
  /** Of a job: what the program warned of before. */
  readonly warnings?: string[];
}

export type Points = Float32Array | Float64Array;
export type Three<T> = T | readonly [T, T, T];
export type Knots = 'default' | 'clamped' | 'open' | 'uniform' | 'closed';
export type KnotVector = Exclude<Knots, 'default'> | readonly number[] | {closed: readonly number[]};

/** u,v,w of points in the rest volume of a lattice. */
export interface Embedding {
  readonly count: number;
  /** 3 numbers a point, NaN where it is outside. */
  readonly uvw: Float64Array;
  /** 0 inside, 1 outside, 2 multiple, 3 singular, 4 invalid. */
  readonly status: Uint8Array;
  /** The points that may move with any of these control points. */
  affected(controlPoints: Iterable<number>): Uint32Array;
  /** Gives its memory back; without this it goes when the object is collected. */
  free(): void;
}

export interface Folds {
  /** A proof for the whole volume, not for samples. */
  verdict: 'none' | 'some' | 'unknown';
  cells: number;
  /** A lower bound of det J deformed, relative to the mean of det J at rest. */
  minDet: number;
}

/** A B-spline volume. Control points are in the order of lattice files: u fastest. */
export interface Lattice {
  readonly size: [number, number, number];
  readonly degree: [number, number, number];
  points(volume?: 'rest' | 'deformed'): Float64Array;
  setPoints(indices: Iterable<number>, xyz: ArrayLike<number>): void;
  setOffsets(indices: Iterable<number>, xyz: ArrayLike<number>): void;
  /** The text of a lattice file. */
  text(): string;
  /** A box that goes round a mesh is laid round these points. */
  embed(points: Points, options?: {outside?: 'keep' | 'extend' | 'error'; falloff?: number; snap?: number}): Embedding;
  /** The points that were embedded, deformed: in `out`, or in a new array of the type of `points`. */
  deform<P extends Points>(embedding: Embedding, points: P): P;
  deform<O extends Points>(embedding: Embedding, points: Points, out: O): O;
  folds(): Folds;
  free(): void;
}

export interface LatticeClass {
  /** A lattice file's text, or its content as an object. */
  parse(textOrObject: string | object): Lattice;
  box(options: {min: ArrayLike<number>; max: ArrayLike<number>; size?: Three<number>; degree?: Three<number>;
    knots?: KnotVector | readonly [KnotVector, KnotVector, KnotVector]}): Lattice;
  /** As `ffd lattice new`. */
  around(points: Points, options?: {size?: Three<number>; degree?: Three<number>; knots?: Three<Knots>; margin?: Three<number>}): Lattice;
}

export type Bytes = Uint8Array | ArrayBuffer | ArrayBufferView | string;
export type Files = {[relativeName: string]: Uint8Array};

/** A mesh, and the files that it names, by their names relative to it. */
export interface MeshFile {
  name: string;
  bytes: Bytes;
  files?: {[relativeName: string]: Bytes};
}

export type LatticeLike = Lattice | string | object;

/** The program's long options in camelCase: `asMorph: 'smile'`, `failOn: ['folds', 'outside']`, `strict: true`. A list repeats
    its option. `set` also takes an object of values. An option for a file names one of `files`. */
export interface Options {
  outside?: 'keep' | 'extend' | 'error';
  falloff?: number;
  snap?: number | string;
  blocks?: boolean;
  normals?: 'transform' | 'recompute' | 'keep';
  space?: 'scene' | 'mesh';
  rig?: 'keep' | 'follow';
  only?: string | string[];
  failOn?: string | string[];
  asMorph?: string;
  set?: string[] | {[name: string]: unknown};
  strict?: boolean;
  allowExtension?: string | string[];
  memory?: number | string;
  timeout?: number;
  [option: string]: unknown;
}

/** As `ffd-report` (data/schema/formats.md): one job. */
export interface Report {
  format: 'ffd-report';
  version: number;
  jobs: Array<{[member: string]: any}>;
}

export interface Result {
  name: string;
  bytes: Uint8Array;
  /** What the program would write beside it. */
  files: Files;
  report: Report;
  /** What the program would print as warnings. */
  warnings: string[];
}

export interface Ffd {
  readonly Lattice: LatticeClass;
  readonly FfdError: typeof FfdError;
  /** `output`: another name, whose ending is the format. */
  deform(mesh: MeshFile, lattice: LatticeLike | LatticeLike[] | null, options?: Options & {output?: string}): Promise<Result>;
  check(mesh: MeshFile, lattice: LatticeLike | LatticeLike[], options?: Options): Promise<{report: Report; files: Files; warnings: string[]}>;
  /** What `ffd info --json` prints of a mesh or of a lattice file (.json). */
  info(file: MeshFile, options?: {parts?: boolean; set?: string[] | {[name: string]: unknown}; [option: string]: unknown}): Promise<{[member: string]: any}>;
  /** A page (.html) or a picture (.png), as the ending of `output` says. */
  view(mesh: MeshFile, lattice?: LatticeLike | LatticeLike[] | null, options?: Options & {output?: string; size?: string; frames?: number;
    camera?: string; color?: 'displacement' | 'status' | 'det' | 'plain'; morph?: string | string[]; animation?: string; full?: boolean; up?: 'y' | 'z' | 'x';
    noCage?: boolean}): Promise<Result>;
}

export type WasmSource = URL | string | BufferSource | WebAssembly.Module;

/** Loads the core. Without `wasm` the package finds its own file. The module of jobs on bytes is loaded by their first call. */
export function init(options?: {wasm?: WasmSource; programWasm?: WasmSource}): Promise<Ffd>;
