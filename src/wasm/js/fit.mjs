// Fits of points in memory: their options, and the report.
import {refuse} from './error.mjs';

const NUMBERS = ['pairs', 'used', 'outside', 'multiple', 'singular', 'exact', 'dependent', 'smooth', 'gcv', 'max', 'rms', 'p95', 'worst', 'residualExact',
  'largestOffset', 'pointsWithoutData', 'downweighted', 'spreadPositions', 'spreadLargest', 'flops', 'cells', 'minDet', 'relativeTo', 'foldedCells',
  'unknownCells', 'det'];
const REFERENCES = ['mean', 'bounds', 'place'];
const AUTO = 0, GIVEN = 1, WITHIN = 2;

// Options of a box, in place of a lattice.
const BOX = ['size', 'degree', 'knots', 'margin'];
const OPTIONS = ['lattice', ...BOX, 'smooth', 'within', 'weights', 'exact', 'handles', 'robust', 'symmetric', 'snap'];

const known = (number) => Number.isFinite(number) ? number : null;

// The member `fit` of a report. numbers: those of the core.
export function reportOf(numbers, chosenBy, verdict, robust) {
  const n = Object.fromEntries(NUMBERS.map((name, i) => [name, numbers[i]]));
  const vectors = Array.from({length: 7}, (_, i) => Array.from(numbers.slice(NUMBERS.length + 3 * i, NUMBERS.length + 3 * i + 3)));
  const [uvw, xyz, rest] = vectors.slice(4);
  return {
    pairs: n.pairs, used: n.used, outside: n.outside, multiple: n.multiple, singular: n.singular, exact: n.exact, dependent: n.dependent,
    smooth: n.smooth, smooth_chosen_by: chosenBy, gcv: known(n.gcv), affine: vectors.slice(0, 4),
    residual: {max: n.max, rms: n.rms, p95: n.p95, worst: n.worst}, residual_exact: known(n.residualExact), largest_offset: n.largestOffset,
    points_without_data: n.pointsWithoutData,
    folds: {verdict, cells: n.cells, min_det: known(n.minDet), relative_to: REFERENCES[n.relativeTo], folded_cells: n.foldedCells,
      unknown_cells: n.unknownCells, witness: verdict === 'some' ? {lattice: 0, uvw, xyz, rest, det: n.det} : null},
    downweighted: robust ? n.downweighted : null, spread: {positions: n.spreadPositions, largest: n.spreadLargest}, flops: n.flops,
  };
}

// The diagonal of the bounds of the points that are finite.
function diagonalOf(points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    if (![points[i], points[i + 1], points[i + 2]].every(Number.isFinite)) continue;
    for (let a = 0; a < 3; a++) {
      low[a] = Math.min(low[a], points[i + a]);
      high[a] = Math.max(high[a], points[i + a]);
    }
  }
  return Math.hypot(...high.map((x, a) => Math.max(x - low[a], 0)));
}

// A length, or the part of a diagonal that '1e-3r' is.
function length(value, name, diagonal) {
  const isPart = typeof value === 'string' && /^[\d.].*r$/.test(value);
  const given = isPart ? Number(value.slice(0, -1)) * diagonal() : typeof value === 'number' ? value : NaN;
  return given >= 0 ? given : refuse(`${name}: ${JSON.stringify(value)} is no length of at least 0`);
}

function smoothing(smooth, within, points) {
  if (smooth !== undefined && within !== undefined) refuse('smooth and within cannot be used together');
  if (within !== undefined) return {smoothing: WITHIN, within: length(within, 'within', () => diagonalOf(points))};
  if (smooth === undefined || smooth === 'auto') return {smoothing: AUTO};
  return typeof smooth === 'number' && smooth >= 0 ? {smoothing: GIVEN, smooth}
    : refuse(`smooth: ${JSON.stringify(smooth)} is neither 'auto' nor a number of at least 0`);
}

function weightsOf(weights, count) {
  if (weights === undefined || weights === null) return null;
  if (typeof weights === 'string') refuse('weights: a list of numbers, one for each pair');
  const list = Float64Array.from(weights);
  return list.length === count ? list : refuse(`weights: ${list.length} numbers, but ${count} pairs`);
}

function exactOf(exact, count) {
  const list = Array.from(exact), at = list.findIndex((i) => !Number.isInteger(i) || i < 0 || i >= count);
  return at < 0 ? Uint32Array.from(list) : refuse(`exact: ${list[at]} is no number of a pair`);
}

// What a caller asks for, as the core takes it.
export function settingsOf(source, options) {
  const unknown = Object.keys(options).find((name) => !OPTIONS.includes(name));
  if (unknown !== undefined) refuse(`fit: ${unknown} is no option of points (${OPTIONS.join(', ')})`);
  const {lattice, smooth, within, weights, exact = [], handles = false, robust = false, symmetric, snap = 0} = options;
  const box = Object.fromEntries(BOX.filter((name) => options[name] !== undefined).map((name) => [name, options[name]]));
  if (lattice && Object.keys(box).length > 0) refuse(`fit: the lattice has its own ${Object.keys(box)[0]}`);
  const direction = symmetric === undefined ? 0 : ['u', 'v', 'w'].indexOf(symmetric) + 1 || refuse(`symmetric: ${JSON.stringify(symmetric)} is not u, v or w`);
  const chosen = smoothing(smooth, within, source);
  return {
    lattice, box: {size: 6, knots: 'open', ...box}, weights: weightsOf(weights, source.length / 3), exact: exactOf(exact, source.length / 3),
    choices: Int32Array.of(handles ? 1 : 0, robust ? 1 : 0, direction, chosen.smoothing),
    lengths: (diagonal) => Float64Array.of(chosen.smooth ?? 0, chosen.within ?? 0, length(snap, 'snap', diagonal)),
  };
}
