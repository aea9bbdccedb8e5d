// Runs the program once: an instance of its module with files and streams, and main.

// What a caller throws with a code, as emscripten throws it.
export function attempt(FS, ERRNO_CODES, call) {
  try {
    return call();
  } catch (problem) {
    throw new FS.ErrnoError(ERRNO_CODES[problem.code] ?? ERRNO_CODES.EIO);
  }
}

// The streams of an instance, also by their names in /dev. input(bytes) -> how many it has put there; output(bytes), failure(bytes) ->
// how many they took.
function connect(FS, ERRNO_CODES, {input, output, failure}) {
  [['stdin', input], ['stdout', output], ['stderr', failure]].forEach(([name, act], fd) => {
    const call = (_, heap, offset, length) => attempt(FS, ERRNO_CODES, () => act(heap.subarray(offset, offset + length)));
    const device = FS.makedev(64, fd), path = '/dev/' + name;
    FS.registerDevice(device, {[fd === 0 ? 'read' : 'write']: call, open: (stream) => { stream.seekable = false; }});
    FS.unlink(path);
    FS.mkdev(path, 0o666, device);
    // In place of emscripten's, which take lines of text.
    FS.close(FS.getStream(fd));
    FS.open(path, fd === 0 ? 'r' : 'w');
  });
}

// prepare(FS, ERRNO_CODES) lays out files.
export async function runProgram(create, module, words, {prepare, ...streams}) {
  const program = await new Promise((resolve, reject) => create({
    thisProgram: 'ffd',
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then(done, reject);
      return {};
    },
  }).then(resolve, reject));
  const {FS, ERRNO_CODES} = program;
  connect(FS, ERRNO_CODES, streams);
  // Whoever keeps the files knows who may do what.
  FS.ignorePermissions = true;
  prepare(FS, ERRNO_CODES);
  try {
    return {FS, code: program.callMain(words)};
  } catch (problem) {
    if (!(problem instanceof WebAssembly.RuntimeError) && !(problem instanceof RangeError)) throw problem;
    streams.failure(new TextEncoder().encode(`ffd: out of memory: ${problem.message}\n`));
    return {FS, code: 7};
  }
}
