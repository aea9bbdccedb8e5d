// files.js - lattice files: what Save writes, what is loaded, and changes that were not saved.

const KEEP_AFTER = 400;    // milliseconds after a change until it is kept
const KEEP_WITHIN = 1200;  // at the latest
const MEMBERS = ['format', 'version', 'size', 'degree', 'knots', 'rest', 'weights', 'deformed', 'units', 'moves', 'keys', 'parameters', 'name', 'comment'];
const DEFORMED = ['points', 'offsets', 'weights', 'name', 'comment'];

// Of a number that a file has: 1e999 is none.
function isNumber(x) {
  return typeof x === 'number' && Number.isFinite(x);
}

function refuse(why) {
  throw new Error(why);
}

function triples(list, count, what) {
  if (!Array.isArray(list) || list.length !== count) refuse(`${what} has ${Array.isArray(list) ? list.length : 'no'} entries, not ${count}`);
  const numbers = new Float64Array(3 * count);
  list.forEach((triple, j) => {
    if (!Array.isArray(triple) || triple.length !== 3 || !triple.every(isNumber)) refuse(`${what}[${j}] is not three numbers`);
    numbers.set(triple, 3 * j);
  });
  return numbers;
}

function weightsOf(list, count, what) {
  if (!Array.isArray(list) || list.length !== count) refuse(`${what} has ${Array.isArray(list) ? list.length : 'no'} entries, not ${count}`);
  list.forEach((weight, j) => { if (!isNumber(weight) || !(weight > 0)) refuse(`${what}[${j}] is not above 0`); });
  return Float64Array.from(list);
}

function same(a, b) {
  if (typeof a === 'number' && typeof b === 'number') return a === b;
  if (Array.isArray(a) && Array.isArray(b)) return a.length === b.length && a.every((x, i) => same(x, b[i]));
  if (a && b && typeof a === 'object' && typeof b === 'object') {
    const keys = Object.keys(a);
    return keys.length === Object.keys(b).length && keys.every((key) => Object.hasOwn(b, key) && same(a[key], b[key]));
  }
  return a === b;
}

class LatticeFile {
  constructor(edit, cage) {
    this.file = JSON.parse(edit.file);
    this.words = {name: edit.name === null ? undefined : JSON.parse(edit.name), comment: edit.comment === null ? undefined : JSON.parse(edit.comment)};
    this.rest = cage.rest;
    this.count = cage.count;
    this.goal = edit['deformed-weight'];
    this.weights = edit.weight;
  }

  // The text of the file with these offsets: what Save writes. Moves, keys and their placeholders are in the offsets.
  text(offsets, deformedWeights) {
    const {format, version, size, degree, knots, rest, weights} = this.file, list = [];
    for (let j = 0; j < this.count; j++) list.push([offsets[3 * j], offsets[3 * j + 1], offsets[3 * j + 2]]);
    const deformed = {offsets: list};
    if (deformedWeights && this.goal && deformedWeights.some((q, j) => q !== this.weights[j])) deformed.weights = [...deformedWeights];
    // JSON has no -0: 0 is what it means.
    const whole = {format, version, ...this.words, size, degree, knots, rest, weights, deformed};
    const row = (key, value) => (Array.isArray(value) ? `"${key}": [\n      ${value.map((x) => JSON.stringify(x)).join(',\n      ')}\n    ]` : '');
    const parts = Object.entries(whole).filter(([, value]) => value !== undefined).map(([key, value]) => (key === 'deformed'
      ? `  "deformed": {\n    ${Object.entries(value).map(([name, of]) => row(name, of)).join(',\n    ')}\n  }` : `  "${key}": ${JSON.stringify(value)}`));
    return `{\n${parts.join(',\n')}\n}\n`;
  }

  // Reads a file for the same lattice at rest: its offsets and deformed weights.
  read(text) {
    let file;
    try {
      file = JSON.parse(text);
    } catch (problem) {
      refuse(`this is no JSON (${problem.message})`);
    }
    if (!file || typeof file !== 'object' || file.format !== 'ffd-lattice') refuse('this is no lattice file: its "format" is not "ffd-lattice"');
    if (file.version !== 1) refuse(`a lattice file of version ${JSON.stringify(file.version)} is not known here`);
    const unknown = Object.keys(file).find((key) => !MEMBERS.includes(key));
    if (unknown !== undefined) refuse(`"${unknown}" is no member of a lattice file`);
    for (const key of ['moves', 'keys']) {
      if (file[key] !== undefined && !(Array.isArray(file[key]) && file[key].length === 0)) refuse(`the file has "${key}", which this page does not apply: ffd edit makes a page of it`);
    }
    for (const key of ['size', 'degree', 'knots', 'rest', 'weights']) {
      if (file[key] === undefined && ['degree', 'knots', 'weights'].includes(key)) continue;
      if (!same(file[key], this.file[key])) refuse(`its "${key}" is another than that of this page: ffd edit makes a page of it`);
    }
    return this.readDeformed(file.deformed === undefined ? {} : file.deformed);
  }

  readDeformed(deformed) {
    if (!deformed || typeof deformed !== 'object' || Array.isArray(deformed)) refuse('"deformed" is no object');
    const unknown = Object.keys(deformed).find((key) => !DEFORMED.includes(key));
    if (unknown !== undefined) refuse(`"${unknown}" is no member of "deformed"`);
    if (deformed.points !== undefined && deformed.offsets !== undefined) refuse('"deformed" has points and offsets');
    const weights = deformed.weights === undefined ? null : weightsOf(deformed.weights, this.count, 'deformed.weights');
    if (weights && !this.weights) refuse('it has weights, and the lattice of this page has none');
    if (deformed.points !== undefined) return {weights, offsets: triples(deformed.points, this.count, 'deformed.points').map((x, i) => x - this.rest[i])};
    return {weights, offsets: deformed.offsets === undefined ? new Float64Array(3 * this.count) : triples(deformed.offsets, this.count, 'deformed.offsets')};
  }
}

class Files {
  constructor(editor, scene) {
    this.editor = editor;
    this.lattice = new LatticeFile(scene.edit, scene.cages[scene.edit.cage]);
    const stem = (name) => name.replace(/\.[^.]*$/, '');
    this.name = `${scene.edit.isNew ? stem(scene.name) + '-lattice' : stem(scene.cages[scene.edit.cage].name) || 'lattice'}.json`.replace(/[^\w .-]/g, '_');
    this.key = `ffd-edit ${scene.edit.key} ${this.hashOf(scene.edit.offset)}`;
    this.handle = null;
    this.timer = 0;
    this.since = 0;
  }

  // Of the offsets with which the page began.
  hashOf(numbers) {
    let hash = 0x811c9dc5;
    for (const byte of new Uint8Array(numbers.slice().buffer)) hash = Math.imul(hash ^ byte, 0x01000193);
    return (hash >>> 0).toString(16);
  }

  text() {
    const {edits, shown} = this.editor;
    return this.lattice.text(edits.shownOffsets().map((x) => x + 0), shown.volume.deformed);
  }

  load(text) {
    const {edits, shown} = this.editor, {offsets, weights} = this.lattice.read(text);
    if (weights) {
      shown.volume.goal = weights;
      this.lattice.goal = weights;
    }
    edits.setStrength(1);
    edits.take(offsets);
  }

  // Writes into the file that was chosen, else as a download.
  async save() {
    const text = this.text();
    try {
      if (this.handle) {
        const file = await this.handle.createWritable();
        await file.write(text);
        await file.close();
      } else this.download(text);
    } catch (problem) {
      this.editor.say(`Not saved: ${problem.message}`, true);
      return;
    }
    this.editor.edits.saved = this.editor.edits.done.length;
    this.savedStrength = this.editor.edits.strength;
    this.forget();
    this.editor.panel.refresh();
    this.editor.say(`Saved as ${this.handle ? this.handle.name : this.name}.`);
  }

  download(text) {
    const link = make('a', ''), url = URL.createObjectURL(new Blob([text], {type: 'application/json'}));
    link.href = url;
    link.download = this.name;
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }

  // Where the browser can write files, the one that Save writes from now on.
  async saveAs() {
    try {
      this.handle = await window.showSaveFilePicker({suggestedName: this.name, types: [{description: 'Lattice', accept: {'application/json': ['.json']}}]});
    } catch (problem) {
      return;  // nothing was chosen
    }
    await this.save();
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.text());
      this.editor.say('Copied: the text of the lattice file.');
    } catch (problem) {
      this.editor.say('The browser does not let this page copy: Save gives the same text.', true);
    }
  }

  async open(file) {
    try {
      this.load(await file.text());
      this.editor.say(`Loaded ${file.name}.`);
    } catch (problem) {
      this.editor.say(`${file.name} is not loaded: ${problem.message}.`, true);
    }
  }

  hasUnsaved() {
    const {edits} = this.editor;
    return edits.saved !== edits.done.length || (this.savedStrength === undefined ? 1 : this.savedStrength) !== edits.strength;
  }

  // Keeps what is not saved, a little after the last change.
  changed() {
    const now = performance.now();
    this.since = this.since || now;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.keep(), Math.max(0, Math.min(KEEP_AFTER, this.since + KEEP_WITHIN - now)));
  }

  keep() {
    clearTimeout(this.timer);
    this.since = 0;
    if (this.offered) return;  // what was kept before waits for an answer
    try {
      if (this.hasUnsaved()) localStorage.setItem(this.key, JSON.stringify({at: Date.now(), text: this.text()}));
      else localStorage.removeItem(this.key);
    } catch (problem) {
      this.editor.say('The browser does not keep unsaved changes: use Save.', true);
    }
  }

  forget() {
    clearTimeout(this.timer);
    this.since = 0;
    this.offered = false;
    try {
      localStorage.removeItem(this.key);
    } catch (problem) {
      return;
    }
  }

  // What an earlier page left; null: nothing that is another than what is shown.
  kept() {
    try {
      const kept = JSON.parse(localStorage.getItem(this.key) || 'null');
      if (!kept || kept.text === this.text()) return null;
      this.lattice.read(kept.text);
      return kept;
    } catch (problem) {
      return null;
    }
  }

  restore(kept) {
    this.offered = false;
    this.load(kept.text);
    this.keep();
  }
}
