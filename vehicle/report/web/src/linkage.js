// Links and springs of the wheel, by the names of points as in the data of the page.

import { nearestOnLine } from "./geometry.js";

/** A point by name; of three names, the foot of the first on the line through the others. */
function at(place, points) {
  return Array.isArray(place) ? nearestOnLine(...place.map((n) => points[n])) : points[place];
}

export class Linkage {
  #data;

  constructor(data) {
    this.#data = data;
  }

  build(mechanism) {
    const { arms, brackets } = this.#data;
    for (const arm of arms) mechanism.buildArm(...arm);
    mechanism.buildBars(Object.keys(brackets), "arm");
    mechanism.buildSpringAndDamper();
  }

  pose(mechanism, points) {
    const { arms, brackets, damper, spring } = this.#data;
    for (const arm of arms) mechanism.poseArm(points, ...arm);
    for (const [name, [from, to]] of Object.entries(brackets)) {
      mechanism.poseBar(name, at(from, points), at(to, points));
    }
    const foot = at(damper.foot, points);
    mechanism.poseDamper(foot, points[damper.top], along(damper, mechanism.design));
    const seat = at(spring.foot, points);
    const top = points[spring.top];
    const axis = top.clone().sub(seat).normalize();
    mechanism.poseSpring(seat.clone().addScaledVector(axis, along(spring, mechanism.design)), top);
  }

  /** The two ends of the knuckle, with the wheel between them. */
  upright(points) {
    return this.#data.upright.map((place) => at(place, points));
  }

  /** Two points on the steering axis; null if there are none. */
  steeringAxis(points) {
    return this.#data.steering_axis?.map((name) => points[name]) ?? null;
  }
}

/** Distance from the foot, a part of the length at design [m]. */
function along({ foot, top, part }, design) {
  return part * at(foot, design).distanceTo(design[top]);
}
