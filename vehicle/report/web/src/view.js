// The 3D view: camera, light, orbiting, and dragging the wheel.

import {
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { Mechanism } from "./mechanism.js";
import { colour, onSchemeChange } from "./theme.js";

const KEY_STEP = 0.0025; // of wheel travel and rack with the arrow keys [m]

/** Whether this browser can draw in three dimensions. */
export function hasWebGL() {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
}

export class View {
  #pending = false;
  #grabbed = null;
  #pathAt = null;

  constructor(host, data, position) {
    Object.assign(this, { host, data, position });
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    host.prepend(this.renderer.domElement);
    this.mechanism = new Mechanism(data);
    this.scene = new Scene();
    this.scene.add(this.mechanism);
    this.camera = new PerspectiveCamera(30, 1, 0.05, 20);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera);
    this.#light();
    this.#ground();
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.render());
    this.#listen();
    this.look("corner");
    position.onChange(() => this.update());
    onSchemeChange(() => this.recolour());
    new ResizeObserver(() => this.#resize()).observe(host);
  }

  /** Move the mechanism to the position. */
  update() {
    const { grid, travel, rack, spin, byHand } = this.position;
    const points = {};
    for (const [name, { values }] of Object.entries(this.data.points)) {
      points[name] = new Vector3(...grid.vectorAt(values, travel, rack));
    }
    const axis = new Vector3(
      ...grid.vectorAt(this.data.spin_axis.values, travel, rack),
    ).normalize();
    // by hand the plate lifts the wheel, as on a test rig; in the simulation the road does
    const plate = byHand ? travel : 0;
    this.mechanism.pose(points, axis, spin, this.data.road_height + plate);
    if (rack !== this.#pathAt) this.#showPath(rack);
    this.render();
  }

  #showPath(rack) {
    const { grid } = this.position;
    const samples = this.data.points.wheel_center.values;
    this.#pathAt = rack;
    this.mechanism.showPath(
      Array.from(grid.travel.values, (travel) => grid.vectorAt(samples, travel, rack)).flat(),
    );
  }

  /** The centre of the drawn wheel in the axes of the chassis [m]. */
  wheelCenter() {
    this.scene.updateMatrixWorld();
    return new Vector3().setFromMatrixPosition(this.mechanism.wheel.matrixWorld).toArray();
  }

  /** Look from a named side; the wheel becomes transparent if it hides the linkage. */
  look(from) {
    this.moved = false;
    this.lookingFrom = from;
    this.#placeCamera(from);
    this.lookThroughWheel(from !== "corner");
  }

  #placeCamera(from) {
    const side = this.data.side_sign;
    const directions = {
      corner: [1.0, -0.72 * side, 0.5],
      front: [1, 0, 0.0001],
      side: [0, side, 0.0001],
      top: [-0.0001, 0, 1],
    };
    const target = new Vector3(...this.data.middle);
    const away = new Vector3(...directions[from]).normalize();
    // the vertical field of view is constant: a narrow window needs more distance
    const distance = this.data.size * 2.05 * Math.max(1, 1.16 / this.camera.aspect);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(away, distance);
    this.controls.update();
  }

  lookThroughWheel(through) {
    this.throughWheel = through;
    this.mechanism.lookThroughWheel(through);
    this.onLook?.();
    this.render();
  }

  render() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.renderer.render(this.scene, this.camera);
    });
  }

  #light() {
    this.sky = new HemisphereLight(0xffffff, 0x888888, 1.9);
    this.sky.position.set(0, 0, 1);
    const lamp = new DirectionalLight(0xffffff, 1.7);
    lamp.position.set(0.6, 0.9, 0.8);
    this.camera.add(lamp);
    this.camera.add(lamp.target);
    lamp.target.position.set(0, 0, -2);
    this.scene.add(this.sky);
  }

  #ground() {
    if (this.floor) this.scene.remove(this.floor);
    this.floor = new GridHelper(2, 20, colour("floor"), colour("floor"));
    this.floor.rotation.x = Math.PI / 2;
    this.floor.position.set(
      0,
      this.data.points.wheel_center.design[1],
      this.data.road_height - 0.014,
    );
    this.scene.add(this.floor);
  }

  /** Set the colours of the present scheme. */
  recolour() {
    this.mechanism.recolour();
    this.#ground();
    this.render();
  }

  /** The present view as the address of a picture with a number of pixels. */
  picture({ width, height }) {
    const { aspect } = this.camera;
    const ratio = this.renderer.getPixelRatio();
    const shown = this.renderer.getSize(new Vector2());
    this.recolour();
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    const address = this.renderer.domElement.toDataURL();
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(shown.x, shown.y);
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    this.render();
    return address;
  }

  #resize() {
    const width = this.host.clientWidth;
    // on a phone the style has room for words below the picture
    const height = this.host.clientHeight - parseFloat(getComputedStyle(this.host).paddingBottom);
    if (width === 0 || height <= 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.moved) this.#placeCamera(this.lookingFrom);
    this.render();
  }

  // -- dragging the wheel, keys -------------------------------------------------------------------

  #listen() {
    const canvas = this.renderer.domElement;
    // before OrbitControls: dragging the wheel does not turn the view
    canvas.addEventListener("pointerdown", (event) => this.#grab(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.#drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, () => this.#release());
    }
    this.controls.addEventListener("start", () => {
      this.moved = true;
    });
    this.host.addEventListener("keydown", (event) => this.#key(event));
  }

  #grab(event) {
    if (event.button !== 0 || !event.isPrimary) return;
    const hit = this.#hit(event);
    if (!hit) return;
    this.controls.enabled = false;
    this.#grabbed = {
      y: event.clientY,
      travel: this.position.travel,
      scale: this.#metresPerPixel(hit),
    };
    this.renderer.domElement.setPointerCapture(event.pointerId);
  }

  #drag(event) {
    if (!this.#grabbed) {
      this.renderer.domElement.style.cursor = this.#hit(event) ? "ns-resize" : "grab";
      return;
    }
    const { y, travel, scale } = this.#grabbed;
    this.position.setByHand({ travel: travel - (event.clientY - y) * scale });
  }

  #release() {
    this.#grabbed = null;
    this.controls.enabled = true;
  }

  #hit(event) {
    const frame = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(
      (2 * (event.clientX - frame.left)) / frame.width - 1,
      1 - (2 * (event.clientY - frame.top)) / frame.height,
    );
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const [first] = ray.intersectObject(this.mechanism, true).filter((hit) => hit.object.isMesh);
    return first?.object.userData.handle ? first : null;
  }

  #metresPerPixel({ distance }) {
    const height = 2 * distance * Math.tan((this.camera.fov * Math.PI) / 360);
    return height / this.renderer.domElement.clientHeight;
  }

  #key(event) {
    const steps = {
      ArrowUp: { travel: this.position.travel + KEY_STEP },
      ArrowDown: { travel: this.position.travel - KEY_STEP },
      ArrowLeft: { rack: this.position.rack + KEY_STEP },
      ArrowRight: { rack: this.position.rack - KEY_STEP },
    };
    if (event.target !== this.host || !(event.key in steps)) return;
    event.preventDefault();
    this.position.setByHand(steps[event.key]);
  }
}
