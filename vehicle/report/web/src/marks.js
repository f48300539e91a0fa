// Targets and limits in a chart, on the screen and on paper: a target is a point with its `within`
// to either side; a limit has arrows on its far side. Their colours are in the style sheet.

const POINT = 3; // radius of a target [px]
const CAP = 3; // half of the line at the end of `within` [px]
const CARET = { width: 4.5, height: 7 }; // half the width of an arrow, whose tip is the limit [px]

/** Least and greatest marked value. */
export function marked(goals) {
  return goals.flatMap(({ value, within }) => value.flatMap((v) => [v - within, v + within]));
}

/** The place of a value in a chart [px]; the abscissa may be on the vertical axis. */
export function placed(plot, x, y) {
  const [along, value] = [plot.valToPos(x, "x"), plot.valToPos(y, "y")];
  return plot.scales.x.ori === 1 ? [value, along] : [along, value];
}

/** All marks of a chart as a group of lines, in pixels of its plot. */
export function marks(plot, goals) {
  const group = shape("g", { class: "goals" });
  for (const goal of goals) {
    const places = goal.at.map((at, i) =>
      [0, 1, -1].map((side) => placed(plot, at, goal.value[i] + side * goal.within)),
    );
    const upright = plot.scales.x.ori === 1;
    const drawn = goal.kind === "target" ? target(places, upright) : limit(places, goal, upright);
    group.append(...drawn);
  }
  return group;
}

function target(places, upright) {
  const cap = ([x, y]) => (upright ? `M${x} ${y - CAP}V${y + CAP}` : `M${x - CAP} ${y}H${x + CAP}`);
  return places.flatMap(([[x, y], high, low]) => [
    shape("path", {
      class: "target",
      d: `M${high.join(" ")}L${low.join(" ")}${cap(high)}${cap(low)}`,
    }),
    shape("circle", { class: "target", cx: x, cy: y, r: POINT }),
  ]);
}

function limit(places, { kind }, upright) {
  // away from the allowed range: to the left or to the right, else pixels count downwards
  const away = (kind === "least") === upright ? -CARET.height : CARET.height;
  const { width } = CARET;
  const body = upright ? `l${away} ${width}v${-2 * width}z` : `l${width} ${away}h${-2 * width}z`;
  const carets = places.map(([[x, y]]) =>
    shape("path", { class: "caret", d: `M${x} ${y}${body}` }),
  );
  const line = places.map(([[x, y]]) => `${x} ${y}`).join("L");
  return [shape("path", { class: "limit", d: `M${line}` }), ...carets];
}

/** An element of a drawing of lines. */
export function shape(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
