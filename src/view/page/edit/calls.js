// calls.js - the editor: joins edits, shape, tools and files; and the calls for scripts, globalThis.ffdPage.

const FRAME = 8;         // milliseconds of figures between two pictures
const SLOW_NORMALS = 12; // milliseconds: from here on normals wait until the drag ends
const REST = 120;        // milliseconds without a change until what waits is done

// Paints whose values follow the edit.
function editPaints(scene, figures) {
  const values = new Float32Array(scene.vertices);
  const plain = scene.paintsOfFile.filter(({key}) => key !== 'displacement');
  return [...plain.filter(({key}) => key === 'plain'), {key: 'displacement', label: 'Displacement', mode: 1, values, ramp: makeRamp(SEQUENTIAL), stops: SEQUENTIAL, range: [0, 0]},
    ...plain.filter(({key}) => key === 'status'), {key: 'det', label: 'det F', mode: 2, values: figures.dets, ramp: makeRamp(DIVERGING), stops: DIVERGING, range: [-1, 1], span: 1}];
}

class Editor {
  constructor(viewer) {
    const {scene} = viewer, {edit} = scene, cage = scene.cages[edit.cage];
    this.viewer = viewer;
    this.scene = scene;
    this.shown = new Shown(scene);
    this.figures = new Figures(this.shown);
    this.edits = new Edits(cage.rest, cage.size, cage.closed, edit.offset);
    this.measure(cage.rest);
    scene.statuses = Uint8Array.from(edit.kind.subarray(0, scene.vertices), (of) => (of === INSIDE ? 0 : 1));
    scene.paintsOfFile = listPaints(scene);
    viewer.paints = editPaints(scene, this.figures);
    viewer.paint = viewer.paints[0];
    this.files = new Files(this, scene);
    this.shown.update(this.edits.offsets, null);
    this.edits.onChange((flags) => this.changed(flags));
  }

  measure(rest) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    rest.forEach((x, i) => {
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    });
    this.middle = low.map((x, a) => (x + high[a]) / 2);
    this.edits.diagonal = Math.hypot(...low.map((x, a) => high[a] - x));
  }

  // Once the page has its picture, or without one.
  begin() {
    const {viewer} = this;
    if (viewer.renderer) {
      this.tools = new Tools(viewer, this);
      viewer.tools = this.tools;
      this.panel = new EditPanel(this);
      this.tools.addKeys();
      const draw = viewer.renderer.draw.bind(viewer.renderer);
      viewer.renderer.draw = (state) => {
        draw({...state, tools: [...this.marks(), ...this.tools.placeHandles()]});
        if (this.turnCompass) this.turnCompass();
      };
      showPanel(viewer);
      this.setMode('move');
      this.setLock(-1, true);
      viewer.setPaint(viewer.paints[0]);
      this.draw(true);
      this.addDrop();
      byId('keys').textContent = 'Click a control point, Shift + click adds one; drag it, or the handles. Drag elsewhere to turn, Shift + drag to pan, wheel to come closer. Keys: N next point, Space keeps it, Shift + arrows move, X Y Z along an axis, M mirror, [ ] soft radius, Ctrl Z, Ctrl S, Escape back to the picture, ? all keys.';
      this.addCompass();
      // Views and Fit take in what the cage has become.
      const look = viewer.look.bind(viewer);
      viewer.look = (name) => {
        viewer.camera.hold(listFitPoints(this.scene));
        look(name);
      };
    }
    this.offerKept();
    window.addEventListener('pagehide', () => this.files.keep());
    document.addEventListener('visibilitychange', () => { if (document.hidden) this.files.keep(); });
    window.addEventListener('beforeunload', () => this.files.keep());
    this.later();
  }

  say(text, isBad) {
    if (this.panel) this.panel.say(text, isBad);
  }

  // What is refused is said.
  tryTo(action) {
    try {
      action();
    } catch (problem) {
      this.say(problem.message, true);
    }
  }

  // flags: of the control points that changed; null: all did.
  changed(flags) {
    const {edits, shown, scene} = this, isAll = flags === null;
    if (isAll) shown.volume.setStrength(edits.strength);
    const isMoved = isAll || flags.some((flag) => flag);
    if (isMoved) {
      shown.update(edits.offsets, flags);
      this.figures.clear();
      const cage = scene.cages[scene.edit.cage];
      for (let i = 0; i < cage.deformed.length; i++) cage.deformed[i] = cage.rest[i] + edits.strength * edits.offsets[i];
      this.files.changed();
    }
    this.draw(isMoved);
  }

  redraw() {
    this.viewer.redraw();
  }

  // Shows the shape; what takes longer than a picture follows.
  draw(isMoved) {
    const {viewer} = this;
    if (!viewer.renderer) return;
    if (isMoved) {
      viewer.markCages();
      const began = performance.now(), quick = !(this.normalTime > SLOW_NORMALS);
      viewer.renderer.updateMove(quick);
      if (quick) this.normalTime = performance.now() - began;
      this.normalsWait = !quick;
      if (viewer.settings.blend !== 1) viewer.setBlend(1);
      this.later();
    }
    this.redraw();
  }

  // The selected control points, and those that go along.
  marks() {
    const {viewer, edits} = this, selected = [], soft = [];
    const shares = edits.shares();
    shares.forEach((share, j) => {
      if (share > 0) (edits.selected[j] ? selected : soft).push(...toPicture(this.scene, edits.point(j)), 0, 0, 0);
    });
    viewer.renderer.setMarks('selectedPoints', selected, 6);
    const images = edits.imagesOf(shares).flatMap((j) => [...toPicture(this.scene, edits.point(j)), 0, 0, 0]);
    viewer.renderer.setMarks('softPoints', soft, 6);
    viewer.renderer.setMarks('imagePoints', images, 6);
    return [{name: 'imagePoints', isLine: false, size: 10, color: [0.1, 0.75, 0.7, 1], hiddenShare: 0.7}, {name: 'softPoints', isLine: false, size: 9, color: [1, 0.55, 0.15, 1], hiddenShare: 0.6}, {name: 'selectedPoints', isLine: false, size: 11, color: [1, 0.78, 0.1, 1], hiddenShare: 0.8}];
  }

  // Figures, and normals that waited: a little for each picture.
  later() {
    if (this.waits) return;
    this.waits = true;
    const step = () => {
      const {viewer} = this;
      if (this.figures.work(FRAME)) {
        this.waits = false;
        this.showFigures();
        if (this.normalsWait) this.restTimer();
        return;
      }
      if (viewer.renderer) requestAnimationFrame(step);
      else setTimeout(step, 0);
    };
    requestAnimationFrame(step);
  }

  restTimer() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => {
      if (!this.normalsWait || !this.viewer.renderer) return;
      this.normalsWait = false;
      this.viewer.renderer.updateMove(true);
      this.redraw();
    }, REST);
  }

  showFigures() {
    const {viewer, scene, figures, shown} = this, {found} = figures;
    if (!viewer.renderer) return;
    scene.flipped = figures.flags;
    scene.tears = figures.torn.map(({still, other, step}) => ({step, ends: [still, other].map((v) => ({number: vertexNumber(scene, v), vertex: v,
      before: vertexBefore(scene, v), after: [0, 1, 2].map((a) => shown.shown(v, a))}))}));
    scene.tearEdges = scene.tears.length;
    scene.flippedFaces = found.flipped;
    this.refreshPaint();
    viewer.partsChanged();
    this.panel.showFigures(found);
  }

  refreshPaint() {
    const {viewer, scene, figures} = this, {paint} = viewer;
    if (paint.key === 'det') {
      paint.span = detSpan(figures.dets);
      paint.range = [-paint.span, paint.span];
    }
    if (paint.key === 'displacement') {
      for (let v = 0; v < scene.vertices; v++) {
        paint.values[v] = scene.space.scale * Math.hypot(scene.move[3 * v], scene.move[3 * v + 1], scene.move[3 * v + 2]);
        paint.range[1] = v === 0 ? paint.values[0] : Math.max(paint.range[1], paint.values[v]);
      }
    }
    if (paint.values) viewer.setPaint(paint);
  }

  // Tools

  about() {
    return this.panel && this.panel.about.value === 'point' ? this.panel.aboutPoint.values() : undefined;
  }

  step() {
    return Number(this.panel.stepField.value) || 0;
  }

  selectAll() {
    const {edits} = this, all = edits.selected.every((is) => is);
    edits.select(all ? [] : Array.from({length: edits.count}, (_, j) => j));
  }

  setMode(mode) {
    this.tools.mode = mode;
    byId('mode-' + mode).checked = true;
    this.redraw();
  }

  // The same axis again is none.
  setLock(axis, isExact) {
    this.tools.lock = !isExact && this.tools.lock === axis ? -1 : axis;
    byId('lock-' + this.tools.lock).checked = true;
    this.redraw();
  }

  mirror(plane) {
    const without = this.edits.mirror(plane);
    if (!plane) return;
    const {axis} = plane, middle = AXES[axis] ? ` (the middle of the lattice is ${axis} = ${numberText(this.middle['xyz'.indexOf(axis)], 6)})` : '';
    this.say(without ? `${countText(without, 'control point')} ${without === 1 ? 'has' : 'have'} no mirror image there, and ${without === 1 ? 'moves' : 'move'} alone${middle}.`
      : 'Mirror: each control point has its image, which goes along.', without > 0);
  }

  // A drag shows changes of what was there when it began; its end is one step.
  beginDrag() {
    const {edits} = this, base = edits.offsets.slice();
    let dragged = [];
    const set = (changesOf) => {
      edits.offsets.set(base);
      const after = edits.offsetsAfter(changesOf(), base);
      return after;
    };
    const show = ({indices, values}) => {
      const flags = new Uint8Array(edits.count);
      for (const j of dragged) flags[j] = 1;
      indices.forEach((j, n) => {
        flags[j] = 1;
        for (let a = 0; a < 3; a++) edits.offsets[3 * j + a] = values[3 * n + a];
      });
      dragged = indices;
      edits.tell(flags);
    };
    const cancel = () => {
      if (!dragged.length) return;
      edits.offsets.set(base);
      show({indices: [], values: []});
    };
    return {
      show: (changesOf) => this.tryTo(() => show(set(changesOf))),
      cancel,
      end: (changesOf) => this.tryTo(() => {
        const after = set(changesOf);
        edits.commit(after, base);
      }),
    };
  }

  // The axes of the model, as the camera sees them.
  addCompass() {
    const svg = (tag, values) => {
      const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
      Object.entries(values).forEach(([key, value]) => element.setAttribute(key, value));
      return element;
    };
    const box = svg('svg', {viewBox: '-40 -40 80 80', class: 'compass', 'aria-hidden': 'true'});
    const rows = AXIS_NAMES.map((name, a) => {
      const color = `rgb(${AXIS_COLORS[a].slice(0, 3).map((x) => Math.round(255 * x))})`;
      const line = svg('line', {x1: 0, y1: 0, stroke: color, 'stroke-width': 2.5}), text = svg('text', {fill: color, 'text-anchor': 'middle', 'dominant-baseline': 'central', 'font-size': 13});
      text.textContent = name;
      box.append(line, text);
      return {line, text, a};
    });
    byId('frame').append(box);
    this.turnCompass = () => {
      const {right, up} = this.viewer.camera.axes();
      for (const {line, text, a} of rows) {
        const x = 24 * right[a], y = -24 * up[a];
        line.setAttribute('x2', x);
        line.setAttribute('y2', y);
        text.setAttribute('x', 1.42 * x);
        text.setAttribute('y', 1.42 * y);
      }
    };
  }

  addDrop() {
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      const file = event.dataTransfer.files[0];
      if (file) this.files.open(file);
    });
  }

  offerKept() {
    const kept = this.files.kept();
    if (!kept || !this.panel) return;
    this.files.offered = true;
    this.panel.showOffer(kept, () => this.tryTo(() => this.files.restore(kept)), () => this.files.forget());
  }

  // Calls

  // Vertices of the page in the order of `ffd embed`.
  order() {
    if (this.sorted) return this.sorted;
    const {scene} = this, list = Uint32Array.from({length: scene.vertices}, (_, v) => v);
    this.sorted = scene.numbers ? list.sort((a, b) => scene.numbers[a] - scene.numbers[b]) : list;
    return this.sorted;
  }

  positions() {
    const {shown} = this, out = new Float32Array(3 * this.scene.vertices);
    this.order().forEach((v, i) => { for (let a = 0; a < 3; a++) out[3 * i + a] = shown.shown(v, a); });
    return out;
  }

  calls() {
    const {edits, files} = this;
    return {
      select: (indices, mode) => edits.select(indices, mode),
      selection: () => edits.selection(),
      soft: (radius) => edits.soft(radius),
      mirror: (plane) => this.mirror(plane),
      strength: (share) => edits.setStrength(share),
      move: (vector) => edits.move(vector),
      rotate: (axis, degrees, about) => edits.rotate(axis, degrees, about),
      scale: (factor, about) => edits.scale(factor, about),
      smooth: () => edits.smooth(),
      undo: () => edits.undo(),
      redo: () => edits.redo(),
      reset: () => edits.reset(),
      positions: () => this.positions(),
      vertices: () => Uint32Array.from(this.order(), (v) => vertexNumber(this.scene, v)),
      offsets: () => edits.shownOffsets(),
      lattice: () => files.text(),
      load: (text) => files.load(text),
      figures: () => ({...this.figures.all()}),
    };
  }
}

extensions.push((viewer) => {
  const editor = new Editor(viewer);
  editor.begin();
  globalThis.ffdPage = {...editor.calls(), ready: Promise.resolve()};
});
