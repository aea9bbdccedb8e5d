// Free-form deformation of meshes with B-spline lattices, in WebAssembly.
import createCore from './core.mjs';
import {FfdError} from './error.mjs';
import {defineJobs} from './jobs.mjs';
import {defineLattice} from './lattice.mjs';
import {loadFile, readUrl} from './load.mjs';
import createProgram from './program.mjs';

export {FfdError};

// A module from what a caller gives, or from the package's own file.
async function moduleOf(given, name) {
  if (given instanceof WebAssembly.Module) return given;
  const bytes = given === undefined ? await loadFile(name)
    : given instanceof URL || typeof given === 'string' ? await readUrl(new URL(given, globalThis.location?.href)) : given;
  return WebAssembly.compile(bytes);
}

// wasm, programWasm: URL, BufferSource or WebAssembly.Module; the program's is loaded by the first call that needs it.
export async function init({wasm, programWasm} = {}) {
  const module = await moduleOf(wasm, 'core.wasm');
  const core = await new Promise((resolve, reject) => createCore({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then(done, reject);
      return {};
    },
  }).then(resolve, reject));
  let program;
  const getProgram = () => program ??= moduleOf(programWasm, 'program.wasm').catch((problem) => { program = undefined; throw problem; });
  const {Lattice, fitPoints} = defineLattice(core), jobs = defineJobs(createProgram, getProgram);
  return {
    Lattice, FfdError, ...jobs,
    // Of points in memory it is done at once, of files by the program.
    fit(before, after, options) {
      return ArrayBuffer.isView(before) || ArrayBuffer.isView(after) ? fitPoints(before, after, options)
        : jobs.fit(before, after, options).then((done) => ({lattice: Lattice.parse(done.bytes), ...done}));
    },
  };
}
