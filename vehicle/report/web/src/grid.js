// Interpolation on the grid, cubic in each direction. grid.py has the same arithmetic, and measures
// its error against the compiled model when the page is written.

const ORDER = 4;
const HIT = 1e-6; // places as near to a sample as this are rounded to it [steps of the grid]

/** Equally spaced values of one coordinate. */
export class Axis {
  constructor({ first, step, count }) {
    Object.assign(this, { first, step, count });
    this.last = first + step * (count - 1);
    this.values = Float64Array.from({ length: count }, (_, i) => first + step * i);
  }

  clamp(where) {
    return Math.min(Math.max(where, this.first), this.last);
  }

  /** A coordinate in steps from the first value. */
  place(where) {
    return (where - this.first) / this.step;
  }

  /** First of the four neighbours, and Lagrange's cubic polynomials there. */
  weights(where) {
    const place = this.place(where);
    const first = Math.min(Math.max(Math.floor(place) - 1, 0), this.count - ORDER);
    const s = place - first;
    return {
      first,
      weights: [
        ((s - 1) * (s - 2) * (s - 3)) / -6,
        (s * (s - 2) * (s - 3)) / 2,
        (s * (s - 1) * (s - 3)) / -2,
        (s * (s - 1) * (s - 2)) / 6,
      ],
    };
  }

  /** Whether a value at a place is a sample, without interpolation. */
  hits(where) {
    const place = this.place(where);
    return Math.abs(place - Math.round(place)) < HIT;
  }

  /** Interpolate samples over this axis alone. */
  interpolate(samples, where) {
    const { first, weights } = this.weights(where);
    return weights.reduce((sum, weight, k) => sum + weight * samples[first + k], 0);
  }
}

/** Wheel travel by rack displacement; samples are stored travel by travel, rack by rack. */
export class Grid {
  constructor({ travel, rack }) {
    this.travel = new Axis(travel);
    this.rack = new Axis(rack);
  }

  /** Whether a position is a sample. */
  hits(travel, rack) {
    return this.travel.hits(travel) && this.rack.hits(rack);
  }

  /** One interpolated value; of samples with `size` components, that of one component. */
  at(samples, travel, rack, size = 1, component = 0) {
    const t = this.travel.weights(travel);
    const r = this.rack.weights(rack);
    let sum = 0;
    for (let i = 0; i < ORDER; i += 1) {
      for (let k = 0; k < ORDER; k += 1) {
        const index = (t.first + i) * this.rack.count + r.first + k;
        sum += t.weights[i] * r.weights[k] * samples[size * index + component];
      }
    }
    return sum;
  }

  /** One interpolated value of a curve, which may have a jump where one of its gaps closes. */
  valueAt({ values, gaps }, travel, rack) {
    const plain = this.at(values, travel, rack);
    if (gaps.length === 0) return plain;
    const here = gaps.map((gap) => this.at(gap, travel, rack) <= 0);
    const same = (index) => gaps.every((gap, k) => gap[index] <= 0 === here[k]);
    if (this.#neighbours(travel, rack).every(same)) return plain;
    return this.#oneSided(values, same, travel, rack) ?? plain;
  }

  /** Samples in the plain interpolation of a place. */
  #neighbours(travel, rack) {
    const [t, r] = [this.travel.weights(travel).first, this.rack.weights(rack).first];
    const four = [0, 1, 2, 3];
    return four.flatMap((i) => four.map((k) => (t + i) * this.rack.count + r + k));
  }

  /** A value from the points on the same side of a jump; null if there is none. */
  #oneSided(values, same, travel, rack) {
    const index = (line, column) => line * this.rack.count + column;
    const lines = Array.from({ length: this.travel.count }, (_, line) => line);
    const marked = (column) => lines.map((line) => same(index(line, column)));
    const columns = Array.from({ length: this.rack.count }, (_, column) => marked(column));
    const [line, column] = [this.travel.place(travel), this.rack.place(rack)];
    const across = run(
      columns.map((flags) => flags.includes(true)),
      column,
    );
    if (!across) return null;
    const found = indices(across).map((c) => {
      const along = run(columns[c], line);
      return combined(
        line - along.first,
        indices(along).map((i) => values[index(i, c)]),
      );
    });
    return combined(column - across.first, found);
  }

  /** The place at which a gap closes between neighbours of an axis, the other coordinate held. */
  closings({ gaps }, over, held) {
    const axis = this[over];
    const at = (gap, where) =>
      over === "travel" ? this.at(gap, where, held) : this.at(gap, held, where);
    return gaps.flatMap((gap) =>
      Array.from(axis.values.subarray(1), (high, i) => [axis.values[i], high])
        .filter(([low, high]) => at(gap, low) <= 0 !== at(gap, high) <= 0)
        .map(([low, high]) => bisected((where) => at(gap, where) <= 0, low, high)),
    );
  }

  /** An interpolated vector of three components. */
  vectorAt(samples, travel, rack) {
    return [0, 1, 2].map((component) => this.at(samples, travel, rack, 3, component));
  }

  /** The curve over all travels at one rack displacement. */
  overTravel(samples, rack) {
    const { first, weights } = this.rack.weights(rack);
    return Float64Array.from({ length: this.travel.count }, (_, i) =>
      weights.reduce((sum, w, k) => sum + w * samples[i * this.rack.count + first + k], 0),
    );
  }

  /** The curve over all rack displacements at one travel. */
  overRack(samples, travel) {
    const { first, weights } = this.travel.weights(travel);
    return Float64Array.from({ length: this.rack.count }, (_, j) =>
      weights.reduce((sum, w, k) => sum + w * samples[(first + k) * this.rack.count + j], 0),
    );
  }
}

/** The nearest neighbours of a place, up to four, all of them marked; null if there are none. */
function run(marked, place) {
  let nearest = null;
  marked.forEach((flag, i) => {
    if (flag && (nearest === null || Math.abs(i - place) < Math.abs(nearest - place))) nearest = i;
  });
  if (nearest === null) return null;
  let [low, high] = [nearest, nearest];
  while (marked[low - 1]) low -= 1;
  while (marked[high + 1]) high += 1;
  const first = Math.min(Math.max(Math.floor(place) - 1, low), Math.max(high + 1 - ORDER, low));
  return { first, last: Math.min(first + ORDER - 1, high) };
}

function indices({ first, last }) {
  return Array.from({ length: last - first + 1 }, (_, k) => first + k);
}

/** Lagrange's polynomial of neighbouring values, at a distance from the first in steps. */
function combined(s, values) {
  return values.reduce((sum, value, k) => {
    const weight = values.reduce(
      (w, _, other) => (other === k ? w : (w * (s - other)) / (k - other)),
      1,
    );
    return sum + weight * value;
  }, 0);
}

/** The place between two others at which a condition changes. */
function bisected(condition, low, high) {
  const before = condition(low);
  let [from, to] = [low, high];
  for (let count = 0; count < 50; count += 1) {
    const middle = 0.5 * (from + to);
    if (condition(middle) === before) from = middle;
    else to = middle;
  }
  return 0.5 * (from + to);
}
