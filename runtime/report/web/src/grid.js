// Interpolation on the grid: cubic in each direction. grid.py does the same arithmetic, and
// measures its error against the compiled model when the page is written.

const ORDER = 4;

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

  /** First of the four neighbours, and Lagrange's cubic polynomials there. */
  weights(where) {
    const place = (where - this.first) / this.step;
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

  /** One interpolated value; with `size` components a sample, that of one component. */
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
