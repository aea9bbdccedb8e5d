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
  /** A lattice file's text or bytes, or its content as an object. */
  parse(content: string | Uint8Array | object): Lattice;
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

/** A lattice, the text or bytes of its file, or its content as an object. */
export type LatticeLike = Lattice | string | Uint8Array | object;

/** The program's long options in camelCase: `asMorph: 'smile'`, `failOn: ['folds', 'outside']`, `strict: true`. A list repeats
    its option. `set` also takes an object of values. An option for a file names one of `files`. */
export interface Options {
  outside?: 'keep' | 'extend' | 'error';
  falloff?: number;
  seam?: string;
  snap?: number | string;
  blocks?: boolean;
  normals?: 'transform' | 'recompute' | 'keep';
  space?: 'scene' | 'mesh';
  rig?: 'keep' | 'follow';
  only?: string | string[];
  /** Parts that move as one piece: `node:Wheel`, `joint:NAME`, `component`; `uniform`: each with a scale. */
  rigid?: string | string[];
  uniform?: string | string[];
  failOn?: string | string[];
  asMorph?: string;
  /** `weights.npy`, one of `files`, or `color:r` and so on. */
  weight?: string;
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

/** A length, or `1e-3r`: a part of a diagonal. */
export type Distance = number | `${number}` | `${number}r`;

/** Options of `ffd fit` in camelCase. An option for a file names one of the `files` of BEFORE, or is a file. */
export interface FitOptions {
  /** The name of the result, which ends in `.json`; default `fit.json`. */
  output?: string;
  /** Where it starts, in place of a box by `size`, `degree`, `knots`, `margin` and `axes`. */
  lattice?: LatticeLike | null;
  /** Default 6, 6, 6. */
  size?: Three<number> | string;
  /** Default 3. */
  degree?: Three<number> | string;
  /** Default `open`. */
  knots?: Three<Exclude<Knots, 'default'>>;
  /** Default 0.05. */
  margin?: Three<number> | string;
  axes?: 'principal';
  /** The box goes round these too. */
  cover?: string | MeshFile | Array<string | MeshFile>;
  /** Default `auto`. */
  smooth?: 'auto' | number | `${number}`;
  /** In place of `smooth`: the smoothest lattice with all pairs so near. */
  within?: Distance;
  symmetric?: 'u' | 'v' | 'w';
  failOn?: 'folds' | Array<'folds'>;
  only?: string | string[];
  space?: 'scene' | 'mesh';
  snap?: Distance;
  set?: string[] | {[name: string]: unknown};
  time?: number;
  reportStable?: boolean;
  strict?: boolean;
  allowExtension?: string | string[];
  memory?: number | string;
  timeout?: number;
  [option: string]: unknown;
}

/** What a fit has found: the member `fit` of its report (data/schema/formats.md). Lengths are in world units. */
export interface Fit {
  pairs: number;
  used: number;
  outside: number;
  multiple: number;
  singular: number;
  exact: number;
  dependent: number;
  smooth: number;
  smooth_chosen_by: 'gcv' | 'default' | 'within' | 'given' | 'folds';
  gcv: number | null;
  /** An offset: its constant, then what it changes by along x, y and z. */
  affine: [Vector, Vector, Vector, Vector];
  /** `worst`: the pair of `max`, from 0. */
  residual: {max: number; rms: number; p95: number; worst: number};
  residual_exact: number | null;
  largest_offset: number;
  points_without_data: number;
  folds: FoldProof;
  /** `null` without `robust`. */
  downweighted: number | null;
  spread: {positions: number; largest: number};
  flops: number;
}

/** `folds` of a report. */
export interface FoldProof {
  verdict: 'none' | 'some' | 'unknown';
  cells: number;
  min_det: number | null;
  relative_to: 'mean' | 'bounds' | 'place';
  folded_cells: number;
  unknown_cells: number;
  witness: {lattice: number; uvw: Vector; xyz: Vector; rest: Vector; det: number} | null;
}

export type Vector = [number, number, number];

export interface FitReport extends Report {
  jobs: [{
    /** The name of BEFORE, or of the pairs. */
    input: string;
    output: string;
    outputs: string[];
    status: 'ok' | 'failed';
    exit: number;
    error: string | null;
    /** `null` after a failure before a lattice was found. */
    fit: Fit | null;
    seconds?: {read: number; fit: number; write: number};
  }];
}

/** Options of a fit of points. */
export interface PointFitOptions {
  /** Where it starts, in place of a box by `size`, `degree`, `knots` and `margin`. */
  lattice?: LatticeLike;
  /** Default 6, 6, 6. */
  size?: Three<number>;
  /** Default 3. */
  degree?: Three<number>;
  /** Default `open`. */
  knots?: Three<Knots>;
  /** Default 0.05. */
  margin?: Three<number>;
  smooth?: 'auto' | number;
  /** In place of `smooth`: the smoothest lattice with all pairs so near; `1e-3r`: a part of the diagonal of the points. */
  within?: number | `${number}r`;
  /** One for each pair, at least 0; default 1. */
  weights?: ArrayLike<number> | null;
  /** The numbers of pairs that hold exactly. */
  exact?: ArrayLike<number>;
  handles?: boolean;
  robust?: boolean;
  symmetric?: 'u' | 'v' | 'w';
  /** `1e-3r`: a part of the diagonal of the lattice, which must have its control points then. */
  snap?: number | `${number}r`;
}

/** `bytes` is the file of `lattice`. */
export interface FitResult extends Result {
  lattice: Lattice;
  fit: Fit;
  report: FitReport;
}

export interface Ffd {
  readonly Lattice: LatticeClass;
  readonly FfdError: typeof FfdError;
  /** `output`: another name, whose ending is the format. */
  deform(mesh: MeshFile, lattice: LatticeLike | LatticeLike[] | null, options?: Options & {output?: string}): Promise<Result>;
  check(mesh: MeshFile, lattice: LatticeLike | LatticeLike[], options?: Options): Promise<{report: Report; files: Files; warnings: string[]}>;
  /** What `ffd info --json` prints of a mesh or of a lattice file (.json). */
  info(file: MeshFile, options?: {parts?: boolean; set?: string[] | {[name: string]: unknown}; [option: string]: unknown}): Promise<{[member: string]: any}>;
  /** A lattice in another format, as `ffd lattice convert` writes it: the endings of the names tell the formats. `mesh`: one of
      `files`, round which a box round a mesh is laid. */
  convertLattice(file: MeshFile, options: {output: string; part?: 'rest' | 'deformed' | 'both'; size?: Three<number> | string;
    degree?: Three<number> | string; order?: 'uvw' | 'auto'; block?: string | number; set?: string[] | {[name: string]: unknown}; time?: number;
    mesh?: string | string[]; [option: string]: unknown}): Promise<Omit<Result, 'report'>>;
  /** The lattice that carries points onto others, 3 numbers each, as `ffd_fit_points` finds it: at once, by the core. */
  fit(before: Float32Array | Float64Array, after: Float32Array | Float64Array, options?: PointFitOptions): {lattice: Lattice; report: Fit};
  /** The lattice that carries the vertices of `before` onto those of `after`, meshes or `.npy` arrays, as `ffd fit` finds it. Of two
      files with one name the later is in a folder, for messages: `after/head.obj`. */
  fit(before: MeshFile, after: MeshFile, options?: FitOptions & {weights?: 'area' | 'uniform' | `${string}.npy` | MeshFile;
    robust?: boolean; pairs?: null; handles?: false}): Promise<FitResult>;
  /** `pairs`: the table's text, a file, or the name of one of the `files` of `before`. `handles`: what is not dragged changes as little
      as possible. */
  fit(before: MeshFile | null, after: null, options: FitOptions & {pairs: string | MeshFile; handles?: boolean; robust?: boolean;
    weights?: null}): Promise<FitResult>;
  /** A page (.html) or a picture (.png), as the ending of `output` says. */
  view(mesh: MeshFile, lattice?: LatticeLike | LatticeLike[] | null, options?: Options & {output?: string; size?: string; frames?: number;
    camera?: string; color?: 'displacement' | 'status' | 'det' | 'plain'; morph?: string | string[]; animation?: string; full?: boolean; up?: 'y' | 'z' | 'x';
    noCage?: boolean}): Promise<Result>;
  /** A page in which a lattice is shaped by hand, as `ffd edit` makes it: of several lattices the last; without one a new box by `size`,
      `degree`, `knots` and `margin`. */
  edit(mesh: MeshFile, lattice?: LatticeLike | LatticeLike[] | null, options?: {output?: string; size?: Three<number> | string;
    degree?: Three<number> | string; knots?: Three<Knots> | string; margin?: number | Three<number> | string; only?: string | string[];
    outside?: 'keep' | 'extend' | 'error'; falloff?: number; snap?: number | string; space?: 'scene' | 'mesh'; set?: string[] | {[name: string]: unknown};
    time?: number; up?: 'y' | 'z' | 'x'; full?: boolean; [option: string]: unknown}): Promise<Omit<Result, 'report'>>;
}

export type WasmSource = URL | string | BufferSource | WebAssembly.Module;

/** Loads the core. Without `wasm` the package finds its own file. The module of jobs on bytes is loaded by their first call. */
export function init(options?: {wasm?: WasmSource; programWasm?: WasmSource}): Promise<Ffd>;
