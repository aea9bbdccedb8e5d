// Jobs on bytes: the program, once for each job, with files in memory.
import {FfdError, refuse} from './error.mjs';
import {runProgram} from './run.mjs';

const IN = '/in', OUT = '/out';

// Options that are about the files of a machine, or that a job sets itself.
const OWN = ['report', 'outDir', 'inPlace', 'force', 'ifChanged', 'dryRun', 'depfile', 'lattice', 'help'];

// Options with a value for each direction, which the program takes as one word: {size: [8, 4, 4]} is --size 8,4,4.
const DIRECTED = ['size', 'degree', 'knots', 'margin'];

// What a fit tells of its work and of its result, among the warnings.
const TOLD = /^ffd: fit: \d+ (%|pairs, residual )/;

const toBytes = (content, name) => content instanceof Uint8Array ? content
  : content instanceof ArrayBuffer ? new Uint8Array(content)
    : ArrayBuffer.isView(content) ? new Uint8Array(content.buffer, content.byteOffset, content.byteLength)
      : typeof content === 'string' ? new TextEncoder().encode(content)
        : refuse(`${name}: no bytes`);

// A name below a folder, as models name their files.
function checkName(name) {
  if (typeof name !== 'string' || !name.split('/').every((part) => part && part !== '.' && part !== '..'))
    refuse(`${JSON.stringify(name)} is no relative name of a file`);
  return name;
}

// The words of options, as `ffd` takes them: {asMorph: 'a', failOn: ['folds']} is --as-morph a --fail-on folds.
function wordsOf(options, allowed = []) {
  const words = [];
  for (const [name, value] of Object.entries(options)) {
    if (OWN.includes(name) && !allowed.includes(name)) refuse(`the option ${name} is for the program's files`);
    if (name === 'resources' && value !== 'copy') refuse(`resources: "${value}" is for the program's files`);
    const option = '--' + name.replace(/[A-Z]/g, (letter) => '-' + letter.toLowerCase());
    const values = name === 'set' && !Array.isArray(value) && typeof value === 'object' && value
      ? Object.entries(value).map(([key, one]) => `${key}=${typeof one === 'string' ? one : JSON.stringify(one)}`)
      : !Array.isArray(value) ? [value] : DIRECTED.includes(name) ? [value.join()] : value;
    for (const one of values)
      if (one === true) words.push(option);
      else if (one !== false && one !== undefined && one !== null) words.push(option, String(one));
  }
  return words;
}

// Puts a file of a job, and those that it names, among the given ones: into a folder where one of them has a name that is taken.
// Returns its name for the program, which takes a dash for an option.
function place(given, {name, bytes, files = {}}, folder) {
  const own = [...Object.entries(files), [name, bytes]].map(([path, content]) => [checkName(path), toBytes(content, path)]);
  const isBelow = (path, other) => `${path}/`.startsWith(`${other}/`);
  const isTaken = (path) => [...given.keys()].some((other) => isBelow(path, other) || isBelow(other, path));
  let start = '';
  if (own.some(([path]) => isTaken(path))) {
    while (isTaken(folder)) folder += '_';
    start = folder + '/';
  }
  for (const [path, content] of own) given.set(start + path, content);
  return (start + name).replace(/^-/, './-');
}

function makeFolders(FS, path) {
  const parts = path.split('/').slice(1, -1);
  parts.reduce((folder, part) => {
    const next = folder + '/' + part;
    if (!FS.analyzePath(next).exists) FS.mkdir(next);
    return next;
  }, '');
}

function writeAll(FS, files) {
  for (const [path, bytes] of files) {
    makeFolders(FS, path);
    FS.writeFile(path, bytes);
  }
}

// All files of a folder but those that a map names, by their names in it.
function readAll(FS, folder, known = new Map(), found = {}, prefix = '') {
  for (const name of FS.readdir(folder)) {
    const path = `${folder}/${name}`;
    if (name === '.' || name === '..') continue;
    if (FS.isDir(FS.stat(path).mode)) readAll(FS, path, known, found, prefix + name + '/');
    else if (!known.has(prefix + name)) found[prefix + name] = FS.readFile(path);
  }
  return found;
}

// Takes what is written to a stream.
function gatherer() {
  const pieces = [];
  const take = (bytes) => {
    pieces.push(bytes.slice());
    return bytes.length;
  };
  take.text = () => pieces.reduce(([text, decoder], piece) => [text + decoder.decode(piece, {stream: true}), decoder],
    ['', new TextDecoder()])[0];
  return take;
}

// The report, with the names that the caller gave or gets.
function reportOf(text) {
  const name = (path) => path?.replace(/^\/(in|out)\//, '');
  const report = JSON.parse(text);
  for (const job of report.jobs) Object.assign(job, {input: name(job.input), output: name(job.output), outputs: job.outputs.map(name)});
  return report;
}

const warningsOf = (lines) => lines.filter((line) => line && !TOLD.test(line));

// The error in what the program has said, whose last line tells why it failed.
function failureOf(code, said, names, report) {
  const lines = said.trimEnd().split('\n');
  const line = lines.pop() || 'ffd: it failed without a word';
  const file = names.filter((name) => line.startsWith(`ffd: ${name}:`)).sort((a, b) => b.length - a.length)[0];
  const behind = file === undefined ? '' : line.slice(`ffd: ${file}:`.length);
  const pointer = /^(?:\d+:)? ?(\/.*?): /.exec(behind)?.[1];
  return Object.assign(new FfdError(code, line, {file, pointer}), {warnings: warningsOf(lines)}, report && {report});
}

// The file of a Lattice, of whatever instance, of an object, of a text, or its bytes.
const fileOf = (lattice) => toBytes(typeof lattice === 'string' || lattice instanceof Uint8Array ? lattice
  : typeof lattice.text === 'function' ? lattice.text() : JSON.stringify(lattice), 'lattice');

// The functions of an instance. getModule() -> the program's module.
export function defineJobs(createProgram, getModule) {
  // Names of lattices for messages, which no file of the mesh has.
  function nameLattices(lattices, taken) {
    const named = new Map();
    lattices.forEach((lattice, i) => {
      let name = lattices.length > 1 ? `lattice ${i + 1}` : 'lattice';
      while (taken.has(name)) name += '_';
      named.set(name, fileOf(lattice));
    });
    return named;
  }

  // words(mesh, lattices, others) -> those of the command. mesh: null where a job has none. others: more files, each by the folder
  // for a name that is taken, or a list; what is no file stays, as the name of one of the mesh's.
  async function run(mesh, lattice, words, others = {}) {
    const given = new Map(), name = mesh && place(given, mesh);
    const add = (file, folder) => Array.isArray(file) ? file.map((one) => add(one, folder))
      : typeof file === 'object' && file ? place(given, file, folder) : file;
    const names = Object.fromEntries(Object.entries(others).map(([folder, file]) => [folder, add(file, folder)]));
    const lattices = nameLattices(lattice === undefined || lattice === null ? [] : Array.isArray(lattice) ? lattice : [lattice], given);
    const said = gatherer(), printed = gatherer();
    const {FS, code} = await runProgram(createProgram, await getModule(),
      words(name, [...lattices.keys()].flatMap((file) => ['-l', file]), names), {
        input: () => 0,
        output: printed,
        failure: said,
        prepare(FS) {
          makeFolders(FS, `${OUT}/${mesh ? mesh.name : ''}`);
          FS.mkdir(IN);
          writeAll(FS, [...given, ...lattices].map(([file, content]) => [`${IN}/${file}`, content]));
          FS.chdir(IN);
        },
      });
    const all = {...readAll(FS, IN, new Map([...given, ...lattices])), ...readAll(FS, OUT)};
    const report = FS.analyzePath('/report.json').exists ? reportOf(FS.readFile('/report.json', {encoding: 'utf8'})) : undefined;
    if (code) throw failureOf(code, said.text(), [...given.keys(), ...lattices.keys()], report);
    return {files: all, report, text: printed.text(), warnings: warningsOf(said.text().split('\n'))};
  }

  // A result whose main file is called `name`.
  function resultOf({files, report, warnings}, name) {
    const {[name]: bytes, ...others} = files;
    return {name, bytes, files: others, report, warnings};
  }

  const REPORT = ['--report', '/report.json'];
  return {
    async deform(mesh, lattice, {output = mesh.name, ...options} = {}) {
      const done = await run(mesh, lattice, (name, lattices) =>
        ['deform', name, `${OUT}/${checkName(output)}`, ...lattices, ...REPORT, ...wordsOf(options)]);
      return resultOf(done, output);
    },
    async check(mesh, lattice, options = {}) {
      const {files, report, warnings} = await run(mesh, lattice, (name, lattices) =>
        ['check', name, ...lattices, ...REPORT, ...wordsOf(options)]);
      return {files, report, warnings};
    },
    async info(file, options = {}) {
      const {text} = await run(file, [], (name) => ['info', name, '--json', ...wordsOf(options)]);
      return JSON.parse(text);
    },
    async convertLattice(file, {output, ...options} = {}) {
      if (output === undefined) refuse('convertLattice: no output, whose ending is the format');
      const done = await run(file, [], (name) => ['lattice', 'convert', name, '-o', `${OUT}/${checkName(output)}`, ...wordsOf(options)]);
      const {report, ...result} = resultOf(done, output);
      return result;
    },
    async fit(before, after, {output = 'fit.json', lattice, pairs, cover, weights, ...options} = {}) {
      if (after && !before) refuse('fit: AFTER without BEFORE');
      // A table has a row below its first, so that a text of it is told from a name.
      const table = typeof pairs === 'string' && pairs.includes('\n') ? {name: 'pairs.csv', bytes: pairs} : pairs;
      const done = await run(before ?? null, lattice, (name, lattices, {after: second, ...named}) =>
        ['fit', ...[name, second].filter(Boolean), '-o', `${OUT}/${checkName(output)}`, ...lattices, ...REPORT,
          ...wordsOf({...options, ...named})], {after, pairs: table, cover, weights});
      return {...resultOf(done, output), fit: done.report.jobs[0].fit};
    },
    async edit(mesh, lattice, {output = mesh.name + '.html', ...options} = {}) {
      const done = await run(mesh, lattice, (name, lattices) =>
        ['edit', name, ...lattices, '-o', `${OUT}/${checkName(output)}`, ...wordsOf(options)]);
      const {report, ...result} = resultOf(done, output);
      return result;
    },
    async view(mesh, lattice, {output = mesh.name + '.html', ...options} = {}) {
      const done = await run(mesh, lattice, (name, lattices) =>
        ['view', name, ...lattices, '-o', `${OUT}/${checkName(output)}`, ...lattices.length > 0 ? REPORT : [], ...wordsOf(options)]);
      return resultOf(done, output);
    },
  };
}
