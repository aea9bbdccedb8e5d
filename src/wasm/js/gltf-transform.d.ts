import type {Document, Transform} from '@gltf-transform/core';
import type {Ffd, LatticeLike, Options} from 'ffd-mesh';

/** Deforms a document: `await document.transform(ffd({lattice, normals, only}))`. Options are those of `ffd.deform`, without
    `asMorph`, `morph`, `clip`, `output` and `rig`. `ffd`: what `init` gave; without it the package is loaded once. */
export function ffd(options: Omit<Options, 'asMorph' | 'rig'> & {lattice: LatticeLike | LatticeLike[]; ffd?: Ffd}): Transform;
