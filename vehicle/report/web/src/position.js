// The one position in all parts of the page, and the listeners to its changes.

/**
 * Wheel travel [m], rack displacement [m], time [s] and spin angle [rad], set by hand (`byHand`) or
 * from the simulated second.
 */
export class Position {
  #listeners = [];

  constructor(grid, motion) {
    this.grid = grid;
    this.motion = motion;
    Object.assign(this, { travel: 0, rack: 0, time: 0, spin: 0, byHand: true });
  }

  onChange(listener) {
    this.#listeners.push(listener);
  }

  setByHand({ travel = this.travel, rack = this.rack }) {
    this.travel = this.grid.travel.clamp(travel);
    this.rack = this.grid.rack.clamp(rack);
    this.byHand = true;
    this.#tell();
  }

  /** The design position. */
  toDesign() {
    Object.assign(this, { time: 0, spin: 0 });
    this.setByHand({ travel: 0, rack: 0 });
  }

  setTime(time) {
    const { axis, travel, rack, spin } = this.motion;
    this.time = axis.clamp(time);
    this.travel = this.grid.travel.clamp(axis.interpolate(travel, this.time));
    this.rack = this.grid.rack.clamp(axis.interpolate(rack, this.time));
    this.spin = axis.interpolate(spin, this.time);
    this.byHand = false;
    this.#tell();
  }

  #tell() {
    for (const listener of this.#listeners) listener(this);
  }
}
