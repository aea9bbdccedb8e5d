// Compares values with what is expected of them, within the rounding of the file's numbers, and keeps the worst.

const HALF = 0.5 + 1e-6;
// Of the size of the coordinates: what double arithmetic may add before the one rounding.
const DOUBLE = 1e-13;

// Half the distance to the next number of the file's kind. Quantized values may have been floats on their way:
// one in some thousands then takes the next quantum, by no more than a float's rounding beyond the half.
function roundingOf(value, step, precision) {
    if (step) return HALF * step + roundingOf(value, 0, 'float');
    const bits = precision === 'double' ? 52 : 23;
    const exponent = Math.max(Math.floor(Math.log2(Math.abs(value) || Number.MIN_VALUE)), -126);
    return HALF * 2 ** (exponent - bits);
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
    near(kind, where, found, expected, { step = 0, precision = 'float', slack }) {
        this.count[kind] = (this.count[kind] ?? 0) + 1;
        for (let i = 0; i < expected.length; i++) {
            const allowed = roundingOf(expected[i], step, precision) + DOUBLE * slack;
            const error = Math.abs(found[i] - expected[i]);
            this.worst = Math.max(this.worst, error / allowed);
            if (!(error <= allowed))
                return this.fail(`${kind} ${where}: found ${found}, expected ${expected} to ${allowed.toExponential(2)}`);
        }
    }

    kept(kind, where, found, before) {
        this.count[kind] = (this.count[kind] ?? 0) + 1;
        if (!before.every((value, i) => Object.is(found[i], value)))
            this.fail(`${kind} ${where}: found ${found}, was ${before} and had to stay`);
    }
}

// 0 and -0 are equal positions.
const equal = (a, b) => a === b || (Number.isNaN(a) && Number.isNaN(b));

// Equal inputs have equal outputs: remembers the first output of every input.
export class Groups {
    constructor() {
        this.outputs = new Map();
        this.failures = [];
        this.failed = 0;
        this.compared = 0;
    }

    add(key, output, where) {
        const first = this.outputs.get(key);
        if (!first) return void this.outputs.set(key, { output, where });
        this.compared++;
        if (!output.every((x, i) => equal(x, first.output[i])) && this.failed++ < SHOWN)
            this.failures.push(`${key}: ${first.where} has ${first.output}, ${where} has ${output}`);
    }
}
