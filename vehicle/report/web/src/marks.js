// Targets and limits in a chart, on the screen and on paper: a target is a point with what matters
// of it to either side; of limits, arrows stand beyond. Their colours are in the style sheet.

const POINT = 3; // radius of a target [px]
const CAP = 3; // half of the line at the end of what matters [px]
const CARET = { width: 4.5, height: 7 }; // half the width of an arrow, whose tip is the limit [px]

/** Least and greatest value that is marked. */
export function marked(goals) {
  return goals.flatMap(({ value, within }) => value.flatMap((v) => [v - within, v + within]));
}

/** All marks of a chart as a group of lines, in pixels of its plot. */
export function marks(plot, goals) {
  const group = shape("g", { class: "goals" });
  for (const goal of goals) {
    const places = goal.at.map((at, i) => [
      plot.valToPos(at, "x"),
      ...[0, 1, -1].map((side) => plot.valToPos(goal.value[i] + side * goal.within, "y")),
    ]);
    group.append(...(goal.kind === "target" ? target(places) : limit(places, goal.kind)));
  }
  return group;
}

function target(places) {
  const cap = (x, y) => `M${x - CAP} ${y}H${x + CAP}`;
  return places.flatMap(([x, y, high, low]) => [
    shape("path", { class: "target", d: `M${x} ${high}V${low}${cap(x, high)}${cap(x, low)}` }),
    shape("circle", { class: "target", cx: x, cy: y, r: POINT }),
  ]);
}

function limit(places, kind) {
  const away = kind === "least" ? CARET.height : -CARET.height; // pixels count downwards
  const carets = places.map(([x, y]) =>
    shape("path", {
      class: "caret",
      d: `M${x} ${y}l${CARET.width} ${away}h${-2 * CARET.width}z`,
    }),
  );
  const line = places.map(([x, y]) => `${x} ${y}`).join("L");
  return [shape("path", { class: "limit", d: `M${line}` }), ...carets];
}

/** An element of a drawing of lines. */
export function shape(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
