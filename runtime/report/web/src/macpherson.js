// What guides the wheel of a MacPherson suspension: a control arm and a strut.

import { nearestOnLine } from "./geometry.js";

// Drawing only: parts of the strut's design length, from where the knuckle holds it.
const TUBE = 0.585;
const SEAT = 0.46;
// A spring seat nearer to the ball joint stands for "in line with the strut", not for a place [m].
const OWN_SEAT = 0.05;

export function build(mechanism) {
  mechanism.buildArm("arm_front", "arm_rear", "ball_joint");
  mechanism.buildSpringAndDamper();
}

export function pose(mechanism, points) {
  mechanism.poseArm(points, "arm_front", "arm_rear", "ball_joint");
  const { design } = mechanism;
  const length = clamp(design).distanceTo(design.strut_top);
  const foot = clamp(points);
  const top = points.strut_top;
  mechanism.poseDamper(foot, top, TUBE * length);
  const along = top.clone().sub(foot).normalize();
  const own = points.spring_seat?.distanceTo(points.ball_joint) > OWN_SEAT;
  if (own) mechanism.poseSpring(points.spring_seat, points.spring_top);
  else mechanism.poseSpring(foot.clone().addScaledVector(along, SEAT * length), top);
}

/** The knuckle reaches from the ball joint to where it is drawn to hold the strut. */
export function upright(points) {
  return [points.ball_joint, clamp(points)];
}

export function steeringAxis(points) {
  return [points.ball_joint, points.strut_top];
}

/** On the strut's axis, beside the wheel centre. */
function clamp({ ball_joint, strut_lower = ball_joint, strut_top, wheel_center }) {
  return nearestOnLine(wheel_center, strut_lower, strut_top);
}
