// Compares values with what is expected of them, within the rounding of the file's numbers, and keeps the worst.

import { exponentOf, powerOf } from './matrix.mjs';

const HALF = 0.5 + 1e-6;
// Of the size of the coordinates: what double arithmetic may add before the one rounding.
const DOUBLE = 1e-13;

// Half the distance to the next number of the file's kind. Quantized values may have been floats on their way:
// one in some thousands then takes the next quantum, by no more than a float's rounding beyond the half.
function roundingOf(value, step, precision) {
    if (step) return HALF * step + roundingOf(value, 0, 'float');
    const bits = precision === 'double' ? 52 : 23;
    return HALF * powerOf(Math.max(exponentOf(value), -126) - bits);
}

const SHOWN = 3;

export class Tally {
    constructor() {
        this.count = {};
        this.skipped = {};
        this.failures = [];
        this.failed = 0;
        this.worst = 0;
    }

    // What the definitions leave to rounding.
    skip(why) {
        this.skipped[why] = (this.skipped[why] ?? 0) + 1;
    }

    fail(text) {
        if (this.failed++ < SHOWN) this.failures.push(text);
    }

    // slack: the size that double rounding is measured by.
    near(kind, where, v, found, expected, step, precision, slack) {
        this.count[kind] = (this.count[kind] ?? 0) + 1;
        for (let i = 0; i < expected.length; i++) {
            const error = Math.abs(found[i] - expected[i]);
            if (error === 0) continue;
            const allowed = roundingOf(expected[i], step, precision) + DOUBLE * slack;
            this.worst = Math.max(this.worst, error / allowed);
            if (!(error <= allowed))
                return this.fail(`${kind} ${where} ${v}: found ${found}, expected ${expected} to ${allowed.toExponential(2)}`);
        }
    }

    kept(kind, where, v, found, before) {
        this.count[kind] = (this.count[kind] ?? 0) + 1;
        for (let i = 0; i < found.length; i++)
            if (!Object.is(found[i], before[i]))
                return this.fail(`${kind} ${where} ${v}: found ${found}, was ${before} and had to stay`);
    }
}

// Numbers for texts, counted from 0: equal for equal texts.
export class Numbers {
    constructor() {
        this.numbers = new Map();
    }

    of(text) {
        const known = this.numbers.get(text);
        if (known !== undefined) return known;
        this.numbers.set(text, this.numbers.size);
        return this.numbers.size - 1;
    }
}

const WIDTH = 5;
const key = new Float64Array(WIDTH), words = new Uint32Array(key.buffer);

// Numbers for places, counted from 0: equal where a kind, a placement and a position are equal, as 0 and -0 are. Millions
// of them as texts would take longer than all that is judged.
export class Places {
    constructor() {
        this.count = 0;
        this.#grow(1024);
    }

    #grow(most) {
        const { keys } = this;
        this.keys = new Float64Array(WIDTH * most);
        if (keys) this.keys.set(keys);
        // A table half full at the most: 0 or a number and 1.
        this.table = new Uint32Array(2 * most);
        for (let number = 0; number < this.count; number++) {
            key.set(this.keys.subarray(WIDTH * number, WIDTH * (number + 1)));
            this.table[this.#slot()] = number + 1;
        }
    }

    #isAt(number) {
        for (let i = 0; i < WIDTH; i++) if (!Object.is(this.keys[WIDTH * number + i], key[i])) return false;
        return true;
    }

    // Where the key is in the table, or has to go.
    #slot() {
        let hash = 0;
        for (let i = 0; i < words.length; i++) {
            hash = Math.imul(hash ^ words[i], 0x9e3779b1);
            hash ^= hash >>> 15;
        }
        const mask = this.table.length - 1;
        let slot = hash & mask;
        while (this.table[slot] && !this.#isAt(this.table[slot] - 1)) slot = (slot + 1) & mask;
        return slot;
    }

    of(kind, placement, p) {
        // 0 and -0 are equal, and so are all that is no number.
        const canonical = (x) => (x === x ? x + 0 : NaN);
        key[0] = kind;
        key[1] = placement;
        key[2] = canonical(p[0]);
        key[3] = canonical(p[1]);
        key[4] = canonical(p[2]);
        const slot = this.#slot();
        if (this.table[slot]) return this.table[slot] - 1;
        this.keys.set(key, WIDTH * this.count);
        this.table[slot] = ++this.count;
        const number = this.count - 1;
        if (this.count === this.keys.length / WIDTH) this.#grow(2 * this.count);
        return number;
    }
}

// 0 and -0 are equal positions.
const equal = (a, b) => a === b || (Number.isNaN(a) && Number.isNaN(b));

// Equal inputs have equal outputs: remembers the first output of every input, and where it is: a name and a vertex.
export class Groups {
    constructor() {
        this.outputs = [];
        this.where = [];
        this.vertex = [];
        this.failures = [];
        this.failed = 0;
        this.compared = 0;
    }

    // input: a number of its own for each input.
    add(input, output, where, v) {
        const first = this.outputs[input];
        if (!first) {
            this.outputs[input] = output;
            this.where[input] = where;
            this.vertex[input] = v;
            return;
        }
        this.compared++;
        if (equal(output[0], first[0]) && equal(output[1], first[1]) && equal(output[2], first[2])) return;
        if (this.failed++ < SHOWN)
            this.failures.push(`${this.where[input]} ${this.vertex[input]} has ${first}, ${where} ${v} has ${output}`);
    }
}
