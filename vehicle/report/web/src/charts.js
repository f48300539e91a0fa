// Small charts, one for each characteristic. A marker follows the position; the curve follows the
// slider that is not its abscissa. Wheel travel is on the vertical axis, as in all pictures.

import uPlot from "uplot";

import { inUnit, number, quantity, reading } from "./format.js";
import { marked, marks, placed, shape } from "./marks.js";
import { drawing } from "./print.js";
import { colour, onSchemeChange } from "./theme.js";

const HEIGHT = 172;
const PRINTED = 330; // width on paper, where two charts are beside each other
const MARGIN = 0.07; // above and below a curve, as part of its range
const MOST_FLATTENED = 2.5; // greatest factor by which the reference beside a curve flattens it
const NEXT_TO = 1e-9; // how far from a jump its two sides are drawn [m]
const FONT = "11px system-ui, sans-serif";

/** Abscissae of charts. */
function abscissas({ grid, motion }, steering) {
  const millimetres = (axis) => ({
    values: Array.from(axis.values, (v) => v * 1e3),
    decimals: 1,
    signed: true,
    unit: "mm",
  });
  return {
    travel: { ...millimetres(grid.travel), name: "wheel travel", key: "travel", factor: 1e3 },
    rack: { ...millimetres(grid.rack), name: steering, key: "rack", factor: 1e3 },
    time: motion && {
      values: Array.from(motion.axis.values),
      decimals: 3,
      signed: false,
      unit: "s",
      name: "time",
      key: "time",
      factor: 1,
    },
  };
}

export function connectCharts(data, position, move) {
  const along = abscissas(position, data.steering);
  const { grid } = position;
  const described = new Map(data.curves.map((curve) => [curve.key, curve]));
  for (const signal of data.motion?.signals ?? []) described.set(signal.key, signal);
  const charts = [...document.querySelectorAll("figure[data-curve]")].map((figure) => {
    const curve = described.get(figure.dataset.curve);
    return new Chart(figure, curve, along[curve.over], sampler(curve, grid, position.motion), move);
  });
  const update = () => charts.forEach((chart) => chart.update(position));
  position.onChange(update);
  onSchemeChange(() => charts.forEach((chart) => chart.rebuild()));
  return charts;
}

/** Functions of a curve and of one value of it, in display units. */
function sampler(curve, grid, motion) {
  const scaled = (values) => Array.from(values, (v) => inUnit(curve, v));
  if (curve.over === "time") {
    const values = scaled(curve.values);
    return {
      moving: false,
      places: () => motion.axis.values,
      line: () => values,
      value: ({ time }) => inUnit(curve, motion.axis.interpolate(curve.values, time)),
      hits: ({ time }) => motion.axis.hits(time),
    };
  }
  const overRack = curve.over === "rack";
  const axis = grid[curve.over];
  const held = ({ travel, rack }) => (overRack ? travel : rack);
  const value = (where, other) =>
    overRack ? grid.valueAt(curve, other, where) : grid.valueAt(curve, where, other);
  const smooth = ({ travel, rack }) =>
    overRack ? grid.overRack(curve.values, travel) : grid.overTravel(curve.values, rack);
  return {
    moving: overRack ? "travel" : "rack",
    // a jump of the line, and of the one at design, has a point on either side
    places: (position) => {
      const jumps = [held(position), 0].flatMap((at) => grid.closings(curve, curve.over, at));
      const sides = jumps.flatMap((at) => [at - NEXT_TO, at + NEXT_TO]);
      return Float64Array.from([...axis.values, ...sides]).sort();
    },
    line: (position, places) =>
      scaled(
        curve.gaps.length === 0
          ? smooth(position)
          : Array.from(places, (where) => value(where, held(position))),
      ),
    value: ({ travel, rack }) => inUnit(curve, grid.valueAt(curve, travel, rack)),
    hits: ({ travel, rack }) => grid.hits(travel, rack),
  };
}

class Chart {
  #visible = false;
  #drawnAt = null;
  #plot = null;

  constructor(figure, curve, along, samples, move) {
    Object.assign(this, { figure, curve, along, samples, move });
    this.upright = curve.over === "travel";
    this.output = figure.querySelector("output");
    this.host = figure.querySelector(".plot");
    this.marker = element("div", "marker");
    this.tip = element("div", "tip");
    this.goals = curve.goals ?? []; // curves over time have none
    this.marks = shape("svg", { class: "marks" });
    this.position = null;
    this.shown = null;
    new IntersectionObserver(([entry]) => this.#look(entry.isIntersecting), {
      rootMargin: "200px",
    }).observe(figure);
    new ResizeObserver(() => this.#resize()).observe(this.host);
  }

  update(position) {
    this.position = position;
    if (this.#visible) this.#draw();
  }

  /** Build the chart with the colours of the present scheme. */
  rebuild() {
    this.#plot?.destroy();
    this.#plot = null;
    this.#drawnAt = null;
    if (this.#visible) this.#draw();
  }

  /** Put a drawing of the chart on the page for the printer. */
  print() {
    this.rebuild();
    this.#draw(PRINTED);
    this.host.querySelector(".printed")?.remove();
    const { line, reference, goals } = this;
    const at = this.marker.hidden ? null : this.#markerPlace();
    this.host.append(drawing(this.#plot, { lines: { reference, line }, goals, marker: at }));
  }

  #look(visible) {
    this.#visible = visible;
    if (visible && this.position) this.#draw();
  }

  #resize() {
    const width = this.host.clientWidth;
    if (!this.#plot || width === 0) return;
    this.#plot.setSize({ width, height: HEIGHT });
    this.#place();
  }

  #draw(width = this.host.clientWidth) {
    if (!this.#plot) this.#build(width);
    const { moving, places, line } = this.samples;
    const at = moving ? this.position[moving] : 0;
    if (at !== this.#drawnAt) {
      this.#drawnAt = at;
      const where = places(this.position);
      const drawn = (position) => line(position, where).map((v) => this.#inRange(v));
      this.line = drawn(this.position);
      // a curve that moves has the one at design behind it, faintly
      this.reference = moving ? drawn({ travel: 0, rack: 0, time: 0 }) : this.line.map(() => null);
      const abscissas = Array.from(where, (v) => v * this.along.factor);
      this.#plot.batch(() => this.#plot.setData([abscissas, this.reference, this.line]));
    }
    this.shown = this.samples.value(this.position);
    this.output.textContent = reading(this.curve, this.shown, this.samples.hits(this.position));
    this.#place();
  }

  /** Interrupt the line beyond the plotted range, as at a pole. */
  #inRange(value) {
    const [low, high] = this.curve.range;
    return value >= low && value <= high ? value : null;
  }

  #build(width) {
    const nothing = this.along.values.map(() => null);
    const [across, upward] = [
      { side: 2, size: 18, gap: 4, space: 60 },
      { side: 3, size: roomFor, gap: 5, space: 25 },
    ];
    const axis = {
      stroke: colour("muted"),
      font: FONT,
      grid: { stroke: colour("grid"), width: 1 },
      ticks: { show: false },
      values: (_, ticks) => ticks.map(plain),
    };
    const curve = { points: { show: false }, pxAlign: 0 };
    [this.line, this.reference] = [[], []];
    this.#plot = new uPlot(
      {
        width: Math.max(width, 1),
        height: HEIGHT,
        padding: [8, 10, 0, 0],
        legend: { show: false },
        scales: {
          x: {
            time: false,
            range: [this.along.values[0], this.along.values.at(-1)],
            ori: this.upright ? 1 : 0,
          },
          y: { range: () => this.#valueRange(), ori: this.upright ? 0 : 1 },
        },
        axes: [
          {
            ...axis,
            ...(this.upright ? upward : across),
            label: `${this.along.name} [${this.along.unit}]`,
            labelSize: 16,
            labelGap: 0,
            labelFont: FONT,
          },
          { ...axis, ...(this.upright ? across : upward) },
        ],
        series: [
          {},
          { stroke: colour("faint"), width: 1.25, ...curve },
          { stroke: colour("line"), width: 1.75, ...curve },
        ],
        cursor: {
          drag: { x: false, y: false, setScale: false },
          points: { show: false },
          y: false,
        },
        hooks: {
          setCursor: [() => this.#hover()],
          draw: [() => this.#mark(), () => this.#place()],
        },
      },
      [this.along.values, nothing, nothing],
      this.host,
    );
    const over = this.#plot.over;
    over.append(this.marks, this.marker, this.tip);
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      this.#drag(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) this.#drag(event);
    });
  }

  #drag(event) {
    const { left, top } = this.#plot.over.getBoundingClientRect();
    const at = this.upright ? event.clientY - top : event.clientX - left;
    this.move(this.along.key, this.#plot.posToVal(at, "x") / this.along.factor);
  }

  /** Range of the curve and its marks, and of the reference if the curve does not become flat. */
  #valueRange() {
    const { least } = this.curve;
    let [low, high] = extent(this.line, least);
    const [lowest, highest] = extent([...this.line, ...this.reference], least);
    if (highest - lowest <= MOST_FLATTENED * (high - low)) [low, high] = [lowest, highest];
    [low, high] = [Math.min(low, ...marked(this.goals)), Math.max(high, ...marked(this.goals))];
    const margin = MARGIN * (high - low);
    return [low - margin, high + margin];
  }

  #mark() {
    this.marks.replaceChildren(marks(this.#plot, this.goals));
  }

  #place() {
    if (!this.#plot || !this.position) return;
    const inside = this.#inRange(this.shown) !== null;
    this.marker.hidden = !inside;
    if (!inside) return;
    const [left, top] = this.#markerPlace();
    this.marker.style.transform = `translate(${left}px, ${top}px)`;
  }

  #markerPlace() {
    const x = this.position[this.along.key] * this.along.factor;
    return placed(this.#plot, x, this.shown);
  }

  #hover() {
    const { left, top } = this.#plot.cursor;
    this.tip.hidden = left === undefined || left < 0;
    if (this.tip.hidden) return;
    const x = this.#plot.posToVal(this.upright ? top : left, "x");
    const where = { ...this.#values(), [this.along.key]: x / this.along.factor };
    const value = this.samples.value(where);
    const place = quantity(x, this.along.decimals, this.along.unit, { signed: this.along.signed });
    this.tip.textContent = `${place}: ${reading(this.curve, value, this.samples.hits(where))}`;
    const width = this.#plot.over.clientWidth;
    this.tip.style.left = `${Math.min(Math.max(left, 62), width - 62)}px`;
  }

  #values() {
    const { travel, rack, time } = this.position;
    return { travel, rack, time };
  }
}

/** Least and greatest value, with a least distance. */
function extent(values, least) {
  const known = values.filter((value) => value !== null);
  if (known.length === 0) return [-least / 2, least / 2];
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const missing = Math.max(least - (high - low), 0) / 2;
  return [low - missing, high + missing];
}

function element(name, className) {
  const made = document.createElement(name);
  made.className = className;
  made.hidden = true;
  return made;
}

/** Width of the vertical axis: the same for most charts, so that they align. */
function roomFor(_, labels) {
  const longest = Math.max(0, ...(labels ?? []).map((label) => label.length));
  return Math.max(46, 6.5 * longest + 9);
}

/** The shortest text of a tick. */
function plain(value) {
  return number(value, decimalsOf(value));
}

function decimalsOf(value) {
  const text = String(Number(value.toPrecision(6)));
  return text.includes("e") ? 6 : (text.split(".")[1]?.length ?? 0);
}
