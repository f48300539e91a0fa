// The page of a report: one position, in the 3D view, the charts and the table.
//
// For scripts there is `window.kintrafo`, in SI units; values of curves are in those of the page:
//   state()  { travel, rack, time, playing, byHand, wheelCenter, curves: { name: value } };
//            wheelCenter is that of the drawn wheel, null without WebGL
//   set({ travel, rack }) or set({ time })   moves like the sliders
//   play(), pause(), look("corner" | "front" | "side" | "top")

import { connectCharts } from "./charts.js";
import { connectControls } from "./controls.js";
import { inUnit, reading } from "./format.js";
import { Axis, Grid } from "./grid.js";
import { readPayload } from "./payload.js";
import { Player } from "./player.js";
import { Position } from "./position.js";
import { connectPrinting } from "./print.js";
import { View, hasWebGL } from "./view.js";

const data = readPayload();
if (data.motion) data.motion.axis = new Axis(data.motion.time);
const position = new Position(new Grid(data.grid), data.motion);
const player = new Player(position);
const view = makeView();

connectControls(position, player);
const charts = connectCharts(data, position, (key, value) => {
  if (key === "time") position.setTime(value);
  else position.setByHand({ [key]: value });
});
connectTable();
connectPrinting({ data, view, charts, position });
position.setByHand({});
document.documentElement.classList.add("alive");

function makeView() {
  const host = document.getElementById("view");
  if (!hasWebGL()) {
    host.classList.add("flat");
    return null;
  }
  const made = new View(host, data, position);
  for (const button of document.querySelectorAll("[data-look]")) {
    button.addEventListener("click", () => made.look(button.dataset.look));
  }
  const through = document.getElementById("through");
  through.addEventListener("click", () => made.lookThroughWheel(!made.throughWheel));
  made.onLook = () => through.setAttribute("aria-pressed", String(made.throughWheel));
  made.onLook();
  return made;
}

/** The column of the summary at the present position. */
function connectTable() {
  const cells = [...document.querySelectorAll("[data-now]")].map((cell) => [
    cell,
    data.curves.find(({ key }) => key === cell.dataset.now),
  ]);
  position.onChange(() => {
    const sampled = position.grid.hits(position.travel, position.rack);
    for (const [cell, curve] of cells) {
      cell.textContent = reading(curve, value(curve), sampled, { unit: "" });
    }
  });
}

function value(curve) {
  return inUnit(curve, position.grid.valueAt(curve, position.travel, position.rack));
}

window.kintrafo = {
  state: () => ({
    travel: position.travel,
    rack: position.rack,
    time: position.time,
    playing: player.playing,
    byHand: position.byHand,
    wheelCenter: view?.wheelCenter() ?? null,
    curves: Object.fromEntries(data.curves.map((curve) => [curve.key, value(curve)])),
  }),
  set: (wanted) => ("time" in wanted ? position.setTime(wanted.time) : position.setByHand(wanted)),
  play: () => player.play(),
  pause: () => player.pause(),
  look: (from) => view?.look(from),
};
