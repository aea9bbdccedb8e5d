// viewer.js - the state of the page and what changes it; a picture is drawn when something did.

const MOTION = 350;   // milliseconds of a camera's way
const FIT_POSES = 6;  // of an animation, that the camera makes room for
const PLAY = 1600;    // of a way from before to after

function palette(isDark) {
  return {
    cage: isDark ? [0.45, 0.68, 1, 0.85] : [0.12, 0.36, 0.8, 0.75],
    control: isDark ? [0.45, 0.68, 1, 1] : [0.12, 0.36, 0.8, 1],
    rest: isDark ? [0.75, 0.78, 0.84, 0.4] : [0.25, 0.28, 0.34, 0.32],
    rim: isDark ? [0.08, 0.1, 0.13, 1] : [1, 1, 1, 1],
    tear: [0.9, 0.1, 0.12, 1],
    chosen: [1, 0.78, 0.1, 1],
    loose: isDark ? [0.55, 0.58, 0.64, 1] : [0.045, 0.051, 0.065, 1],
    edge: [0.01, 0.012, 0.016, 0.32],
    joint: isDark ? [1, 0.62, 0.9, 0.95] : [0.72, 0.06, 0.5, 0.9],
  };
}

// What begins once a page of tools has its picture.
const extensions = [];

// Lines along u, v and w of the cages, and their control points, as the renderer takes them.
function cageMarks(scene) {
  const lines = [], controls = [];
  for (const cage of scene.cages) {
    const [nu, nv, nw] = cage.size;
    const put = (list, p) => {
      const rest = toPicture(scene, [...cage.rest.subarray(3 * p, 3 * p + 3)]);
      const deformed = toPicture(scene, [...cage.deformed.subarray(3 * p, 3 * p + 3)]);
      list.push(...rest, ...deformed.map((x, a) => x - rest[a]));
    };
    for (let p = 0; p < cage.count; p++) {
      const at = [p % nu, Math.floor(p / nu) % nv, Math.floor(p / (nu * nv))];
      put(controls, p);
      [[nu, 1], [nv, nu], [nw, nu * nv]].forEach(([size, stride], a) => {
        if (at[a] + 1 < size || (cage.closed[a] && size > 2)) {
          put(lines, p);
          put(lines, p + (at[a] + 1 < size ? stride : (1 - size) * stride));
        }
      });
    }
  }
  return {lines, controls};
}

class Viewer {
  constructor(scene) {
    this.scene = scene;
    this.canvas = byId('view');
    this.partOf = partsOfVertices(scene);
    this.hidden = new Set();
    this.tornParts = new Set(scene.tears.flatMap((tear) => tear.ends.map((end) => (end.vertex === undefined ? -1 : this.partOf[end.vertex]))));
    this.paints = listPaints(scene);
    const named = (key) => this.paints.find((paint) => paint.key === key);
    const own = scene.view.color === 'auto' && hasOwnColors(scene) ? named('plain') : null;
    this.paint = own || named(scene.view.color) || named('displacement') || named('plain');
    this.settings = {blend: 1, showCage: true, showRest: false, showTears: true, showFlipped: true, showEdges: false, isSmooth: true,
      showJoints: false, isPosed: false, isMorphed: false};
    this.camera = new Camera(listFitPoints(scene), scene.view.up);
    if (scene.view.camera.some((x) => x !== 0)) [this.camera.yaw, this.camera.pitch] = anglesOf(scene.view.camera, scene.view.up);
    this.renderer = null;
    this.waiting = false;
    this.motion = 0;
    this.motionRow = new Motion(this);
  }

  // Once there is a renderer.
  start() {
    this.markCages();
    this.resize();
    this.setPaint(this.paint);
    this.renderer.loadTextures(() => this.redraw());
    this.partsChanged();
    if (this.scene.rig) this.showJoints(null, 0);
    addPointers(this.canvas, this);
    addKeys(this.canvas, this);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    byId('witness').addEventListener('click', () => this.chooseWitness());
  }

  markCages() {
    const {lines, controls} = cageMarks(this.scene);
    this.renderer.setMarks('cage', lines, 12);
    this.renderer.setMarks('controls', controls, 6);
  }

  resize() {
    this.renderer.resize();
    this.camera.aspect = this.canvas.width / this.canvas.height;
    if (!this.touched) Object.assign(this.camera, this.camera.fit());
    this.redraw();
  }

  redraw() {
    if (this.waiting || !this.renderer) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.matrices = this.camera.matrices();
      this.renderer.draw({...this.settings, matrices: this.matrices, colors: palette(document.documentElement.dataset.theme === 'dark')});
      this.placeWitness();
    });
  }

  // Brings mesh and joints to a time of an animation; null: to rest.
  pose(animation, time) {
    const {scene, renderer, settings} = this;
    if (!animation && !settings.isPosed && !settings.isMorphed && scene.sliders.every(({value, weight}) => value === weight)) return;
    const poses = poseScene(scene, animation, time);
    renderer.setPose(poses);
    settings.isPosed = animation !== null;
    settings.isMorphed = poses.isMorphed;
    shownWeights(scene, poses).forEach((weight, index) => scene.sliders[index].show(weight));
    if (scene.rig) this.showJoints(animation, time);
    if (this.chosenVertex !== undefined) this.markVertex(this.chosenVertex);
    this.redraw();
  }

  // Gives morph targets a weight.
  setTarget(slider, value) {
    slider.value = value;
    this.pose(this.motionRow.animation, this.motionRow.time);
  }

  // Makes room for all of an animation, by some of its poses; as long as nobody has moved the camera it moves there.
  fitTo(animation) {
    const {scene, camera} = this;
    poseScene(scene, null, 0);
    const points = listFitPoints(scene);
    for (let i = 0; animation && i < FIT_POSES; i++) {
      poseScene(scene, animation, animation.begin + (animation.end - animation.begin) * i / FIT_POSES);
      points.push(...listFitPoints({...scene, cages: []}));
    }
    camera.hold(points);
    if (!this.touched) Object.assign(camera, camera.fit());
  }

  showJoints(animation, time) {
    const {lines, points} = jointMarks(this.scene, animation, time);
    this.renderer.setMarks('joints', lines, 12);
    this.renderer.setMarks('jointPoints', points, 6);
  }

  markVertex(vertex) {
    const {before, move} = this.scene;
    this.renderer.setMarks('chosenPoint', [...before.subarray(3 * vertex, 3 * vertex + 3), ...move.subarray(3 * vertex, 3 * vertex + 3)], 6);
  }

  project(point) {
    return this.camera.project(point, this.matrices, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  set(key, value) {
    this.settings[key] = value;
    const input = byId('show-' + key);
    if (input) input.checked = value;
    this.redraw();
  }

  toggle(key) {
    this.set(key, !this.settings[key]);
  }

  setPaint(paint) {
    this.paint = paint;
    this.renderer.setPaint(paint);
    showLegend(this.scene, paint);
    const input = byId('color-' + paint.key);
    if (input) input.checked = true;
    this.redraw();
  }

  // From the model's own colours to the displacement, and back.
  turnPaint() {
    const named = (key) => this.paints.find((paint) => paint.key === key);
    this.setPaint((this.paint.key === 'plain' ? named('displacement') : null) || named('plain'));
  }

  showPart(index, isShown) {
    this.hidden[isShown ? 'delete' : 'add'](index);
    this.partsChanged();
  }

  // Torn edges of hidden parts are hidden too.
  partsChanged() {
    this.renderer.setParts(this.hidden);
    const lines = [];
    for (const {ends} of this.scene.tears) {
      if (ends.every((end) => end.vertex !== undefined && this.hidden.has(this.partOf[end.vertex]))) continue;
      lines.push(...this.tearLine(ends));
    }
    this.renderer.setMarks('tears', lines, 12);
    this.redraw();
  }

  tearLine(ends) {
    return ends.flatMap(({before, after}) => {
      const from = toPicture(this.scene, before), to = toPicture(this.scene, after);
      return [...from, ...to.map((x, a) => x - from[a])];
    });
  }

  setBlend(share) {
    this.settings.blend = share;
    const percent = Math.round(100 * share);
    byId('blend').value = percent;
    byId('blend').setAttribute('aria-valuetext', percent === 0 ? 'before' : percent === 100 ? 'after' : `${percent} % of the way`);
    byId('percent').textContent = `${percent}\u00a0%`;
    this.redraw();
  }

  // Calls step with 0 to 1 in so many milliseconds, or with 1 at once.
  animate(time, step) {
    this.stopMotion();
    if (wantsStillness()) {
      step(1);
      return;
    }
    let began = 0;
    const tick = (now) => {
      began = began || now;
      const share = Math.min((now - began) / time, 1);
      step(share);
      this.motion = share < 1 ? requestAnimationFrame(tick) : 0;
    };
    this.motion = requestAnimationFrame(tick);
  }

  stopMotion() {
    cancelAnimationFrame(this.motion);
    this.motion = 0;
    this.touched = true;
  }

  play() {
    if (!hasTwoShapes(this.scene)) return;
    const from = this.settings.blend > 0.5 ? 1 : 0;
    this.animate(PLAY, (share) => this.setBlend(from + (1 - 2 * from) * (share * share * (3 - 2 * share))));
  }

  moveCamera(to) {
    const {camera} = this;
    const from = {yaw: camera.yaw, pitch: camera.pitch, distance: camera.distance, target: camera.target};
    const turn = Math.atan2(Math.sin(to.yaw - from.yaw), Math.cos(to.yaw - from.yaw));
    this.animate(MOTION, (share) => {
      const s = share * share * (3 - 2 * share);
      const mix = (a, b) => a + s * (b - a);
      camera.yaw = from.yaw + s * turn;
      camera.pitch = mix(from.pitch, to.pitch);
      camera.distance = mix(from.distance, to.distance);
      camera.target = from.target.map((x, a) => mix(x, to.target[a]));
      this.redraw();
    });
  }

  look(name) {
    const camera = new Camera(this.camera.points, this.camera.upwards);
    [camera.yaw, camera.pitch] = VIEWS[name] || [this.camera.yaw, this.camera.pitch];
    camera.aspect = this.camera.aspect;
    this.moveCamera({yaw: camera.yaw, pitch: camera.pitch, ...camera.fit()});
  }

  goTo(point) {
    const {yaw, pitch} = this.camera;
    this.moveCamera({yaw, pitch, distance: Math.min(this.camera.distance, 0.45 * this.camera.fit().distance), target: point});
  }

  // Figures of what was chosen: a title, rows, and marks on the picture.
  choose(title, rows, marks) {
    const list = make('dl', '');
    for (const [label, value] of rows) list.append(make('div', '', make('dt', '', label), make('dd', '', value)));
    const close = button('\u00d7', () => this.clearChoice(), 'close');
    close.setAttribute('aria-label', 'Close');
    this.chosenVertex = undefined;
    byId('said').replaceChildren(make('p', 'title', title, close), list);
    this.renderer.setMarks('chosen', marks.lines || [], 12);
    this.renderer.setMarks('chosenPoint', marks.points || [], 6);
    this.redraw();
  }

  clearChoice() {
    this.chosenVertex = undefined;
    byId('said').replaceChildren();
    this.renderer.setMarks('chosen', [], 12);
    this.renderer.setMarks('chosenPoint', [], 6);
    this.redraw();
  }

  clickAt(x, y) {
    this.matrices = this.camera.matrices();
    const found = pick(this, x, y);
    if (!found) this.clearChoice();
    else if (found.cage) this.chooseControl(found.cage, found.p);
    else this.chooseVertex(found.vertex);
  }

  chooseControl(cage, p) {
    if (this.tools && this.tools.chooseControl(cage, p)) return;
    const [nu, nv] = cage.size;
    const rest = [...cage.rest.subarray(3 * p, 3 * p + 3)], deformed = [...cage.deformed.subarray(3 * p, 3 * p + 3)];
    const from = toPicture(this.scene, rest), to = toPicture(this.scene, deformed);
    this.choose(`Control point ${p % nu}, ${Math.floor(p / nu) % nv}, ${Math.floor(p / (nu * nv))}`,
      [['Lattice', nameElement(cage.name)], ['At rest', pointText(rest)], ['Deformed', pointText(deformed)],
        ['Moved by', pointText(deformed.map((c, a) => c - rest[a]))]],
      {points: [...from, ...to.map((c, a) => c - from[a])]});
  }

  chooseVertex(vertex) {
    const {scene} = this;
    const before = vertexBefore(scene, vertex), move = vertexMove(scene, vertex);
    const rest = this.settings.isPosed || this.settings.isMorphed ? ', at rest' : '';
    const rows = [['Before' + rest, pointText(before)], ['After' + rest, pointText(before.map((x, a) => x + move[a]))],
      ['Displacement', numberText(Math.hypot(...move))]];
    if (scene.statuses) rows.push(['Status', STATUS_NAMES[scene.statuses[vertex]] || 'unknown']);
    if (scene.dets && !Number.isNaN(scene.dets[vertex])) rows.push(['det F', numberText(scene.dets[vertex])]);
    const part = scene.parts[this.partOf[vertex]];
    if (part && part.name) rows.push(['Part', nameElement(part.name)]);
    this.choose('Vertex ' + numberText(vertexNumber(scene, vertex)), rows, {});
    this.chosenVertex = vertex;
    this.markVertex(vertex);
  }

  chooseTear(tear) {
    const line = this.tearLine(tear.ends);
    const vertex = tear.ends[0].vertex ?? tear.ends[1].vertex;
    const part = vertex === undefined ? null : this.scene.parts[this.partOf[vertex]];
    const rows = [['Step', numberText(tear.step)], ['Vertices', tear.ends.map((end) => numberText(end.number)).join(' and ')],
      ['After', tear.ends.map((end) => pointText(end.after)).join('; ')]];
    if (part && part.name) rows.push(['Part', nameElement(part.name)]);
    this.choose('Torn edge', rows, {lines: line});
    const {blend} = this.settings;
    this.goTo([0, 1, 2].map((a) => (line[a] + line[6 + a] + blend * (line[3 + a] + line[9 + a])) / 2));
  }

  chooseTriangle(triangle) {
    const {scene} = this;
    const corners = [...scene.triangleIndices.subarray(3 * triangle, 3 * triangle + 3)];
    const points = corners.map((v) => blended(scene.before, scene.move, v, this.settings.blend));
    const ends = corners.map((v) => [...blended(scene.before, scene.move, v, 0), ...[0, 1, 2].map((a) => scene.move[3 * v + a])]);
    this.choose('Flipped triangle', [['Vertices', corners.map((v) => numberText(vertexNumber(scene, v))).join(', ')]],
      {lines: [0, 1, 2].flatMap((c) => [...ends[c], ...ends[(c + 1) % 3]])});
    this.goTo([0, 1, 2].map((a) => (points[0][a] + points[1][a] + points[2][a]) / 3));
  }

  witnessPoint() {
    const {before, after} = this.scene.witness;
    const from = toPicture(this.scene, before), to = toPicture(this.scene, after);
    return from.map((x, a) => x + this.settings.blend * (to[a] - x));
  }

  chooseWitness() {
    const {witness, cages} = this.scene;
    const rows = [['u, v, w', pointText(witness.uvw)], ['x, y, z', pointText(witness.after)], ['At rest', pointText(witness.before)],
      ['det J', numberText(witness.det)]];
    if (cages[witness.cage]) rows.push(['Lattice', nameElement(cages[witness.cage].name)]);
    this.choose('The volume folds here', rows, {});
    this.goTo(this.witnessPoint());
  }

  placeWitness() {
    const pin = byId('witness');
    const seen = this.scene.witness && !this.settings.isPosed && !this.settings.isMorphed ? this.project(this.witnessPoint()) : null;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    pin.hidden = !seen || seen.x < 0 || seen.y < 0 || seen.x > width || seen.y > height;
    if (!pin.hidden) pin.style.transform = `translate(${seen.x}px, ${seen.y}px)`;
  }
}
