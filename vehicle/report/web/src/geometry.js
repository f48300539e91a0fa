// Placing solids between points, in the axes of the chassis.

import { Vector3 } from "three";

export const UP = new Vector3(0, 1, 0); // the axis of three's cylinders and of the wheel's own axes

/** Stretch a solid of unit length between two points; hidden if they coincide. */
export function place(mesh, from, to, radius) {
  const along = to.clone().sub(from);
  const length = along.length();
  mesh.visible = length > 0;
  if (!mesh.visible) return;
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
  mesh.scale.set(radius, length, radius);
}

export function nearestOnLine(point, from, to) {
  const along = to.clone().sub(from).normalize();
  return from.clone().addScaledVector(along, point.clone().sub(from).dot(along));
}
