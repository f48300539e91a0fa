// Draws a mechanism from the positions of its points, which have a row for each position of a slider.
const data = JSON.parse(document.getElementById("payload").textContent);
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7b5ea7", "#56a0d3", "#a6761d", "#666600"];
const INK = "#222222", GREY = "#8a8a8a", WIDE = 720, HIGH = 540;
const view = document.getElementById("view");
const moving = data.bodies.filter((body) => body !== data.ground);
const colours = Object.fromEntries(moving.map((body, i) => [body, COLOURS[i % COLOURS.length]]));
const sliders = [...document.querySelectorAll("input[data-scene]")];
let current = { scene: 0, index: 0 };

// -- numbers ----------------------------------------------------------------------------------

// display units: degrees and millimetres
const READ = { rad: [180 / Math.PI, "°"], "rad/s": [180 / Math.PI, "°/s"], m: [1000, "mm"], "m/s": [1, "m/s"] };
function read(unit) { return READ[unit] ?? [1, unit === "1" ? "" : unit]; }
function text(value, unit) {
  if (value === null) return "–";
  const [factor, sign] = read(unit);
  const shown = Number((value * factor).toPrecision(4));
  const far = Math.abs(shown) >= 1e6 || (shown !== 0 && Math.abs(shown) < 1e-3);
  return `${far ? shown.toExponential(2) : shown}`.replace("-", "−") + (sign ? ` ${sign}` : "");
}

// -- positions of points ----------------------------------------------------------------------

function placesOf({ scene, index }) {
  const { places, still } = data.scenes[scene];
  const found = { [data.ground]: still };
  for (const body of moving) {
    const row = places[body]?.[index] ?? [];
    found[body] = [];
    for (let i = 0; i < row.length; i += 3) found[body].push(row.slice(i, i + 3));
  }
  return found;
}
const box = { least: [Infinity, Infinity, Infinity], most: [-Infinity, -Infinity, -Infinity] };
data.scenes.forEach(({ values }, scene) => values.forEach((_, index) => {
  for (const points of Object.values(placesOf({ scene, index }))) for (const p of points) p.forEach((v, k) => {
    box.least[k] = Math.min(box.least[k], v);
    box.most[k] = Math.max(box.most[k], v);
  });
}));
const spans = box.most.map((v, k) => v - box.least[k]);
const size = Math.max(...spans);
const middle = box.most.map((v, k) => (v + box.least[k]) / 2);
const flat = [1, 2, 0].find((k) => spans[k] < 1e-6 * size);
// along the normal of a plane mechanism, else from the front above
let [turn, tilt] = { 1: [-90, 0], 2: [-90, 90], 0: [0, 0] }[flat] ?? [35, 18];
let scale = 1;
{
  const half = { 1: [0, 2], 2: [0, 1], 0: [1, 2] }[flat];
  const [w, h] = half ? half.map((k) => spans[k]) : [Math.hypot(spans[0], spans[1]), Math.hypot(...spans)];
  scale = 0.86 * Math.min(WIDE / Math.max(w, 1e-12), HIGH / Math.max(h, 1e-12));
}
function axes() {
  const [a, b] = [turn, tilt].map((angle) => (angle * Math.PI) / 180);
  const [s, c, sb, cb] = [Math.sin(a), Math.cos(a), Math.sin(b), Math.cos(b)];
  return { right: [-s, c, 0], up: [-sb * c, -sb * s, cb] };
}
function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
function seen(p) {
  const { right, up } = axes();
  const from = p.map((v, k) => v - middle[k]);
  return [WIDE / 2 + scale * dot(right, from), HIGH / 2 - scale * dot(up, from)];
}

// -- drawing ----------------------------------------------------------------------------------

function make(name, attributes, parent, words) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (words !== undefined) made.textContent = words;
  parent.append(made);
  return made;
}
function line(a, b, attributes, parent = view) {
  make("line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1], "stroke-linecap": "round", ...attributes }, parent);
}
function draw() {
  view.replaceChildren();
  const places = placesOf(current);
  const on = Object.fromEntries(Object.entries(places).map(([body, ps]) => [body, ps.map(seen)]));
  const at = ([body, point]) => on[body][data.points[body].indexOf(point)];
  for (const [a, b] of data.springs) spring(at(a), at(b));
  for (const [a, b] of data.guides) {
    const [p, q] = [at(a), at(b)];
    const half = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
    if (a[0] !== data.ground) line(p, half, { stroke: colours[a[0]], "stroke-width": 7, opacity: 0.6 });
    if (b[0] !== data.ground) line(half, q, { stroke: colours[b[0]], "stroke-width": 3 });
  }
  for (const body of moving) drawBody(on[body] ?? [], colours[body]);
  for (const p of on[data.ground] ?? []) {
    make("path", { d: `M${p[0]},${p[1]} l-9,15 h18 z`, fill: "#e3e3e3", stroke: GREY }, view);
  }
  for (const [body, points] of Object.entries(data.points)) points.forEach((point, i) => {
    if (!data.joints.includes(point) || !on[body]?.[i]) return;
    make("circle", { cx: on[body][i][0], cy: on[body][i][1], r: 4.5, fill: "white", stroke: INK, "stroke-width": 1.4 }, view);
  });
  for (const end of data.wheels) {
    const p = at(end);
    make("circle", { cx: p[0], cy: p[1], r: 10, fill: "none", stroke: INK, "stroke-width": 2 }, view);
  }
  triad();
  const scene = data.scenes[current.scene];
  make("text", { x: 16, y: 28, "font-size": 17, fill: INK }, view, `${scene.name} = ${text(scene.values[current.index], scene.unit)}`);
}
function drawBody(points, colour) {
  const style = { stroke: colour, "stroke-width": 5 };
  const own = points.filter((p, i) => points.findIndex((o) => Math.hypot(o[0] - p[0], o[1] - p[1]) < 0.5) === i);
  if (own.length === 1) make("rect", { x: own[0][0] - 12, y: own[0][1] - 8, width: 24, height: 16, rx: 3, fill: colour }, view);
  if (own.length === 2) line(own[0], own[1], style);
  if (own.length === 3) make("polygon", { points: own.join(" "), fill: colour, "fill-opacity": 0.25, "stroke-linejoin": "round", ...style, "stroke-width": 3.5 }, view);
  if (own.length > 3) {
    const center = [0, 1].map((k) => own.reduce((sum, p) => sum + p[k], 0) / own.length);
    for (const p of own) line(center, p, style);
  }
}
function spring(a, b) {
  const along = [b[0] - a[0], b[1] - a[1]], length = Math.hypot(...along) || 1, count = 14;
  const across = [(-along[1] / length) * 7, (along[0] / length) * 7];
  const path = [a];
  for (let i = 0; i < count; i += 1) {
    const share = 0.15 + (0.7 * (i + 0.5)) / count, side = i % 2 ? 1 : -1;
    path.push([a[0] + share * along[0] + side * across[0], a[1] + share * along[1] + side * across[1]]);
  }
  make("polyline", { points: [...path, b].join(" "), fill: "none", stroke: GREY, "stroke-width": 1.5 }, view);
}
function triad() {
  const { right, up } = axes();
  const long = [1, 2, 5].map((m) => m * 10 ** Math.floor(Math.log10(size / 5))).findLast((v) => v <= size / 5) ?? size / 5;
  const root = [64, HIGH - 56];
  ["x", "y", "z"].forEach((name, k) => {
    const tip = [root[0] + scale * long * right[k], root[1] - scale * long * up[k]];
    if (Math.hypot(tip[0] - root[0], tip[1] - root[1]) < 8) return;
    line(root, tip, { stroke: INK, "stroke-width": 1.2 });
    const away = [tip[0] + (tip[0] - root[0]) * 0.18, tip[1] + (tip[1] - root[1]) * 0.18 + 4];
    make("text", { x: away[0], y: away[1], "font-size": 13, "text-anchor": "middle" }, view, name);
  });
  make("text", { x: 16, y: HIGH - 14, "font-size": 13, fill: "#5c5c5c" }, view, `axes: ${text(long, "m")} long`);
}

// -- table and charts -------------------------------------------------------------------------

function fillTable() {
  const scene = data.scenes[current.scene];
  const rows = data.states.map((name, i) => [name, scene.states[i][current.index]]);
  rows.push(...Object.entries(scene.signals).map(([name, values]) => [name, values[current.index]]));
  const body = document.querySelector("#now tbody");
  body.replaceChildren(...rows.map(([name, value]) => {
    const row = document.createElement("tr");
    row.title = data.meanings[name] ?? "";
    for (const [tag, words] of [["th", name], ["td", text(value, data.units[name])]]) {
      const cell = document.createElement(tag);
      cell.textContent = words;
      if (tag === "td") cell.className = "number";
      row.append(cell);
    }
    return row;
  }));
}
const W = 320, H = 170, LEFT = 56, LOW = 34, TOP = 10, RIGHT = 12;
let chartsOf = -1;
let markers = [];
function charts() {
  const scene = data.scenes[current.scene];
  if (chartsOf !== current.scene) {
    chartsOf = current.scene;
    markers = [];
    document.getElementById("over").textContent = `Signals over ${scene.name}`;
    const known = Object.entries(scene.signals).filter(([, v]) => v.some((x) => x !== null));
    const moved = known.filter(([, v]) => !constant(v));
    const still = known.filter(([, v]) => constant(v)).map(([name]) => name);
    document.getElementById("charts").replaceChildren(...moved.map(([name, values]) => chart(scene, name, values)));
    document.getElementById("still").textContent =
      known.length === 0 ? "This mechanism declares no signals." : still.length ? `The same everywhere: ${still.join(", ")}.` : "";
  }
  for (const { mark, spot } of markers) {
    const at = spot(current.index);
    mark.setAttribute("visibility", at ? "visible" : "hidden");
    if (at) { mark.setAttribute("cx", at[0]); mark.setAttribute("cy", at[1]); }
  }
}
/** Return whether a curve varies by rounding errors only. */
function constant(values) {
  const known = values.filter((v) => v !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  return high - low <= Math.max(1e-9, 1e-5 * Math.max(Math.abs(low), Math.abs(high)));
}
function ticks(low, high) {
  const rough = (high - low) / 4, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
  const found = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * step; v += step) found.push(Number(v.toPrecision(6)));
  return found;
}
function chart(scene, name, values) {
  const [fx, ux] = read(scene.unit), [fy, uy] = read(data.units[name]);
  const xs = scene.values.map((v) => v * fx), ys = values.map((v) => (v === null ? null : v * fy));
  const known = ys.filter((v) => v !== null);
  let [low, high] = [Math.min(...known), Math.max(...known)];
  // a curve with small variation does not fill its chart
  const least = 1e-3 * Math.max(Math.abs(low), Math.abs(high), 1e-9);
  if (high - low < least) [low, high] = [low - least, high + least];
  const ends = [Math.min(...xs), Math.max(...xs)];
  const spot = (i) => ys[i] === null ? null : [
    LEFT + ((xs[i] - ends[0]) / (ends[1] - ends[0] || 1)) * (W - LEFT - RIGHT),
    H - LOW - ((ys[i] - low) / (high - low)) * (H - LOW - TOP),
  ];
  const figure = document.createElement("figure");
  const caption = document.createElement("figcaption");
  caption.textContent = `${name}${uy ? ` [${uy}]` : ""}`;
  caption.title = data.meanings[name] ?? "";
  figure.append(caption);
  const svg = make("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `${name} over ${scene.name}` }, figure);
  for (const v of ticks(low, high)) {
    const y = H - LOW - ((v - low) / (high - low)) * (H - LOW - TOP);
    line([LEFT, y], [W - RIGHT, y], { stroke: "#e6e6e6" }, svg);
    make("text", { x: LEFT - 5, y: y + 4, "text-anchor": "end", "font-size": 11 }, svg, `${v}`.replace("-", "−"));
  }
  for (const v of ticks(...ends)) {
    const x = LEFT + ((v - ends[0]) / (ends[1] - ends[0] || 1)) * (W - LEFT - RIGHT);
    make("text", { x, y: H - LOW + 14, "text-anchor": "middle", "font-size": 11 }, svg, `${v}`.replace("-", "−"));
  }
  make("text", { x: (LEFT + W) / 2, y: H - 4, "text-anchor": "middle", "font-size": 11 }, svg, `${scene.name}${ux ? ` [${ux}]` : ""}`);
  let path = "", pen = "M";
  ys.forEach((_, i) => {
    const at = spot(i);
    if (at) path += `${pen}${at[0].toFixed(1)},${at[1].toFixed(1)}`;
    pen = at ? "L" : "M";
  });
  make("path", { d: path, fill: "none", stroke: COLOURS[0], "stroke-width": 1.8 }, svg);
  markers.push({ mark: make("circle", { r: 4.5, fill: COLOURS[1], cx: 0, cy: 0 }, svg), spot });
  return figure;
}

// -- moving -----------------------------------------------------------------------------------

function designOf(scene) {
  if (data.scenes[scene].name === "time") return 0;
  return Math.floor((data.scenes[scene].values.length - 1) / 2);
}
function show(scene, index) {
  current = { scene, index };
  sliders.forEach((slider, i) => {
    slider.value = i === scene ? index : designOf(i);
    const { values, unit } = data.scenes[i];
    slider.nextElementSibling.textContent = text(values[slider.value], unit);
  });
  draw();
  fillTable();
  charts();
}
const play = document.getElementById("play"), speed = document.getElementById("speed");
const last = data.scenes.length - 1;
const playback = new Playback(play, speed, (index) => show(last, index));
sliders.forEach((slider, i) => slider.addEventListener("input", () => {
  playback.stop();
  show(i, Number(slider.value));
}));
const timed = data.scenes.length && data.scenes[last].name === "time";
play.hidden = speed.hidden = document.querySelector('label[for="speed"]').hidden = !timed;
play.addEventListener("click", () => {
  if (playback.isPlaying) return playback.stop();
  playback.start(data.scenes[last].values, current.scene === last ? current.index : 0);
});
document.getElementById("design").addEventListener("click", () => { playback.stop(); show(0, designOf(0)); });
onDrag(view, (about, upward) => {
  turn += about;
  tilt = Math.max(-90, Math.min(90, tilt + upward));
  draw();
});
for (const body of moving) {
  const item = document.createElement("li");
  item.style.setProperty("--colour", colours[body]);
  item.textContent = body.replaceAll("_", " ");
  document.getElementById("legend").append(item);
}
if (data.scenes.length) show(timed && last === 0 ? last : 0, designOf(0));
