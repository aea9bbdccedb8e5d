// text.js - elements and texts. What comes from files is set as text only, never as markup.

function byId(id) {
  return document.getElementById(id);
}

// An element with a class and children: elements, or texts.
function make(tag, className, ...children) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  element.append(...children);
  return element;
}

// A name from a file; bdi keeps its direction of writing to itself.
function nameElement(name) {
  const element = make('bdi', 'name');
  element.textContent = name;
  element.title = name;
  return element;
}

// Numbers: at most `digits` significant ones, thousands apart in whole numbers.
function numberText(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  if (Number.isInteger(value) && Math.abs(value) < 1e15) {
    return String(value).replace(/\B(?=(\d{3})+$)/g, '\u202f').replace('-', '\u2212');
  }
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
  return text.replace('-', '\u2212').replace('e+', 'e').replace('e-', 'e\u2212');
}

function pointText(point, digits = 5) {
  return point.map((x) => numberText(x, digits)).join(', ');
}

// "1 edge", "12 edges"
function countText(count, one, many = one + 's') {
  return numberText(count) + '\u00a0' + (count === 1 ? one : many);
}

// Whether the user asked the system for less motion.
function wantsStillness() {
  return window.matchMedia('(prefers-reduced-motion: reduce)').matches;
}
