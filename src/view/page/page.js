// page.js - starts the page.

function setTheme(isDark) {
  document.documentElement.dataset.theme = isDark ? 'dark' : 'light';
  const theme = byId('theme');
  theme.setAttribute('aria-pressed', String(isDark));
  theme.textContent = isDark ? 'Light' : 'Dark';
  theme.setAttribute('aria-label', isDark ? 'Light colours' : 'Dark colours');
}

// Light or dark as the system has it, until the button is used.
function startTheme(redraw) {
  const system = window.matchMedia('(prefers-color-scheme: dark)');
  let isChosen = false;
  setTheme(system.matches);
  system.addEventListener('change', () => {
    if (!isChosen) setTheme(system.matches);
    redraw();
  });
  byId('theme').addEventListener('click', () => {
    isChosen = true;
    setTheme(document.documentElement.dataset.theme !== 'dark');
    redraw();
  });
}

function tellProblem(text) {
  byId('problem').textContent = text;
  byId('problem').hidden = false;
}

function showNames(scene) {
  // The heading is cut at its beginning, as from right to left; the names in it are in their order.
  const names = make('span', '', nameElement(scene.name || 'mesh'));
  names.dir = 'ltr';
  if (scene.output) names.append(' \u2192 ', nameElement(scene.output));
  byId('name').append(names);
}

// A mesh alone has no way to go.
function hasTwoShapes(scene) {
  return Boolean(scene.statuses || scene.output || scene.edit);
}

function startControls(viewer) {
  byId('way').hidden = !hasTwoShapes(viewer.scene);
  byId('play-key').hidden = !hasTwoShapes(viewer.scene);
  byId('blend').addEventListener('input', (event) => {
    viewer.stopMotion();
    viewer.setBlend(Number(event.target.value) / 100);
  });
  byId('play').addEventListener('click', () => viewer.play());
  for (const one of document.querySelectorAll('[data-view]')) {
    one.addEventListener('click', () => viewer.look(one.dataset.view));
  }
  viewer.canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    tellProblem('The graphics card gave up the picture. Load the page again.');
  });
}

function start() {
  let scene = null;
  try {
    scene = readScene();
  } catch (problem) {
    console.warn(problem);
  }
  if (!scene) {
    startTheme(() => {});
    tellProblem('The page is not complete, or too large for this browser: its data cannot be read.');
    return;
  }
  const viewer = new Viewer(scene);
  startTheme(() => viewer.redraw());
  showNames(scene);
  showVerdicts(scene);
  try {
    viewer.renderer = new Renderer(viewer.canvas, scene);
  } catch (problem) {
    byId('stage').hidden = true;
    tellProblem(`The picture needs WebGL2, which this browser does not give (${problem.message}); the figures are here all the same.`);
  }
  if (viewer.renderer) {
    viewer.start();
    startControls(viewer);
  }
  showPanel(viewer);
  if (viewer.renderer) viewer.motionRow.start();
  for (const begin of extensions) begin(viewer);
  document.documentElement.dataset.ready = viewer.renderer ? 'picture' : 'figures';
}

start();
