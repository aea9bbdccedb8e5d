// spline.js - B-spline basis functions of one direction of a lattice (The NURBS Book, A2.1 to A2.3).

class Direction {
  constructor(degree, knots, size) {
    this.degree = degree;
    this.knots = knots;
    this.size = size;
    this.functions = knots.length - degree - 1;
    this.first = knots[degree];
    this.last = knots[this.functions];
    this.left = new Float64Array(degree + 1);
    this.right = new Float64Array(degree + 1);
  }

  // The span s with t_s <= u < t_(s+1); beyond the domain, and at its end, the nearest one that is not empty.
  span(u) {
    const {knots, degree, functions} = this;
    if (!(u > this.first)) {
      let s = degree;
      while (s + 1 < functions && !(knots[s + 1] > knots[s])) s++;
      return s;
    }
    let low = degree, high = functions;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (u < knots[middle]) high = middle;
      else low = middle;
    }
    while (low > degree && !(knots[low + 1] > knots[low])) low--;
    return low;
  }

  // The functions span - degree to span at u, of this degree.
  basis(span, u, values) {
    this.raise(span, u, this.degree, values);
  }

  raise(span, u, degree, values) {
    const {knots, left, right} = this;
    values[0] = 1;
    for (let j = 1; j <= degree; j++) {
      left[j] = u - knots[span + 1 - j];
      right[j] = knots[span + j] - u;
      let saved = 0;
      for (let r = 0; r < j; r++) {
        const share = values[r] / (right[r + 1] + left[j - r]);
        values[r] = saved + right[r + 1] * share;
        saved = left[j - r] * share;
      }
      values[j] = saved;
    }
  }

  // Their derivatives; `lower` is memory for as many numbers.
  slopes(span, u, lower, values) {
    const {knots, degree} = this;
    this.raise(span, u, degree - 1, lower);
    for (let r = 0; r <= degree; r++) {
      const i = span - degree + r;
      const before = r > 0 ? lower[r - 1] / (knots[i + degree] - knots[i]) : 0;
      const after = r < degree ? lower[r] / (knots[i + degree + 1] - knots[i + 1]) : 0;
      values[r] = degree * (before - after);
    }
  }

  // The control point of a function: a closed direction comes round.
  pointOf(index) {
    return index % this.size;
  }
}
