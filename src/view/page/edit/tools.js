// tools.js - pointer and keys of the page that edits: picks, boxes, drags of points and handles.

const MODES = ['move', 'rotate', 'scale'];
const BOX_ID = 'select-box';
const CONTROL_GRAB = {mouse: CONTROL_PIXELS, pen: 12, touch: 22};

class Tools {
  constructor(viewer, editor) {
    this.viewer = viewer;
    this.editor = editor;
    this.mode = 'move';
    this.lock = -1;
    this.boxes = false;
    this.handles = [];
    this.kept = [];
    this.frame = make('div', 'select-box');
    this.frame.id = BOX_ID;
    this.frame.hidden = true;
    byId('frame').append(this.frame);
  }

  // The edited control points on the screen. Those behind the mesh are left out where the cage hides them.
  * points() {
    const {viewer, editor: {edits}} = this, {scene} = viewer;
    for (let j = 0; j < edits.count; j++) {
      const point = toPicture(scene, edits.point(j)), seen = viewer.project(point);
      if (seen) yield {j, point, ...seen};
    }
  }

  isHidden({x, y, point}) {
    const {viewer} = this;
    if (!viewer.settings.hidesBehind) return false;
    const {eye} = viewer.matrices, ray = plus(point, eye, -1);
    const triangle = findTriangle(viewer.scene, viewer.hidden, viewer.settings.blend, eye, ray);
    if (triangle < 0) return false;
    const corners = [...viewer.scene.triangleIndices.subarray(3 * triangle, 3 * triangle + 3)].map((v) => blended(viewer.scene.before, viewer.scene.move, v, viewer.settings.blend));
    return meet(eye, ray, ...corners) < 0.999;
  }

  pickPoint(x, y, pixels) {
    let best = null, least = pixels;
    if (!this.viewer.settings.showCage) return null;
    for (const point of this.points()) {
      const far = Math.hypot(point.x - x, point.y - y);
      if (far < least && !this.isHidden(point)) {
        least = far;
        best = point;
      }
    }
    return best;
  }

  // What a pointer that goes down begins; null: the camera has it.
  take(event, at) {
    const {viewer} = this;
    if (event.button !== 0) return null;
    viewer.matrices = viewer.camera.matrices();
    const handle = findHandle(viewer, this.handles, ...at);
    if (handle) return this.dragHandle(handle, at);
    const point = this.pickPoint(...at, CONTROL_GRAB[event.pointerType] || CONTROL_PIXELS);
    if (point) return this.dragPoint(point, at, event);
    return this.boxes || event.ctrlKey || event.metaKey ? this.dragBox(at, event) : null;
  }

  modeOf(event) {
    return event.shiftKey ? 'add' : event.altKey ? 'remove' : 'set';
  }

  // A drag of edits: changesOf gives the changes for a place of the pointer.
  dragEdits(changesOf, click) {
    const {editor} = this, drag = editor.beginDrag();
    return {
      move: (at) => drag.show(() => changesOf(at)),
      end: (at) => drag.end(() => changesOf(at)),
      cancel: () => drag.cancel(),
      click: (event) => {
        drag.cancel();
        if (click) click(event);
      },
    };
  }

  dragHandle({kind, axis}, from) {
    const {viewer, editor: {edits}} = this, {scale} = viewer.scene.space, center = this.center();
    if (this.mode === 'rotate') {
      return this.dragEdits((to) => edits.mapBy(rotation(AXIS_NAMES[axis], angleOf(viewer, axis, center, from, to)), this.editor.about()));
    }
    if (this.mode === 'scale') {
      return this.dragEdits((to) => {
        const by = factorOf(viewer, center, from, to), diagonal = [0, 1, 2].map((a) => (kind === 'center' || a === axis ? by : 1));
        return edits.mapBy([diagonal[0], 0, 0, 0, diagonal[1], 0, 0, 0, diagonal[2]], this.editor.about());
      });
    }
    return this.dragEdits((to) => edits.moveBy(movementOf(viewer, kind, axis, center, from, to).map((x) => x * scale)));
  }

  // A point that is not selected becomes the selection.
  dragPoint({j, point}, from, event) {
    const {viewer, editor} = this, {edits} = editor, mode = this.modeOf(event), wasSelected = edits.selected[j] === 1;
    if (mode === 'set' && !wasSelected) edits.select([j]);
    else if (mode === 'add' && !wasSelected) edits.select([j], 'add');
    const kind = this.lock >= 0 ? 'axis' : 'screen', {scale} = viewer.scene.space;
    return this.dragEdits((to) => edits.moveBy(movementOf(viewer, kind, this.lock, point, from, to).map((x) => x * scale)), () => {
      if (mode === 'set') edits.select([j]);
      else if (mode === 'remove' || wasSelected) edits.select([j], 'remove');
    });
  }

  dragBox(from, event) {
    const mode = this.modeOf(event), {frame, editor: {edits}} = this;
    const close = () => { frame.hidden = true; };
    return {
      move: (to) => {
        frame.hidden = false;
        Object.assign(frame.style, {left: `${Math.min(from[0], to[0])}px`, top: `${Math.min(from[1], to[1])}px`, width: `${Math.abs(from[0] - to[0])}px`,
          height: `${Math.abs(from[1] - to[1])}px`});
      },
      end: (to) => {
        close();
        const within = (x, a) => x >= Math.min(from[a], to[a]) && x <= Math.max(from[a], to[a]);
        edits.select([...this.points()].filter((point) => within(point.x, 0) && within(point.y, 1) && !this.isHidden(point)).map(({j}) => j), mode);
      },
      cancel: close,
      click: () => {
        if (mode === 'set') edits.select([]);
      },
    };
  }

  center() {
    const {viewer, editor} = this, about = editor.about() || editor.edits.centroid();
    return about ? toPicture(viewer.scene, about) : null;
  }

  // Puts the handles where the selection is, as large as they are from here.
  placeHandles() {
    const {viewer, mode} = this, center = viewer.matrices ? this.center() : null;
    const size = center ? gizmoSize(viewer, center) : 0;
    this.handles = size > 0 && viewer.settings.showCage && viewer.settings.blend === 1 ? listHandles(mode, center, size) : [];
    const shown = [];
    this.handles.forEach(({lines, points, color}, i) => {
      if (lines) {
        viewer.renderer.setMarks(`handle-line-${i}`, lines, 12);
        shown.push({name: `handle-line-${i}`, isLine: true, size: 3, color, hiddenShare: 1});
      }
      if (points) {
        viewer.renderer.setMarks(`handle-point-${i}`, [...points, 0, 0, 0], 6);
        shown.push({name: `handle-point-${i}`, isLine: false, size: 13, color, hiddenShare: 1});
      }
    });
    return shown;
  }

  // A click on a control point is a selection; true: that is all.
  chooseControl(cage, p) {
    return cage.index === this.viewer.scene.edit.cage && p >= 0;
  }

  showCards(panel) {
    this.editor.panel.showCards(panel);
  }

  // Moves by a step along the screen, or along the axis that is locked.
  nudge(x, y, z) {
    const {viewer, editor, lock} = this, {right, up, back} = viewer.camera.axes(), step = editor.step();
    const by = lock < 0 ? [0, 1, 2].map((a) => step * (x * right[a] + y * up[a] - z * back[a])) : [0, 1, 2].map((a) => (a === lock ? step * (x + y + z) : 0));
    editor.tryTo(() => editor.edits.nudge(by));
  }

  // The next control point, or the one before, becomes the selection, beside those that are kept.
  walk(step) {
    const {edits} = this.editor, list = edits.selection();
    if (this.cursor === undefined || !edits.selected[this.cursor]) this.cursor = list.length ? list[list.length - 1] : step > 0 ? -1 : 0;
    this.cursor = (this.cursor + step + edits.count) % edits.count;
    this.kept = this.kept.filter((j) => edits.selected[j]);
    edits.select([...this.kept, this.cursor]);
  }

  // Keeps the point of the walk, which then goes on; or lets it go.
  keep() {
    const {editor} = this, {edits} = editor;
    if (this.cursor === undefined || !edits.selected[this.cursor]) return;
    this.kept = this.kept.includes(this.cursor) ? this.kept.filter((j) => j !== this.cursor) : [...this.kept, this.cursor];
    editor.say(this.kept.length ? `${countText(this.kept.length, 'point')} kept: N goes on, and adds.` : 'No point is kept.');
  }

  // The control point that moves a vertex of the mesh most becomes the selection.
  chooseMover(x, y, event) {
    const {viewer, editor: {edits, shown, scene}} = this, found = pick(viewer, x, y);
    if (!found || found.vertex === undefined) return;
    const {uvw} = scene.edit, at = 3 * found.vertex;
    let best = -1, most = 0;
    if (Number.isNaN(uvw[at])) return;
    shown.volume.visit(uvw[at], uvw[at + 1], uvw[at + 2], (j, value) => {
      if (value > most) {
        most = value;
        best = j;
      }
    });
    if (best >= 0) edits.select([best], this.modeOf(event));
  }

  // Ends what is going on, and gives the keys to the picture.
  leave() {
    const {viewer, editor} = this;
    if (this.boxes) editor.panel.toggleBoxes();
    viewer.clearChoice();
    viewer.canvas.focus();
  }

  addKeys() {
    const {editor} = this, {edits} = editor;
    const plain = {
      n: () => this.walk(1), N: () => this.walk(-1), a: () => editor.selectAll(), q: () => editor.panel.toggleBoxes(), m: () => editor.panel.toggleMirror(),
      v: () => editor.panel.toggleBehind(), g: () => editor.setMode('move'), o: () => editor.setMode('rotate'), e: () => editor.setMode('scale'),
      x: () => editor.setLock(0), y: () => editor.setLock(1), z: () => editor.setLock(2), k: () => editor.tryTo(() => edits.smooth()),
      u: () => edits.undo(), U: () => edits.redo(), '[': () => editor.panel.changeRadius(1 / 1.25), ']': () => editor.panel.changeRadius(1.25),
      ' ': () => this.keep(), '?': () => editor.panel.toggleHelp(), Delete: () => editor.tryTo(() => edits.reset()), Backspace: () => editor.tryTo(() => edits.reset()),
    };
    const shifted = {ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1]};
    const commands = {z: () => edits.undo(), Z: () => edits.redo(), y: () => edits.redo(), s: () => editor.files.save(), a: () => edits.select(Array.from({length: edits.count}, (_, j) => j))};
    this.viewer.canvas.addEventListener('dblclick', (event) => this.chooseMover(event.offsetX, event.offsetY, event));
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') {
        this.leave();
        return;
      }
      const isText = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== 'checkbox' && event.target.type !== 'radio';
      // Buttons and boxes have Space and Enter for themselves.
      const onPicture = event.target === this.viewer.canvas || event.target === document.body || !(isText || event.key === ' ' || event.key.startsWith('Arrow'));
      const action = event.ctrlKey || event.metaKey ? (isText && event.key !== 's' ? null : commands[event.key])
        : event.altKey || isText || !onPicture ? null : event.shiftKey && shifted[event.key] ? () => this.nudge(...shifted[event.key]) : plain[event.key];
      if (!action) return;
      event.preventDefault();
      event.stopPropagation();
      action();
    }, true);
  }
}
