// panel.js - the panel beside the picture: colours, what is shown, findings, parts, and the figures of the report.

const MOST_ROWS = 300;   // of a list; the filter finds the others
const MOST_FINDINGS = 60;

function section(title, ...children) {
  return make('section', 'card', make('h2', '', title), ...children);
}

function button(text, action, className = '') {
  const element = make('button', className, text);
  element.type = 'button';
  element.addEventListener('click', action);
  return element;
}

function checkbox(id, label, checked, action, extra) {
  const input = make('input');
  input.type = 'checkbox';
  input.checked = checked;
  if (id) input.id = id;
  input.addEventListener('change', () => action(input.checked));
  const line = make('label', 'check', input, label);
  if (extra) line.append(extra);
  return line;
}

function colorSection(viewer) {
  const group = make('div', 'choices');
  group.setAttribute('role', 'radiogroup');
  group.setAttribute('aria-label', 'Colour by');
  for (const paint of viewer.paints) {
    const input = make('input');
    Object.assign(input, {type: 'radio', name: 'color', value: paint.key, id: 'color-' + paint.key});
    input.checked = paint === viewer.paint;
    input.addEventListener('change', () => viewer.setPaint(paint));
    const label = make('label', '', input, make('span', '', paint.label));
    group.append(label);
  }
  return section('Colour by', group);
}

function showSection(viewer) {
  const {scene, settings} = viewer;
  const list = make('div', 'checks');
  const add = (key, label, extra) => {
    const line = checkbox('show-' + key, label, settings[key], (on) => viewer.set(key, on), extra);
    list.append(line);
  };
  if (scene.cages.some((cage) => cage.count)) {
    add('showCage', 'Cage, follows the slider');
    add('showRest', 'Cage at rest');
  }
  if (scene.tears.length) add('showTears', 'Torn edges', make('i', 'mark tear'));
  if (scene.flippedFaces) add('showFlipped', 'Flipped faces', make('i', 'mark flipped'));
  const joints = countJoints(scene.rig);
  if (joints) add('showJoints', 'Joints', make('span', 'count', numberText(joints)));
  add('showEdges', 'Edges of triangles');
  add('isSmooth', 'Smooth shading');
  if (scene.rig && scene.rig.animations.length && scene.cages.length) {
    list.append(make('p', 'more', 'Animations hide the cage, torn edges and the fold: these are of the mesh at rest.'));
  }
  return section('Show', list);
}

// Findings of one kind and part, which open; each is a button that goes there.
function findingGroup(title, part, summary, entries, all) {
  const details = make('details', 'finding');
  const head = make('summary', '', make('strong', '', title), ' ');
  if (part) head.append(nameElement(part));
  head.append(make('span', 'quiet', summary));
  const list = make('div', 'list');
  entries.slice(0, MOST_FINDINGS).forEach(([text, action]) => list.append(button(text, action, 'row')));
  const left = all - Math.min(entries.length, MOST_FINDINGS);
  if (left > 0) list.append(make('p', 'more', `and ${numberText(left)} more`));
  details.append(head, list);
  return details;
}

function groupByPart(items, partOf) {
  const groups = new Map();
  for (const item of items) {
    const part = partOf(item);
    if (!groups.has(part)) groups.set(part, []);
    groups.get(part).push(item);
  }
  return groups;
}

function tearFindings(viewer) {
  const {scene} = viewer;
  const vertex = (tear) => tear.ends[0].vertex ?? tear.ends[1].vertex;
  const groups = groupByPart(scene.tears, (tear) => (vertex(tear) === undefined ? -1 : viewer.partOf[vertex(tear)]));
  const parts = [...groups].map(([part, tears]) => {
    const entries = tears.map((tear) => [
      `${numberText(tear.ends[0].number)} \u2013 ${numberText(tear.ends[1].number)}: step ${numberText(tear.step)}`,
      () => viewer.chooseTear(tear),
    ]);
    const largest = Math.max(...tears.map((tear) => tear.step));
    const name = part >= 0 ? scene.parts[part].name : '';
    return findingGroup('Torn', name, ` ${countText(tears.length, 'edge')}, step to ${numberText(largest)}`, entries, tears.length);
  });
  const left = scene.tearEdges - scene.tears.length;
  if (left > 0) parts.push(make('p', 'more', `${countText(left, 'torn edge')} with smaller steps not listed`));
  return parts;
}

function flippedFindings(viewer) {
  const {scene} = viewer;
  const found = [];
  scene.parts.forEach((part, index) => {
    const triangles = [];
    for (let t = part.first; t < part.first + part.count; t++) if (scene.flipped[t]) triangles.push(t);
    if (triangles.length === 0) return;
    const entries = triangles.slice(0, MOST_FINDINGS).map((t) => [
      'triangle at vertex ' + numberText(vertexNumber(scene, scene.triangleIndices[3 * t])), () => viewer.chooseTriangle(t)]);
    found.push(findingGroup('Flipped', scene.parts[index].name, ' ' + countText(triangles.length, 'triangle'), entries,
      triangles.length));
  });
  if (scene.triangles < scene.trianglesAll) {
    found.push(make('p', 'more', `of those that are drawn; ${countText(scene.flippedFaces, 'face')} ${scene.flippedFaces === 1 ? 'is' : 'are'} flipped in all`));
  }
  return found;
}

function findingSection(viewer) {
  const {scene} = viewer;
  const found = [];
  if (scene.witness) {
    const go = button(`Fold: det ${numberText(scene.witness.det)} at u, v, w = ${pointText(scene.witness.uvw, 4)}`,
      () => viewer.chooseWitness(), 'row strong');
    go.id = 'go-witness';
    found.push(go);
  }
  if (scene.tears.length) found.push(...tearFindings(viewer));
  if (scene.flipped) found.push(...flippedFindings(viewer));
  if (found.length === 0) {
    if (!scene.statuses || scene.edit) return null;
    found.push(make('p', 'more', 'No folds, torn edges or flipped faces were found.'));
  }
  const card = section('Where it went wrong', ...found);
  card.id = 'findings';
  return card;
}

function partRow(viewer, part, index) {
  const {scene} = viewer;
  const extra = make('span', 'count', numberText(part.all));
  const name = part.name ? nameElement(part.name) : make('span', 'quiet', 'without a name');
  const line = checkbox('', name, !viewer.hidden.has(index), (on) => viewer.showPart(index, on), extra);
  line.firstChild.dataset.part = index;
  if (viewer.tornParts.has(index)) line.insertBefore(make('b', 'badge', 'torn'), extra);
  const material = scene.materials[part.material];
  if (material && material.name && material.name !== part.name) line.title = `${part.name} \u2013 material ${material.name}`;
  return line;
}

function partSection(viewer) {
  const {scene} = viewer;
  if (scene.parts.length < 2 && !(scene.parts[0] && scene.parts[0].name)) return null;
  const list = make('div', 'list parts');
  list.tabIndex = 0;
  list.setAttribute('role', 'group');
  list.setAttribute('aria-label', 'Parts');
  const filter = make('input', 'filter');
  Object.assign(filter, {type: 'search', placeholder: 'Filter by name'});
  filter.setAttribute('aria-label', 'Filter parts by name');
  const fill = () => {
    const wanted = filter.value.toLowerCase();
    const chosen = scene.parts.map((part, index) => [part, index]).filter(([part]) => part.name.toLowerCase().includes(wanted));
    list.replaceChildren(...chosen.slice(0, MOST_ROWS).map(([part, index]) => partRow(viewer, part, index)));
    if (chosen.length > MOST_ROWS) list.append(make('p', 'more', `and ${numberText(chosen.length - MOST_ROWS)} more: use the filter`));
    return chosen;
  };
  const setAll = (on) => () => {
    fill().forEach(([, index]) => viewer.hidden[on ? 'delete' : 'add'](index));
    viewer.partsChanged();
    fill();
  };
  filter.addEventListener('input', fill);
  fill();
  const tools = make('div', 'tools', button('Show all', setAll(true)), button('Hide all', setAll(false)));
  if (scene.parts.length > 12) tools.prepend(filter);
  return section(`Parts (${numberText(scene.parts.length)})`, tools, list);
}

// The first job of a report, or a job by itself.
function jobOf(report) {
  if (!report || typeof report !== 'object') return null;
  return Array.isArray(report.jobs) ? report.jobs[0] || null : report;
}

function boxText(box) {
  return box && box.min && box.max ? `${pointText(box.min)}  to  ${pointText(box.max)}` : '\u2013';
}

// Rows of the figures: label, value, and "bad" where one should look.
function figureRows(job) {
  const rows = [];
  const add = (label, value, kind = '') => {
    if (value !== null && value !== undefined) rows.push([label, value, kind]);
  };
  add('Vertices', numberText(job.vertices));
  for (const name of STATUS_NAMES) {
    if (job[name] || name === 'inside' || name === 'outside') add(name, numberText(job[name]), 'sub' + (job[name] && name !== 'inside' ? ' warn' : ''));
  }
  if (job.unused) add('unused', numberText(job.unused), 'sub');
  if (job.hidden) add('of hidden nodes', numberText(job.hidden), 'sub');
  add('Moved', numberText(job.moved));
  if (job.displacement) add('Displacement', `max ${numberText(job.displacement.max)}, rms ${numberText(job.displacement.rms)}`);
  if (job.folds) {
    const {verdict, folded_cells: folded, unknown_cells: unknown, cells} = job.folds;
    const words = {none: 'none, proven', some: `in ${numberText(folded)} of ${countText(cells, 'cell')}`,
      unknown: `not proven in ${countText(unknown, 'cell')}`};
    add('Folds', words[verdict] || String(verdict), verdict === 'none' ? '' : 'bad');
    add('least det J', numberText(job.folds.min_det), 'sub');
  }
  add('Flipped faces', job.flipped_faces === null || job.flipped_faces === undefined ? null : numberText(job.flipped_faces), job.flipped_faces ? 'bad' : '');
  if (job.tear) {
    add('Torn edges', numberText(job.tear.edges), job.tear.edges ? 'bad' : '');
    if (job.tear.edges) add('largest step', numberText(job.tear.largest), 'sub');
    if (job.tear.edges && job.tear.part) add('of', nameElement(job.tear.part), 'sub');
  }
  if (job.det) add('det F', `${numberText(job.det.min)} to ${numberText(job.det.max)}`, job.det.min <= 0 ? 'bad' : '');
  if (job.det && job.det.outside !== null) add('least outside', numberText(job.det.outside), 'sub' + (job.det.outside <= 0 ? ' bad' : ''));
  if (job.edges) add('Edges beside the true surface', `max ${numberText(job.edges.deviation.max)}, mean ${numberText(job.edges.deviation.mean)}`);
  if (job.bounds) {
    add('Bounds before', boxText(job.bounds.before), 'wide');
    add('Bounds after', boxText(job.bounds.after), 'wide');
  }
  if (job.residual) add('Residual', `max ${numberText(job.residual.max, 2)}, rms ${numberText(job.residual.rms, 2)}`);
  for (const kind of job.behind || []) add('Stays: ' + String(kind.kind).replace('_', ' '), numberText(kind.count), 'warn');
  return rows;
}

function figureSection(viewer) {
  const {scene} = viewer;
  const job = jobOf(scene.report);
  const list = make('dl', 'figures');
  const rows = job ? figureRows(job) : [['Vertices', numberText(scene.verticesAll), '']];
  if (!job && scene.vertices && hasTwoShapes(scene) && !scene.edit) rows.push(['Displacement', 'max ' + numberText(scene.displacementMax), '']);
  rows.push(['Triangles', numberText(scene.trianglesAll), '']);
  for (const [label, value, kind] of rows) list.append(make('div', kind, make('dt', '', label), make('dd', '', value)));
  const card = section('Figures', list);
  card.id = 'figures';
  for (const cage of scene.cages) {
    const line = make('p', 'more', 'Lattice ', nameElement(cage.name), `: ${cage.size.join(' \u00d7 ')} control points`);
    card.append(line);
  }
  card.append(make('p', 'more', `ffd ${scene.program}`));
  return card;
}

function chip(kind, text) {
  return make('span', 'chip ' + kind, text);
}

// The line below the name: what one has to know first.
function showVerdicts(scene) {
  const job = jobOf(scene.report);
  const line = byId('verdicts');
  const chips = [];
  // What matters most comes first: that the lattice does nothing here.
  if (job && job.vertices && job.inside === 0) chips.push(chip('bad', 'The lattice does not touch this model'));
  else if (job && job.vertices && job.moved === 0) chips.push(chip('bad', 'Nothing moved'));
  if (job && job.folds) {
    const words = {none: ['good', 'No folds, proven'], some: ['bad', 'The volume folds'], unknown: ['warn', 'Folds: not proven']};
    chips.push(chip(...(words[job.folds.verdict] || ['warn', 'Folds: ?'])));
  } else if (scene.witness) chips.push(chip('bad', 'The volume folds'));
  if (scene.tearEdges) chips.push(chip('bad', countText(scene.tearEdges, 'torn edge')));
  if (scene.flippedFaces) chips.push(chip('bad', countText(scene.flippedFaces, 'face') + ' turned over'));
  if (job && job.outside) chips.push(chip('warn', `${numberText(job.outside)} outside`));
  if (job && job.invalid) chips.push(chip('bad', `${numberText(job.invalid)} not finite`));
  if (scene.displacementMax) chips.push(chip('', `Displacement to ${numberText(scene.displacementMax)}`));
  line.replaceChildren(...chips);
}

function showPanel(viewer) {
  const {scene} = viewer;
  const cards = [];
  if (scene.notices.length) {
    const card = section('Not all is shown', ...scene.notices.map((text) => make('p', '', text.charAt(0).toUpperCase() + text.slice(1) + '.')));
    card.classList.add('notice');
    card.id = 'notice';
    cards.push(card);
  }
  if (viewer.renderer) cards.push(targetSection(viewer), colorSection(viewer), showSection(viewer));
  if (viewer.renderer) cards.push(findingSection(viewer));
  if (viewer.renderer) cards.push(partSection(viewer));
  cards.push(figureSection(viewer));
  byId('panel').replaceChildren(...cards.filter(Boolean));
  if (viewer.tools) viewer.tools.showCards(byId('panel'));
}
