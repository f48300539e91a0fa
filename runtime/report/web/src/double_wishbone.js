// What guides the wheel of a double wishbone suspension: two arms; the lower one carries the spring.

import { nearestOnLine } from "./geometry.js";

// Drawing only: parts of the spring's design length, from its lower end.
const TUBE = 0.5;
const SEAT = 0.32;

const ARMS = ["lower", "upper"].map((arm) => [
  `${arm}_arm_front`,
  `${arm}_arm_rear`,
  `${arm}_ball_joint`,
]);

export function build(mechanism) {
  for (const arm of ARMS) mechanism.buildArm(...arm);
  mechanism.buildBars(["front_bracket", "rear_bracket"], "arm");
  mechanism.buildSpringAndDamper();
}

export function pose(mechanism, points) {
  for (const arm of ARMS) mechanism.poseArm(points, ...arm);
  poseBrackets(mechanism, points);
  const { spring_seat: foot, spring_top: top } = points;
  const { design } = mechanism;
  const length = design.spring_seat.distanceTo(design.spring_top);
  mechanism.poseDamper(foot, top, TUBE * length);
  const along = top.clone().sub(foot).normalize();
  mechanism.poseSpring(foot.clone().addScaledVector(along, SEAT * length), top);
}

/** The lower arm is drawn to hold the spring between its legs. */
function poseBrackets(mechanism, { spring_seat: seat, lower_ball_joint: tip, ...points }) {
  for (const end of ["front", "rear"]) {
    const held = nearestOnLine(seat, tip, points[`lower_arm_${end}`]);
    mechanism.poseBar(`${end}_bracket`, held, seat);
  }
}

export function upright(points) {
  return [points.lower_ball_joint, points.upper_ball_joint];
}

export const steeringAxis = upright;
