// panel.js - the cards of the page that edits: selection, movements, the whole, files, figures.

function numberField(label, value, action) {
  const input = make('input', 'number');
  Object.assign(input, {type: 'number', step: 'any', value});
  input.setAttribute('aria-label', label);
  if (action) input.addEventListener('change', () => action(Number(input.value)));
  return input;
}

function choice(label, entries) {
  const list = make('select', '');
  list.setAttribute('aria-label', label);
  entries.forEach(([value, text]) => list.append(new Option(text, value)));
  return list;
}

// Radio buttons in one row.
function radios(name, label, entries, action) {
  const group = make('div', 'choices row');
  group.setAttribute('role', 'radiogroup');
  group.setAttribute('aria-label', label);
  for (const [value, text, hint] of entries) {
    const input = make('input');
    Object.assign(input, {type: 'radio', name, value, id: `${name}-${value}`});
    input.addEventListener('change', () => action(value));
    const line = make('label', '', input, make('span', '', text));
    line.title = hint || '';
    group.append(line);
  }
  return group;
}

// Three number fields of a row, with a word before them.
class Triple {
  constructor(label, action) {
    this.fields = AXIS_NAMES.map((axis, a) => numberField(`${label} ${axis}`, '', action ? (value) => action(a, value) : null));
    this.row = make('div', 'triple', make('span', 'quiet', label), ...this.fields);
    this.least = 0;
  }

  show(numbers) {
    this.fields.forEach((field, a) => {
      if (document.activeElement === field && field.matches(':focus') && field.dataset.typed) return;
      field.disabled = !numbers;
      // What rounding leaves of 0 is 0.
      field.value = numbers ? String(Math.abs(numbers[a]) < this.least ? 0 : Number(numbers[a].toPrecision(5))) : '';
    });
  }

  values() {
    return this.fields.map((field) => Number(field.value || 0));
  }
}

class EditPanel {
  constructor(editor) {
    this.editor = editor;
    const {edits} = editor;
    this.count = make('p', 'more count-line');
    this.count.setAttribute('role', 'status');
    this.position = new Triple('Position', (a, value) => this.setPosition(a, value));
    this.offset = new Triple('Offset', (a, value) => this.setOffset(a, value));
    this.position.least = this.offset.least = 1e-9 * edits.diagonal;
    this.cards = [this.fileCard(), this.selectionCard(), this.moveCard(), this.wholeCard(), this.figureCard()];
    this.bar = this.makeBar();
    byId('frame').append(this.bar);
    this.radiusIsOn = false;
    edits.onChange(() => this.refresh());
    this.refresh();
  }

  showCards(panel) {
    // What is not shown is told first.
    panel.prepend(...[byId('notice'), ...this.cards].filter(Boolean));
  }

  // On the picture: what is used most.
  makeBar() {
    const {editor} = this, {edits} = editor;
    this.undoButton = button('Undo', () => edits.undo());
    this.redoButton = button('Redo', () => edits.redo());
    this.undoButton.title = 'Ctrl Z';
    this.redoButton.title = 'Ctrl Y, Ctrl Shift Z';
    this.modes = radios('mode', 'Handles', [['move', 'Move', 'Arrows move (G)'], ['rotate', 'Rotate', 'Rings turn (O)'], ['scale', 'Scale', 'Arrows stretch (E)']],
      (mode) => editor.setMode(mode));
    this.boxButton = button('Box select', () => this.toggleBoxes());
    this.boxButton.setAttribute('aria-pressed', 'false');
    this.boxButton.title = 'Drag a box round control points (Q, or Ctrl + drag); Shift adds, Alt removes';
    const help = button('Help', () => this.toggleHelp());
    help.title = 'All keys (?)';
    this.message = make('p', 'edit-message');
    this.message.setAttribute('role', 'status');
    this.help = this.makeHelp();
    byId('frame').append(this.help);
    const bar = make('div', 'edit-bar', this.modes, this.boxButton, this.undoButton, this.redoButton, help, this.message);
    bar.setAttribute('role', 'toolbar');
    bar.setAttribute('aria-label', 'Edit');
    return bar;
  }

  makeHelp() {
    const rows = [['Click, Shift + click, Alt + click', 'select a control point, add it, remove it'], ['Double click on the model', 'select the point that moves that place most'],
      ['Drag a point or a handle', 'moves what is selected'], ['Box select or Ctrl + drag', 'a box of points; Shift adds, Alt removes'],
      ['Drag elsewhere, Shift + drag, wheel', 'turn, pan, come closer; with fingers: one turns, two pan and zoom'], ['N, Shift + N', 'the next point, the one before'],
      ['Space', 'keeps the point: N goes on, and adds'], ['A', 'all points, or none'], ['Shift + arrows, Shift + Page Up, Page Down', 'move the selection; X, Y or Z first: along an axis'],
      ['G, O, E', 'handles for moving, rotating, scaling'], ['[ and ]', 'a smaller, larger radius of the soft selection'], ['M', 'mirror at x, or none'], ['K, Delete', 'smooth, reset'],
      ['Ctrl Z, Ctrl Y, Ctrl S', 'undo, redo, save'], ['V, C, W, D', 'hide the cage behind the model, the cage, edges, colours'],
      ['Arrows, + and -, Home, F B L R T I', 'turn, zoom, fit, views'], ['Escape', 'ends a tool, and gives the keys to the picture']];
    const list = make('dl', 'help-keys');
    for (const [keys, what] of rows) list.append(make('dt', '', keys), make('dd', '', what));
    const dialog = make('dialog', 'help', make('h2', '', 'Tools and keys'), list, button('Close', () => dialog.close()));
    return dialog;
  }

  toggleHelp() {
    if (this.help.open) this.help.close();
    else this.help.showModal();
  }

  fileCard() {
    const {files} = this.editor, input = make('input');
    Object.assign(input, {type: 'file', accept: '.json', hidden: true});
    input.addEventListener('change', () => {
      if (input.files[0]) files.open(input.files[0]);
      input.value = '';
    });
    const save = button('Save', () => files.save(), 'main');
    save.title = 'Writes the lattice file (Ctrl S)';
    const tools = make('div', 'tools', save);
    if (window.showSaveFilePicker) tools.append(button('Save to \u2026', () => files.saveAs()));
    tools.append(button('Copy text', () => files.copy()), button('Load \u2026', () => input.click()), input);
    this.offer = make('div', 'offer');
    this.offer.hidden = true;
    const name = make('p', 'more', 'Saves ', nameElement(files.name), '. A lattice file that is dropped on the page is loaded.');
    const card = section('Lattice file', this.offer, tools, name);
    if (this.editor.scene.edit.hasMoves) card.append(make('p', 'more', 'The moves of the file are baked: what is saved has their result as offsets.'));
    return card;
  }

  selectionCard() {
    const {editor} = this, {edits} = editor, all = () => Array.from({length: edits.count}, (_, j) => j);
    const tools = make('div', 'tools', button('All', () => edits.select(all())), button('None', () => edits.select([])),
      button('Invert', () => edits.select(all().filter((j) => !edits.selected[j]))));
    const direction = choice('Direction of the layer', [['0', 'u'], ['1', 'v'], ['2', 'w']]);
    const number = numberField('Number of the layer, from 0', '0');
    number.min = 0;
    number.step = 1;
    const layerOf = () => {
      const a = Number(direction.value), [nu, nv] = edits.size, which = Number(number.value);
      const list = all().filter((j) => [j % nu, Math.floor(j / nu) % nv, Math.floor(j / (nu * nv))][a] === which);
      if (!list.length) editor.say(`There is no layer ${which} along ${'uvw'[a]}: 0 to ${edits.size[a] - 1}.`, true);
      return list;
    };
    const layer = (mode) => () => {
      const list = layerOf();
      if (list.length) edits.select(list, mode);
    };
    // Of what is selected only this layer.
    const only = (list) => {
      if (list.length) edits.select(list.filter((j) => edits.selected[j]));
    };
    const layers = make('div', 'tools', make('span', 'quiet', 'Layer'), direction, number, button('Select', layer('set')), button('Add', layer('add')),
      button('Only', () => only(layerOf())));
    const at = [0, 1, 2].map((a) => {
      const field = numberField(`Index along ${'uvw'[a]}, from 0`, '0');
      Object.assign(field, {min: 0, max: edits.size[a] - 1, step: 1});
      return field;
    });
    const one = (mode) => () => {
      const [u, v, w] = at.map((field) => Number(field.value)), wrong = [u, v, w].findIndex((x, a) => !Number.isInteger(x) || x < 0 || x >= edits.size[a]);
      if (wrong >= 0) editor.say(`There is no index ${[u, v, w][wrong]} along ${'uvw'[wrong]}: 0 to ${edits.size[wrong] - 1}.`, true);
      else edits.select([u + edits.size[0] * (v + edits.size[1] * w)], mode);
    };
    const points = make('div', 'tools', make('span', 'quiet', 'Point'), ...at, button('Select', one('set')), button('Add', one('add')));
    this.softBox = checkbox('soft', 'Soft selection, radius', false, (on) => this.setSoft(on));
    this.radius = numberField('Radius of the soft selection', String(Number((edits.diagonal / 4).toPrecision(3))), () => this.setSoft(this.radiusIsOn));
    this.radius.min = 0;
    this.softBox.append(this.radius);
    this.behindBox = checkbox('behind', 'Hide the cage behind the model', false, () => this.toggleBehind());
    return section('Selection', this.count, tools, layers, points, this.softBox, this.behindBox);
  }

  moveCard() {
    const {editor} = this, {edits} = editor;
    const by = new Triple('By'), factors = new Triple('Factor');
    by.show([0, 0, 0]);
    factors.show([1, 1, 1]);
    by.row.append(button('Move', () => editor.tryTo(() => edits.move(by.values()))));
    factors.row.append(button('Scale', () => editor.tryTo(() => edits.scale(factors.values(), editor.about()))));
    const axis = choice('Axis of the rotation', AXIS_NAMES.map((name) => [name, name])), degrees = numberField('Degrees', '15');
    this.about = choice('Turn and scale about', [['middle', 'the middle of the selection'], ['point', 'the point']]);
    this.aboutPoint = new Triple('Point', () => editor.redraw());
    this.aboutPoint.show(editor.middle);
    this.about.addEventListener('change', () => editor.redraw());
    this.lock = radios('lock', 'Along', [['-1', 'Screen', 'Points move along the screen'], ['0', 'x', 'X'], ['1', 'y', 'Y'], ['2', 'z', 'Z']], (value) => editor.setLock(Number(value), true));
    this.stepField = numberField('Step of the arrow keys', String(Number((edits.diagonal / 100).toPrecision(2))));
    const line = (...children) => make('div', 'tools', ...children);
    return section('Move', make('div', 'triple heads', make('span', ''), ...AXIS_NAMES.map((name) => make('span', 'quiet', name))), this.position.row, this.offset.row, by.row,
      line(make('span', 'quiet', 'Rotate about'), axis, degrees, button('Rotate', () => editor.tryTo(() => edits.rotate(axis.value, Number(degrees.value), editor.about())))),
      factors.row,
      line(make('span', 'quiet', 'About'), this.about), this.aboutPoint.row, make('p', 'more', 'Points that are dragged go along:'), this.lock,
      line(make('span', 'quiet', 'Shift + arrows move by'), this.stepField));
  }

  wholeCard() {
    const {editor} = this, {edits} = editor;
    this.strengthText = make('output', '', '1');
    this.strength = make('input', '');
    Object.assign(this.strength, {type: 'range', min: 0, max: 2, step: 0.01, value: 1, id: 'strength'});
    this.strength.setAttribute('aria-label', 'Strength of the whole edit');
    this.strength.addEventListener('input', () => editor.tryTo(() => edits.setStrength(Number(this.strength.value))));
    this.plane = choice('Mirror plane', [['', 'no mirror'], ['x', 'x ='], ['y', 'y ='], ['z', 'z ='], ['free', 'by point and direction']]);
    this.planeAt = numberField('Place of the mirror plane', '0');
    this.planePoint = new Triple('Through');
    this.planeNormal = new Triple('Direction');
    this.planePoint.show(editor.middle);
    this.planeNormal.show([1, 0, 0]);
    const set = () => this.setMirror();
    // The middle of the lattice is where a mirror is wanted mostly.
    this.plane.addEventListener('change', () => { this.planeAt.value = AXES[this.plane.value] ? String(editor.middle['xyz'.indexOf(this.plane.value)]) : '0'; });
    for (const input of [this.plane, this.planeAt, ...this.planePoint.fields, ...this.planeNormal.fields]) input.addEventListener('change', set);
    this.setPlaneRows();
    return section('Whole edit', make('div', 'target', make('span', '', 'Strength'), this.strength, this.strengthText),
      make('div', 'tools', make('span', 'quiet', 'Mirror'), this.plane, this.planeAt), this.planePoint.row, this.planeNormal.row,
      make('div', 'tools', button('Smooth', () => editor.tryTo(() => edits.smooth())), button('Reset', () => editor.tryTo(() => edits.reset()))),
      make('p', 'more', 'Smooth and Reset take the selected control points; without a selection all.'));
  }

  figureCard() {
    this.figures = make('dl', 'figures');
    const {edits} = this.editor, wide = `A control point of this ${edits.size.join(' \u00d7 ')} lattice moves a wide part of the model: for details begin with a finer one (ffd edit --size).`;
    const card = section('What it does', this.figures, make('p', 'more', 'As ffd deform reports them. Colour by det F shows where space shrinks, stretches or folds.'), make('p', 'more', wide));
    card.id = 'edit-figures';
    return card;
  }

  showFigures(found) {
    const rows = found ? [['Flipped faces', numberText(found.flipped), found.flipped ? 'bad' : ''], ['Torn edges', numberText(found.torn), found.torn ? 'bad' : ''],
      ['Least det F', numberText(found.minDet), found.minDet <= 0 ? 'bad' : ''], ['Vertices moved', numberText(found.moved), '']] : [['Figures', 'counting \u2026', '']];
    if (found) {
      byId('verdicts').replaceChildren(...rows.slice(0, 3).map(([label, value, kind]) => chip(kind || 'good', `${label} ${value}`)));
    }
    this.figures.replaceChildren(...rows.map(([label, value, kind]) => make('div', kind, make('dt', '', label), make('dd', '', value))));
  }

  // Tools with a state

  toggleBoxes() {
    const {tools} = this.editor;
    tools.boxes = !tools.boxes;
    this.boxButton.setAttribute('aria-pressed', String(tools.boxes));
  }

  toggleBehind() {
    const {viewer} = this.editor, input = this.behindBox.querySelector('input');
    viewer.settings.hidesBehind = !viewer.settings.hidesBehind;
    input.checked = viewer.settings.hidesBehind;
    viewer.redraw();
  }

  toggleMirror() {
    this.plane.value = this.plane.value ? '' : 'x';
    this.plane.dispatchEvent(new Event('change'));
  }

  setPlaneRows() {
    this.planeAt.hidden = !AXES[this.plane.value];
    this.planePoint.row.hidden = this.planeNormal.row.hidden = this.plane.value !== 'free';
  }

  setMirror() {
    const {value} = this.plane;
    this.setPlaneRows();
    this.editor.tryTo(() => this.editor.mirror(!value ? null : value === 'free' ? {point: this.planePoint.values(), normal: this.planeNormal.values()}
      : {axis: value, at: Number(this.planeAt.value)}));
  }

  setSoft(on) {
    this.radiusIsOn = on;
    this.editor.tryTo(() => this.editor.edits.soft(on ? Number(this.radius.value) : null));
  }

  changeRadius(factor) {
    this.radius.value = String(Number((Number(this.radius.value) * factor).toPrecision(3)));
    this.setSoft(true);
  }

  setPosition(a, value) {
    const {edits} = this.editor, center = edits.centroid();
    if (center) this.editor.tryTo(() => edits.move([0, 1, 2].map((k) => (k === a ? value - center[a] : 0))));
  }

  setOffset(a, value) {
    const {edits} = this.editor, offset = this.meanOffset();
    if (offset) this.editor.tryTo(() => edits.move([0, 1, 2].map((k) => (k === a ? value - offset[a] : 0))));
  }

  meanOffset() {
    const {edits} = this.editor, list = edits.selection();
    return list.length ? [0, 1, 2].map((a) => edits.strength * list.reduce((sum, j) => sum + edits.offsets[3 * j + a], 0) / list.length) : null;
  }

  describe(list) {
    const {edits} = this.editor, [nu, nv] = edits.size;
    if (list.length !== 1) return `${numberText(list.length)} of ${countText(edits.count, 'control point')} selected`;
    const j = list[0];
    return `Control point ${j % nu}, ${Math.floor(j / nu) % nv}, ${Math.floor(j / (nu * nv))} (number ${j})`;
  }

  refresh() {
    const {edits, files} = this.editor, list = edits.selection();
    this.count.textContent = this.describe(list);
    this.position.show(edits.centroid());
    this.offset.show(this.meanOffset());
    this.undoButton.disabled = !edits.done.length;
    this.redoButton.disabled = !edits.undone.length;
    this.strength.value = edits.strength;
    this.strengthText.textContent = numberText(edits.strength, 3);
    const soft = this.softBox.querySelector('input');
    soft.checked = edits.radius !== null;
    this.radiusIsOn = edits.radius !== null;
    if (edits.radius !== null) this.radius.value = String(edits.radius);
    this.cards[0].classList.toggle('unsaved', files.hasUnsaved());
  }

  say(text, isBad) {
    this.message.textContent = text;
    this.message.classList.toggle('bad', Boolean(isBad));
  }

  // What an earlier page left unsaved.
  showOffer(kept, restore, discard) {
    const close = (action) => () => {
      this.offer.hidden = true;
      action();
    };
    const when = new Date(kept.at);
    this.offer.replaceChildren(make('p', '', `There are unsaved changes of ${when.toLocaleString()}.`), make('div', 'tools', button('Restore', close(restore), 'main'), button('Discard', close(discard))));
    this.offer.hidden = false;
  }
}
