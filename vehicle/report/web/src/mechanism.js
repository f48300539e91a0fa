// The bodies of the suspension as simple solids, in metres, in the axes of the chassis.

import {
  BoxGeometry,
  BufferGeometry,
  CatmullRomCurve3,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  LatheGeometry,
  Line,
  Line3,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  TubeGeometry,
  Vector2,
  Vector3,
} from "three";

import { UP, nearestOnLine, place } from "./geometry.js";
import { Linkage } from "./linkage.js";
import { colour } from "./theme.js";

// Shapes of bodies in the drawing, which the model does not have [m].
const ARM = 0.012;
const BAR = 0.013;
const ROD = 0.009;
const JOINT = 0.017;
const TUBE = 0.023;
const PISTON = 0.01;
const MOUNT = 0.02; // height of the upper mount, under which the spring ends
const COIL = 0.058;
const WIRE = 0.006;
const TURNS = 5.5;
const SPOKES_AT = 0.34; // from the middle of the tyre outboard, as part of its width
const GLASS = 0.22; // opacity of a wheel that is looked through

const MATERIALS = [
  "arm",
  "knuckle",
  "strut",
  "spring",
  "rod",
  "rack",
  "tyre",
  "rim",
  "chassis",
  "pad",
];

// Points of the steering linkage that its parts join.
const STEERING_LINKAGE = {
  pitman_arm: ["pitman_pivot", "pitman_ball"],
  relay_rod: ["pitman_ball", "idler_ball"],
  idler_arm: ["idler_pivot", "idler_ball"],
};

export class Mechanism extends Group {
  #solids = {};
  #unit = new CylinderGeometry(1, 1, 1, 24);
  #ball = new SphereGeometry(1, 24, 16);

  constructor(data) {
    super();
    this.data = data;
    this.materials = Object.fromEntries(
      MATERIALS.map((name) => [
        name,
        new MeshStandardMaterial({ roughness: 0.65, metalness: 0.05 }),
      ]),
    );
    this.lines = { axis: new LineBasicMaterial(), path: new LineBasicMaterial() };
    this.recolour();
    const atDesign = Object.entries(data.points).map(([n, { design }]) => [
      n,
      new Vector3(...design),
    ]);
    this.design = Object.fromEntries(atDesign);
    this.linkage = new Linkage(data.linkage);
    this.linkage.build(this);
    this.#buildKnuckle();
    if (data.steered) this.#buildSteering();
    this.wheel = this.#buildWheel(data.tyre);
    this.pad = this.#solid("pad", new BoxGeometry(0.46, 0.34, 0.012));
    this.axis = this.#line("axis", 2);
    this.path = this.#line("path", data.grid.travel.count);
  }

  recolour() {
    for (const [name, material] of Object.entries(this.materials)) material.color.set(colour(name));
    this.lines.axis.color.set(colour("muted"));
    this.lines.path.color.set(colour("accent"));
  }

  /** Make the wheel solid, or transparent. */
  lookThroughWheel(through) {
    for (const name of ["tyre", "rim"]) {
      const material = this.materials[name];
      material.transparent = through;
      material.opacity = through ? GLASS : 1;
      material.depthWrite = !through;
      material.needsUpdate = true;
    }
  }

  /** Move all parts to points by name and the axis of the wheel, as Vector3. */
  pose(points, spinAxis, spin, roadHeight) {
    this.linkage.pose(this, points);
    this.#poseKnuckle(points);
    if (this.data.steered) this.#poseSteering(points);
    this.#poseWheel(points.wheel_center, spinAxis, spin);
    this.pad.position.set(points.wheel_center.x, points.wheel_center.y, roadHeight - 0.006);
    this.#poseSteeringAxis(this.linkage.steeringAxis(points), roadHeight);
  }

  /** Draw the path of the wheel centre. */
  showPath(values) {
    this.path.geometry.setAttribute("position", new Float32BufferAttribute(values, 3));
    this.path.geometry.computeBoundingSphere();
  }

  // -- building ---------------------------------------------------------------------------------

  #solid(material, geometry) {
    const mesh = new Mesh(geometry, this.materials[material]);
    this.add(mesh);
    return mesh;
  }

  #cylinder(name, material, radius) {
    const mesh = this.#solid(material, this.#unit);
    mesh.userData.radius = radius;
    this.#solids[name] = mesh;
  }

  #joint(name, material, radius = JOINT) {
    const mesh = this.#solid(material, this.#ball);
    mesh.scale.setScalar(radius);
    this.#solids[name] = mesh;
  }

  #line(material, count) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(new Float32Array(3 * count), 3));
    const line = new Line(geometry, this.lines[material]);
    line.frustumCulled = false;
    this.add(line);
    return line;
  }

  /** An arm between two bearings on the chassis and its tip. */
  buildArm(front, rear, tip) {
    for (const name of [front, rear]) {
      this.#cylinder(name, "arm", ARM);
      this.#cylinder(`${name}_bearing`, "chassis", 0.02);
    }
    this.#joint(tip, "arm", 0.019);
  }

  buildBars(names, material) {
    for (const name of names) this.#cylinder(name, material, BAR);
  }

  /** Tube and piston, with a spring around or beside them. */
  buildSpringAndDamper() {
    this.#cylinder("tube", "strut", TUBE);
    this.#cylinder("piston", "strut", PISTON);
    this.#cylinder("seat", "strut", COIL + 0.01);
    this.#cylinder("top_mount", "chassis", COIL + 0.014);
    this.spring = this.#solid("spring", coil());
  }

  #buildKnuckle() {
    this.buildBars(["upright", "spindle", "lower_web"], "knuckle");
    if (this.data.steered) this.buildBars(["steering_arm"], "knuckle");
    this.#solids.spindle.userData.radius = 0.021;
    this.#joint("hub", "knuckle", 0.034);
  }

  #buildSteering() {
    this.#cylinder("tie_rod", "rod", ROD);
    this.#joint("tie_rod_outer", "rod");
    this.#joint("tie_rod_inner", "rod");
    if (this.data.on_rack) {
      this.#cylinder("rack", "rack", 0.012);
      this.#cylinder("rack_housing", "chassis", 0.021);
    } else {
      this.buildBars([...Object.keys(STEERING_LINKAGE), "relay_lug"], "rack");
      for (const name of ["pitman_ball", "idler_ball"]) this.#joint(name, "rack");
      for (const name of ["pitman_pivot", "idler_pivot"]) this.#joint(name, "chassis");
    }
  }

  #buildWheel({ radius, width }) {
    const wheel = new Group();
    const rim = radius - 0.105;
    const tyre = new Mesh(tyreGeometry(radius, rim, width), this.materials.tyre);
    tyre.userData.handle = true;
    wheel.add(tyre);
    const barrel = new Mesh(
      new CylinderGeometry(rim, rim, width * 0.86, 64, 1, true),
      this.materials.rim,
    );
    this.materials.rim.side = 2; // the barrel is seen from inside too
    barrel.userData.handle = true;
    wheel.add(barrel);
    for (let k = 0; k < 5; k += 1) wheel.add(this.#spoke(k, rim, width));
    const cap = new Mesh(new CylinderGeometry(0.05, 0.05, 0.024, 48), this.materials.rim);
    cap.position.y = this.data.side_sign * width * SPOKES_AT;
    cap.userData.handle = true;
    wheel.add(cap);
    this.add(wheel);
    return wheel;
  }

  /** A spoke near the outer face, to show the spin. */
  #spoke(k, rim, width) {
    const outboard = this.data.side_sign; // the wheel's own y axis points left
    const spoke = new Mesh(new BoxGeometry(0.045, 0.018, rim), this.materials.rim);
    const turned = new Group();
    spoke.position.set(0, outboard * width * SPOKES_AT, rim / 2);
    spoke.userData.handle = true;
    turned.add(spoke);
    turned.rotation.y = (2 * Math.PI * k) / 5;
    return turned;
  }

  // -- posing -----------------------------------------------------------------------------------

  poseBar(name, from, to) {
    place(this.#solids[name], from, to, this.#solids[name].userData.radius);
  }

  poseArm(points, front, rear, tip) {
    const hinge = points[front].clone().sub(points[rear]).normalize();
    for (const name of [front, rear]) {
      this.poseBar(name, points[name], points[tip]);
      const half = hinge.clone().multiplyScalar(0.028);
      this.poseBar(
        `${name}_bearing`,
        points[name].clone().sub(half),
        points[name].clone().add(half),
      );
    }
    this.#solids[tip].position.copy(points[tip]);
  }

  /** Tube from its foot to a distance along the axis [m], and piston from there to the mount. */
  poseDamper(foot, top, tube) {
    const along = top.clone().sub(foot).normalize();
    const end = foot.clone().addScaledVector(along, tube);
    this.poseBar("tube", foot, end);
    this.poseBar("piston", end, top);
    this.poseBar("top_mount", top.clone().addScaledVector(along, -MOUNT), top);
  }

  poseSpring(seat, top) {
    const along = top.clone().sub(seat).normalize();
    this.poseBar("seat", seat.clone().addScaledVector(along, -0.008), seat);
    place(this.spring, seat, top.clone().addScaledVector(along, -MOUNT), 1);
  }

  /** The knuckle between its joints: an upright, and arms to the wheel and to the tie rod. */
  #poseKnuckle(points) {
    const [foot, head] = this.linkage.upright(points);
    const middle = nearestOnLine(points.wheel_center, foot, head);
    this.poseBar("upright", foot, head);
    this.poseBar("spindle", middle, points.wheel_center);
    this.poseBar("lower_web", foot, points.wheel_center);
    if (this.data.steered) this.poseBar("steering_arm", middle, points.tie_rod_outer);
    this.#solids.hub.position.copy(points.wheel_center);
  }

  #poseSteering(points) {
    for (const name of ["tie_rod_outer", "tie_rod_inner"]) {
      this.#solids[name].position.copy(points[name]);
    }
    this.poseBar("tie_rod", points.tie_rod_outer, points.tie_rod_inner);
    if (!this.data.on_rack) {
      this.#poseLinkage(points);
      return;
    }
    const inward = new Vector3(...this.data.rack_inward);
    const inner = points.tie_rod_inner;
    this.poseBar("rack", inner, inner.clone().addScaledVector(inward, 0.2));
    const housing = this.design.tie_rod_inner;
    this.poseBar(
      "rack_housing",
      housing.clone().addScaledVector(inward, 0.1),
      housing.clone().addScaledVector(inward, 0.3),
    );
  }

  /** A Pitman arm, its idler arm, and the relay rod between them with the end of the tie rod. */
  #poseLinkage(points) {
    for (const [name, [from, to]] of Object.entries(STEERING_LINKAGE)) {
      this.poseBar(name, points[from], points[to]);
      for (const end of [from, to]) this.#solids[end].position.copy(points[end]);
    }
    const rod = new Line3(points.pitman_ball, points.idler_ball);
    const tip = points.tie_rod_inner;
    this.poseBar("relay_lug", rod.closestPointToPoint(tip, true, new Vector3()), tip);
  }

  #poseWheel(center, spinAxis, spin) {
    const aligned = new Quaternion().setFromUnitVectors(UP, spinAxis);
    const spun = new Quaternion().setFromAxisAngle(UP, spin);
    this.wheel.position.copy(center);
    this.wheel.quaternion.copy(aligned).multiply(spun);
  }

  #poseSteeringAxis(line, roadHeight) {
    this.axis.visible = line !== null;
    if (!this.axis.visible) return;
    const [foot, top] = line;
    const along = top.clone().sub(foot);
    const ground = foot.clone().addScaledVector(along, (roadHeight - foot.z) / along.z);
    const above = top.clone().addScaledVector(along.normalize(), 0.08);
    const ends = this.axis.geometry.attributes.position;
    ends.setXYZ(0, ...ground.toArray());
    ends.setXYZ(1, ...above.toArray());
    ends.needsUpdate = true;
  }
}

/** A spring of unit length; stretching it flattens its wire slightly. */
function coil() {
  const points = [];
  const count = Math.round(TURNS * 16);
  const length = 0.22; // about that of the drawn one, so that its wire is round
  for (let i = 0; i <= count; i += 1) {
    const angle = (2 * Math.PI * TURNS * i) / count;
    points.push(
      new Vector3(COIL * Math.cos(angle), (i / count - 0.5) * length, COIL * Math.sin(angle)),
    );
  }
  const geometry = new TubeGeometry(new CatmullRomCurve3(points), 5 * count, WIRE, 8);
  return geometry.scale(1, 1 / length, 1);
}

/** The section of the tyre, turned about the wheel's axis. */
function tyreGeometry(radius, rim, width) {
  const half = width / 2;
  const section = [
    [rim, -0.86 * half],
    [rim + 0.25 * (radius - rim), -0.98 * half],
    [rim + 0.62 * (radius - rim), -half],
    [radius - 0.018, -0.93 * half],
    [radius - 0.005, -0.82 * half],
    [radius, -0.6 * half],
    [radius, 0.6 * half],
    [radius - 0.005, 0.82 * half],
    [radius - 0.018, 0.93 * half],
    [rim + 0.62 * (radius - rim), half],
    [rim + 0.25 * (radius - rim), 0.98 * half],
    [rim, 0.86 * half],
  ];
  return new LatheGeometry(
    section.map(([r, y]) => new Vector2(r, y)),
    96,
  );
}
