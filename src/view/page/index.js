// index.js - sorts the jobs by a column, and the other way round at the second time.
const body = document.querySelector('tbody'), said = document.getElementById('said');
const jobs = [...body.rows];
const places = new Map(jobs.map((row, i) => [row, i]));
const texts = new Intl.Collator('en', {numeric: true});

// What a cell is sorted by; null where it has nothing. Values are text with numbers at every second place.
function keyOf(cell, kind) {
  const text = cell.textContent.trim();
  if (kind === 'text') return text || null;
  if (kind === 'values') return text ? text.split(/(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)/i).map((part, i) => i % 2 ? Number(part) : part) : null;
  return cell.dataset.key ? cell.dataset.key.split(' ').map(Number) : null;
}

function compareLists(a, b) {
  for (let i = 0; i < Math.min(a.length, b.length); i++) {
    if (a[i] !== b[i]) return typeof a[i] === 'number' ? a[i] - b[i] : texts.compare(a[i], b[i]);
  }
  return a.length - b.length;
}

// What is not known comes last in both directions. Equal jobs stay in the order of the manifest.
function sortBy(column, kind, direction) {
  const keys = new Map(jobs.map((row) => [row, keyOf(row.cells[column], kind)]));
  const compare = kind === 'text' ? texts.compare : compareLists;
  body.append(...jobs.sort((a, b) => {
    const x = keys.get(a), y = keys.get(b), order = places.get(a) - places.get(b);
    if (x === null || y === null) return (x === null) - (y === null) || order;
    return direction * compare(x, y) || order;
  }));
}

function choose(button) {
  const head = button.closest('th'), was = head.getAttribute('aria-sort');
  const first = button.dataset.first || 'ascending', other = first === 'ascending' ? 'descending' : 'ascending';
  const now = was === first ? other : first;
  for (const sorted of document.querySelectorAll('[aria-sort]')) sorted.removeAttribute('aria-sort');
  head.setAttribute('aria-sort', now);
  sortBy(head.cellIndex, button.dataset.kind, now === 'ascending' ? 1 : -1);
  said.textContent = `Sorted by ${button.textContent.toLowerCase()}, ${now}`;
}

document.getElementById('name').textContent = document.title;
document.getElementById('said').before(document.getElementById('counts'));
for (const button of document.querySelectorAll('thead button')) button.addEventListener('click', () => choose(button));
