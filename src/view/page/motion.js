// motion.js - the row below the picture that plays animations: which one, play and pause, the time.

const TIME_STEPS = 200;  // of the slider
const KEY_SECONDS = 1 / 24;

class Motion {
  constructor(viewer) {
    this.viewer = viewer;
    this.animation = null;
    this.time = 0;
    this.frame = 0;
    this.wasShown = false;
  }

  start() {
    const {rig} = this.viewer.scene;
    if (!rig || rig.animations.length === 0) return;
    const list = byId('animation');
    list.append(new Option('At rest', ''));
    rig.animations.forEach((animation, index) => list.append(new Option(animation.name, String(index))));
    list.addEventListener('change', () => this.choose(rig.animations[list.value === '' ? -1 : Number(list.value)] || null));
    byId('run').addEventListener('click', () => this.toggle());
    byId('time').addEventListener('input', (event) => {
      this.pause();
      const {begin, end} = this.animation;
      this.show(begin + (end - begin) * Number(event.target.value) / TIME_STEPS);
    });
    byId('time').max = TIME_STEPS;
    byId('motion').hidden = false;
    byId('motion-keys').hidden = false;
    const first = rig.animations[rig.start];
    list.value = first ? String(rig.start) : '';
    this.choose(first || null);
  }

  choose(animation) {
    this.pause();
    this.animation = animation;
    const isStill = !animation || !(animation.end > animation.begin);
    byId('run').disabled = isStill;
    byId('time').disabled = isStill;
    // Whoever looks at an animation first sees what moves it.
    if (animation && !this.wasShown) {
      this.wasShown = true;
      this.viewer.set('showJoints', true);
    }
    this.viewer.clearChoice();
    if (animation) this.viewer.fitTo(animation);
    this.show(animation ? animation.begin : 0);
  }

  // Moves the mesh to a time.
  show(time) {
    const {animation, viewer} = this;
    this.time = time;
    const seconds = (t) => t.toFixed(2);
    byId('time').value = animation && animation.end > animation.begin
      ? Math.round(TIME_STEPS * (time - animation.begin) / (animation.end - animation.begin)) : 0;
    byId('time').setAttribute('aria-valuetext', animation ? `${seconds(time)} of ${seconds(animation.end)} seconds` : 'at rest');
    byId('clock').textContent = animation ? `${seconds(time)}\u00a0s` : '';
    viewer.pose(animation, time);
  }

  // Goes round at the end.
  advance(seconds) {
    if (!this.animation) return;
    const {begin, end} = this.animation, span = end - begin;
    if (!(span > 0)) return;
    this.show(begin + ((((this.time - begin + seconds) % span) + span) % span));
  }

  toggle() {
    if (this.frame) this.pause();
    else this.play();
  }

  play() {
    if (!this.animation || byId('run').disabled) return;
    let last = 0;
    const tick = (now) => {
      this.frame = requestAnimationFrame(tick);
      if (last) this.advance((now - last) / 1000);
      last = now;
    };
    this.frame = requestAnimationFrame(tick);
    byId('run').textContent = 'Pause';
  }

  pause() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    byId('run').textContent = 'Animate';
  }

  step(direction) {
    this.pause();
    this.advance(direction * KEY_SECONDS);
  }
}
