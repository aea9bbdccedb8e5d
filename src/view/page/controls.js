// controls.js - mouse, fingers and keys on the picture. A pointer that did not move is a click.

const CLICK_PIXELS = 5;

function addPointers(canvas, viewer) {
  const pointers = new Map();
  let travelled = 0, most = 0, drag = null;  // drag: of a tool that has taken the pointer
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const middle = () => {
    const all = [...pointers.values()];
    const sum = all.reduce((s, p) => [s[0] + p.x, s[1] + p.y], [0, 0]);
    const spread = all.length > 1 ? Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) : 0;
    return {x: sum[0] / all.length, y: sum[1] / all.length, spread};
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (pointers.size === 0) travelled = most = 0;
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    most = Math.max(most, pointers.size);
    viewer.stopMotion();
    if (drag && pointers.size > 1) {
      drag.cancel();
      drag = null;
    } else if (viewer.tools && pointers.size === 1) drag = viewer.tools.take(event, place(event));
  });
  canvas.addEventListener('pointermove', (event) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) return;
    const before = middle();
    Object.assign(pointer, {x: event.clientX, y: event.clientY});
    const after = middle();
    const dx = after.x - before.x, dy = after.y - before.y, size = canvas.clientHeight;
    travelled += Math.hypot(dx, dy);
    if (drag) {
      if (travelled >= CLICK_PIXELS) drag.move(place(event));
      return;
    }
    if (pointers.size > 1) {
      viewer.camera.shift(dx / size, dy / size);
      if (before.spread > 0 && after.spread > 0) viewer.camera.zoom(before.spread / after.spread);
    } else if (event.shiftKey || event.buttons & 6) {
      viewer.camera.shift(dx / size, dy / size);
    } else {
      viewer.camera.turn((-dx / size) * 3.6, (dy / size) * 3.6);
    }
    viewer.redraw();
  });
  const leave = (event) => {
    const wasDown = pointers.delete(event.pointerId);
    if (drag && wasDown) {
      const ended = drag;
      drag = null;
      if (event.type !== 'pointerup') ended.cancel();
      else if (travelled >= CLICK_PIXELS) ended.end(place(event));
      else ended.click(event);
      return;
    }
    if (event.type === 'pointerup' && wasDown && most === 1 && travelled < CLICK_PIXELS && event.button === 0) {
      viewer.clickAt(...place(event));
    }
  };
  canvas.addEventListener('pointerup', leave);
  canvas.addEventListener('pointercancel', leave);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    viewer.stopMotion();
    const lines = event.deltaMode === 1 ? 16 : 1;
    viewer.camera.zoom(Math.exp(Math.min(Math.max(event.deltaY * lines, -240), 240) * 0.0016));
    viewer.redraw();
  }, {passive: false});
}

function addKeys(canvas, viewer) {
  const turn = (yaw, pitch) => () => viewer.camera.turn(yaw, pitch);
  const view = (name) => () => viewer.look(name);
  const keys = {
    ArrowLeft: turn(-0.12, 0), ArrowRight: turn(0.12, 0), ArrowUp: turn(0, 0.1), ArrowDown: turn(0, -0.1),
    '+': () => viewer.camera.zoom(0.85), '=': () => viewer.camera.zoom(0.85), '-': () => viewer.camera.zoom(1 / 0.85),
    Home: view('fit'), f: view('front'), b: view('back'), l: view('left'), r: view('right'), t: view('top'), i: view('iso'),
    d: () => viewer.turnPaint(), c: () => viewer.toggle('showCage'), w: () => viewer.toggle('showEdges'), ' ': () => viewer.play(),
    j: () => viewer.toggle('showJoints'), p: () => viewer.motionRow.toggle(), ',': () => viewer.motionRow.step(-1), '.': () => viewer.motionRow.step(1),
    Escape: () => viewer.clearChoice(),
  };
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
    viewer.redraw();
  });
}
