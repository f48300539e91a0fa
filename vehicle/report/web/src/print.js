// Printing: a picture of the mechanism and all charts at the present position, in light colours;
// the screen is restored afterwards.

import { quantity } from "./format.js";
import { marks, placed, shape } from "./marks.js";

const PICTURE = { width: 1500, height: 1000 }; // sharp on paper, half a page high [px]

export function connectPrinting({ data, view, charts, position }) {
  const root = document.documentElement;
  let closed = []; // those that printing has opened
  window.addEventListener("beforeprint", () => {
    root.classList.add("printing"); // light colours, which all that is drawn asks for
    // all but the definitions below the charts
    closed = [...document.querySelectorAll("details:not([open])")].filter(
      (details) => !details.closest("figure"),
    );
    for (const details of closed) details.open = true;
    showPicture(view, position, data.steering);
    for (const chart of charts) chart.print();
  });
  window.addEventListener("afterprint", () => {
    root.classList.remove("printing");
    for (const details of closed) details.open = false;
    view?.recolour();
    for (const chart of charts) chart.rebuild();
  });
}

function showPicture(view, { travel, rack, time, byHand }, steering) {
  const place = (value) => quantity(value * 1e3, 1, "mm", { signed: true });
  const steered = !document.getElementById("rack").closest("[hidden]");
  const when = byHand ? "" : `, ${quantity(time, 3, "s")} after the release`;
  document.getElementById("picture-position").textContent =
    `Wheel travel ${place(travel)}${steered ? `, ${steering} ${place(rack)}` : ""}${when}.`;
  const image = document.getElementById("picture");
  image.hidden = view === null;
  if (view) image.src = view.picture(PICTURE);
}

/** A chart as a vector drawing, of the size of the plot. */
export function drawing(plot, { lines, goals, marker }) {
  const { width, height } = plot;
  const upright = plot.scales.x.ori === 1;
  const { offsetLeft, offsetTop, clientHeight: bottom, clientWidth: right } = plot.over;
  const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, class: "printed" });
  const area = shape("g", { transform: `translate(${offsetLeft} ${offsetTop})` });
  for (const [at, text] of ticks(plot, upright ? 0 : 1)) {
    area.append(shape("path", { class: "grid", d: `M0 ${at}H${right}` }));
    area.append(label(-6, at + 3.5, "end", text));
  }
  for (const [at, text] of ticks(plot, upright ? 1 : 0)) {
    area.append(shape("path", { class: "grid", d: `M${at} 0V${bottom}` }));
    area.append(label(at, bottom + 14, "middle", text));
  }
  const name = upright
    ? label(-bottom / 2, 12 - offsetLeft, "middle", plot.axes[0].label)
    : label(right / 2, bottom + 30, "middle", plot.axes[0].label);
  if (upright) name.setAttribute("transform", "rotate(-90)");
  area.append(name);
  for (const [of, values] of Object.entries(lines)) {
    area.append(shape("path", { class: of, d: path(plot, values) }));
  }
  area.append(marks(plot, goals));
  if (marker) area.append(shape("circle", { class: "at", cx: marker[0], cy: marker[1], r: 3.5 }));
  svg.append(area);
  return svg;
}

/** Place and text of each tick of an axis. */
function ticks(plot, index) {
  const axis = plot.axes[index];
  return axis._splits.map((value, i) => [plot.valToPos(value, axis.scale), axis._values[i]]);
}

function path(plot, values) {
  let pen = "M"; // an interrupted line begins again
  return plot.data[0]
    .map((x, i) => {
      if (values[i] === null) {
        pen = "M";
        return "";
      }
      const place =
        pen +
        placed(plot, x, values[i])
          .map((pixel) => pixel.toFixed(2))
          .join(" ");
      pen = "L";
      return place;
    })
    .join("");
}

function label(x, y, anchor, text) {
  const made = shape("text", { x, y, "text-anchor": anchor });
  made.textContent = text;
  return made;
}
