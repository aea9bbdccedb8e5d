// The error of all calls.
export class FfdError extends Error {
  // code: the exit code of the program `ffd`; line: what it prints
  constructor(code, line, {file, pointer} = {}) {
    super(line);
    this.name = 'FfdError';
    this.code = code;
    if (file) this.file = file;
    if (pointer) this.pointer = pointer;
  }
}

// What a caller did wrong.
export function refuse(what) {
  throw new FfdError(2, 'ffd: ' + what);
}
