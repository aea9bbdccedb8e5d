// Lattices and embeddings: the functions of the core on typed arrays.
import {FfdError, refuse} from './error.mjs';
import {reportOf, settingsOf} from './fit.mjs';

const KNOTS = ['default', 'clamped', 'open', 'uniform', 'closed'];
const OUTSIDE = ['keep', 'extend', 'error'];
const VOLUMES = ['rest', 'deformed'];
const FLOAT64 = 0, FLOAT32 = 1;

// The number of a word in a list.
function numberOf(words, word, name) {
  const number = words.indexOf(word);
  if (number < 0) refuse(`${name}: ${JSON.stringify(word)} is not one of ${words.join(', ')}`);
  return number;
}

// One value for each direction, of one or three.
function three(value, name) {
  const values = typeof value === 'object' && value !== null ? Array.from(value) : [value, value, value];
  if (values.length !== 3) refuse(`${name}: ${values.length} values, but there are 3 directions`);
  return values;
}

function wholes(value, name) {
  return three(value, name).map((n) => Number.isInteger(n) && n >= 0 && n < 2 ** 31 ? n : refuse(`${name}: ${n} is not a whole number`));
}

function number(value, name) {
  return typeof value === 'number' ? value : refuse(`${name}: ${String(value)} is not a number`);
}

function checkPoints(points, name) {
  if (!(points instanceof Float32Array) && !(points instanceof Float64Array))
    refuse(`${name} must be a Float32Array or a Float64Array`);
  if (points.length % 3 !== 0) refuse(`${name}: ${points.length} numbers, which is no multiple of 3`);
}

const typeOf = (points) => points instanceof Float32Array ? FLOAT32 : FLOAT64;

// The memory of the core, which moves when it grows: views of it are made anew after each call.
class Memory {
  constructor(core) {
    this.core = core;
  }

  // The blocks that `use` takes are freed at its end.
  during(use) {
    const blocks = [];
    const take = (bytes) => {
      const block = this.core._malloc(bytes || 1) >>> 0;
      if (!block) throw new FfdError(7, `ffd: out of memory for ${bytes} bytes`);
      blocks.push(block);
      return block;
    };
    const put = (array) => {
      const block = take(array.byteLength);
      this.view(array.constructor, block, array.length).set(array);
      return block;
    };
    try {
      return use(take, put);
    } finally {
      blocks.forEach((block) => this.core._free(block));
    }
  }

  view(Type, address, length) {
    return new Type(this.core.HEAPU8.buffer, address >>> 0, length);
  }

  word(address) {
    return this.view(Uint32Array, address, 1)[0];
  }

  text(address, size) {
    const bytes = this.core.HEAPU8;
    const start = address >>> 0;
    return new TextDecoder().decode(bytes.subarray(start, size === undefined ? bytes.indexOf(0, start) : start + size));
  }

  // What a call has put into memory of its own, as a new array.
  taken(Type, address, length) {
    const array = this.view(Type, address, length).slice();
    this.core._ffd_free(address);
    return array;
  }
}

// The classes of an instance of the core.
export function defineLattice(core) {
  const memory = new Memory(core);
  // `destroy` takes the address of a pointer.
  const release = (destroy, handle) => memory.during((take, put) => destroy(put(Uint32Array.of(handle))));
  // What is not freed by hand goes with the object that holds it.
  const held = new FinalizationRegistry(({destroy, handle}) => release(destroy, handle));

  function check(status) {
    if (!status) return;
    const {_ffd_wasm_error_line: line, _ffd_wasm_error_file: file, _ffd_wasm_error_pointer: pointer} = core;
    throw new FfdError(core._ffd_status_exit_code(status), memory.text(line()),
      {file: memory.text(file()), pointer: memory.text(pointer())});
  }

  // An object of C.
  class Owned {
    #handle;
    #destroy;
    constructor(handle, destroy) {
      this.#handle = handle;
      this.#destroy = destroy;
      held.register(this, {destroy, handle}, this);
    }
    get handle() {
      return this.#handle || refuse('it was freed');
    }
    free() {
      if (!this.#handle) return;
      held.unregister(this);
      release(this.#destroy, this.#handle);
      this.#handle = 0;
    }
  }

  // Calls what fills an address with a new object. Returns that.
  function make(fill) {
    return memory.during((take) => {
      const place = take(4);
      check(fill(place));
      return memory.word(place);
    });
  }

  class Embedding {
    #owned;
    #uvw;
    #status;
    constructor(handle, count) {
      this.#owned = new Owned(handle, core._ffd_embedding_destroy);
      this.count = count;
    }
    get handle() {
      return this.#owned.handle;
    }
    get uvw() {
      return this.#uvw ??= memory.view(Float64Array, core._ffd_embedding_get_uvw(this.handle), 3 * this.count).slice();
    }
    get status() {
      return this.#status ??= memory.view(Uint8Array, core._ffd_embedding_get_status(this.handle), this.count).slice();
    }
    affected(controlPoints) {
      const indices = indicesOf(controlPoints);
      return memory.during((take, put) => {
        const list = take(8);
        check(core._ffd_embedding_affected(this.handle, put(indices), indices.length, list, list + 4, core._ffd_wasm_error()));
        return memory.taken(Uint32Array, memory.word(list), memory.word(list + 4));
      });
    }
    free() {
      this.#owned.free();
    }
  }

  function indicesOf(indices) {
    const list = Array.from(indices);
    const at = list.findIndex((i) => !Number.isInteger(i) || i < 0 || i >= 2 ** 32);
    return at < 0 ? Uint32Array.from(list) : refuse(`${list[at]} is no index of a control point`);
  }

  class Lattice {
    #owned;
    constructor(handle) {
      if (typeof handle !== 'number') refuse('use Lattice.parse, .box or .around');
      this.#owned = new Owned(handle, core._ffd_lattice_destroy);
    }

    static parse(content) {
      const bytes = content instanceof Uint8Array ? Uint8Array.from(content) : new TextEncoder().encode(
        typeof content === 'string' ? content : JSON.stringify(content) ?? refuse('parse: no text and no object'));
      return new Lattice(memory.during((take, put) => {
        const start = put(bytes), name = put(new TextEncoder().encode('lattice\0'));
        return make((place) => core._ffd_lattice_parse(start, bytes.length, name, place, core._ffd_wasm_error()));
      }));
    }

    static box({min, max, size = 4, degree, knots}) {
      return Lattice.parse({
        format: 'ffd-lattice', version: 1, size: three(size, 'size'),
        ...degree !== undefined && {degree: three(degree, 'degree')},
        ...knots !== undefined && {knots: typeof knots === 'string' ? three(knots, 'knots') : knots},
        rest: {box: {min: Array.from(min ?? refuse('box: no min')), max: Array.from(max ?? refuse('box: no max'))}},
      });
    }

    static around(points, {size = 4, degree = 0, knots = 'default', margin = 0.05} = {}) {
      checkPoints(points, 'points');
      const shape = Int32Array.from([...wholes(size, 'size'), ...wholes(degree, 'degree'),
        ...three(knots, 'knots').map((word) => numberOf(KNOTS, word, 'knots'))]);
      const margins = Float64Array.from(three(margin, 'margin'), (m) => number(m, 'margin'));
      return new Lattice(memory.during((take, put) => {
        const xyz = put(Float64Array.from(points)), words = put(shape), sides = put(margins);
        return make((place) => core._ffd_wasm_around(xyz, points.length / 3, words, sides, place));
      }));
    }

    get handle() {
      return this.#owned.handle;
    }

    #shape(get) {
      return memory.during((take) => {
        const shape = take(12);
        get(this.handle, shape);
        return Array.from(memory.view(Uint32Array, shape, 3));
      });
    }

    get size() {
      return this.#shape(core._ffd_lattice_get_size);
    }

    get degree() {
      return this.#shape(core._ffd_lattice_get_degree);
    }

    points(volume = 'deformed') {
      const found = core._ffd_lattice_get_points(this.handle, numberOf(VOLUMES, volume, 'points'));
      if (!found) refuse('the box of this lattice goes round points that it was not used on yet: embed them first');
      const [nu, nv, nw] = this.size;
      return memory.view(Float64Array, found, 3 * nu * nv * nw).slice();
    }

    #set(set, indices, xyz) {
      const list = indicesOf(indices), numbers = Float64Array.from(xyz);
      if (numbers.length !== 3 * list.length) refuse(`${numbers.length} numbers for ${list.length} control points of 3`);
      memory.during((take, put) => check(set(this.handle, put(list), list.length, put(numbers), core._ffd_wasm_error())));
    }

    setPoints(indices, xyz) {
      this.#set(core._ffd_lattice_set_points, indices, xyz);
    }

    setOffsets(indices, xyz) {
      this.#set(core._ffd_lattice_set_offsets, indices, xyz);
    }

    text() {
      return memory.during((take) => {
        const text = take(8);
        check(core._ffd_lattice_text(this.handle, text, text + 4, core._ffd_wasm_error()));
        return new TextDecoder().decode(memory.taken(Uint8Array, memory.word(text), memory.word(text + 4)));
      });
    }

    embed(points, {outside = 'keep', falloff = 0, snap = 0} = {}) {
      checkPoints(points, 'points');
      const count = points.length / 3;
      return new Embedding(memory.during((take, put) => {
        const start = put(points);
        return make((place) => core._ffd_wasm_embed(this.handle, start, count, typeOf(points), numberOf(OUTSIDE, outside, 'outside'),
          number(falloff, 'falloff'), number(snap, 'snap'), place));
      }), count);
    }

    deform(embedding, points, out = new points.constructor(points.length)) {
      checkPoints(points, 'points');
      checkPoints(out, 'out');
      for (const [name, array] of [['points', points], ['out', out]])
        if (array.length !== 3 * embedding.count) refuse(`${name}: ${array.length} numbers, but ${embedding.count} points were embedded`);
      memory.during((take, put) => {
        const from = put(points), to = typeOf(out) === typeOf(points) ? from : take(out.byteLength);
        check(core._ffd_wasm_deform(embedding.handle, this.handle, from, typeOf(points), to, typeOf(out)));
        out.set(memory.view(out.constructor, to, out.length));
      });
      return out;
    }

    folds() {
      return memory.during((take) => {
        const figures = take(16);
        const verdict = core._ffd_wasm_folds(this.handle, figures);
        if (!verdict) check(memory.view(Int32Array, core._ffd_wasm_error(), 1)[0]);
        const [cells, minDet] = memory.view(Float64Array, figures, 2);
        return {verdict: memory.text(verdict), cells, minDet};
      });
    }

    free() {
      this.#owned.free();
    }
  }
  // The lattice that carries points onto others, and what is told of it.
  function fitPoints(source, target, options = {}) {
    checkPoints(source, 'before');
    checkPoints(target, 'after');
    if (source.length !== target.length) refuse(`after: ${target.length / 3} points, but there are ${source.length / 3} before`);
    const {lattice: given, box, weights, exact, choices, lengths} = settingsOf(source, options);
    const base = given instanceof Lattice ? given : given ? Lattice.parse(given) : Lattice.around(source, box);
    try {
      const lattice = new Lattice(memory.during((take, put) => {
        const places = [put(source), typeOf(source), put(target), typeOf(target), source.length / 3];
        const rows = [weights ? put(weights) : 0, put(exact), exact.length, put(choices), put(lengths(() => diagonalAtRest(base)))];
        return make((place) => core._ffd_wasm_fit(base.handle, ...places, ...rows, place));
      }));
      const report = reportOf(memory.view(Float64Array, core._ffd_wasm_fit_figures(), 64).slice(), memory.text(core._ffd_wasm_fit_chosen_by()),
        memory.text(core._ffd_wasm_fit_verdict()), choices[1] === 1);
      return {lattice, report};
    } finally {
      if (base !== given) base.free();
    }
  }

  // Of the control points.
  function diagonalAtRest(lattice) {
    const points = lattice.points('rest');
    const sides = [0, 1, 2].map((a) => {
      const along = points.filter((_, i) => i % 3 === a);
      return along.reduce((most, x) => Math.max(most, x), -Infinity) - along.reduce((least, x) => Math.min(least, x), Infinity);
    });
    return Math.hypot(...sides);
  }

  return {Lattice, fitPoints};
}
