// Draws cars on their roads from the positions of their points, a row for each time [mm].
const INK = "#222222", TYRE = "#4a4a4a", RIM = "#d9d9d9", BODY = "0, 114, 178", LINK = "#7b5ea7";
const SPRING = "#8a8a8a", FORCE = "#d55e00", PATH = "#009e73";
const AROUND = Array.from({ length: 37 }, (_, i) => (2 * Math.PI * i) / 36);
const SPOKES = Array.from({ length: 5 }, (_, i) => (2 * Math.PI * i) / 5);

// -- vectors ----------------------------------------------------------------------------------

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const triples = (row) => Array.from({ length: row.length / 3 }, (_, i) => row.slice(3 * i, 3 * i + 3));
const mean = (points) => points.reduce((sum, p) => add(sum, p, 1 / points.length), [0, 0, 0]);

function connect(root) {
  const find = (name) => root.querySelector(`.${name}`);
  const data = JSON.parse(root.querySelector("script").textContent);
  const view = find("scene"), road = find("path"), slider = find("time");
  const plots = [...root.querySelectorAll(".curve")];
  let index = 0, turn = -38, tilt = 22, nearer = 1;

  // -- what follows the car ---------------------------------------------------------------------

  const MIDDLE = mean(triples(data.sides[0][0]).concat(triples(data.sides[1][0])));
  const LONG = data.size;
  let pen, right, up, towards, scale, wide, high;
  function look() {
    const [a, b] = [turn, tilt].map((angle) => (angle * Math.PI) / 180);
    right = [-Math.sin(a), Math.cos(a), 0];
    up = [-Math.sin(b) * Math.cos(a), -Math.sin(b) * Math.sin(a), Math.cos(b)];
    towards = cross(right, up);
    scale = (nearer * Math.min(wide / 2.7, high / 1.75)) / LONG;
  }
  function on(p) {
    const from = add(p, [MIDDLE[0], MIDDLE[1], data.height], -1);
    return [wide / 2 + scale * dot(right, from), 0.54 * high - scale * dot(up, from)];
  }
  const depth = (points) => dot(towards, mean(points));
  function trace(points) {
    pen.beginPath();
    for (const p of points) pen.lineTo(...on(p));
  }
  function line(points, colour, width) {
    trace(points);
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.stroke();
  }
  function fill(points, colour, edge, width = 1) {
    trace(points);
    pen.closePath();
    pen.fillStyle = colour;
    pen.fill();
    pen.strokeStyle = edge;
    pen.lineWidth = width;
    pen.stroke();
  }
  function sized(canvas, share) {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = Math.round(share * width);
    canvas.width = ratio * width;
    canvas.height = ratio * height;
    pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.lineCap = pen.lineJoin = "round";
    return [width, height];
  }
  function draw() {
    [wide, high] = sized(view, view.clientWidth < 600 ? 0.8 : 0.6);
    look();
    ground();
    const items = [...wheels(), ...links(), ...cones()];
    if (find("body").checked) items.push(...bodywork());
    items.sort((a, b) => a[0] - b[0]);
    for (const [, stroke] of items) stroke();
    arrows();
    if (data.times.length === 1) return;
    if (road) fromAbove();
    find("instant").textContent = `t = ${data.times[index].toFixed(2)} s    ${data.words[index]}`;
    find("seconds").textContent = `${data.times[index].toFixed(2)} s`;
    slider.value = index;
    plots.forEach(follow);
  }
  function ground() {
    const [x, y] = data.places[index], far = 4 * LONG, step = data.grid;
    for (let at = Math.ceil((x - far) / step) * step; at < x + far; at += step) {
      line([[at - x, -far, 0], [at - x, far, 0]], "#e4e4e4", 1);
    }
    for (let at = Math.ceil((y - far) / step) * step; at < y + far; at += step) {
      line([[-far, at - y, 0], [far, at - y, 0]], "#e4e4e4", 1);
    }
    for (const { first, step, y: across, z } of data.tracks) {
      const from = Math.max(0, Math.floor((x - far - first) / step));
      const some = z.slice(from, Math.ceil((x + far - first) / step));
      line(some.map((height, i) => [first + (from + i) * step - x, across - y, height]), INK, 1.5);
    }
    if (!road) return;
    const path = data.places.map((p) => [p[0] - x, p[1] - y, 0]);
    line(path, PATH, 0.8);
    line(path.slice(0, index + 1), PATH, 2.5);
  }
  function* links() {
    for (const part of data.parts) {
      const points = triples(part[index]), middle = mean(points);
      yield [depth(points), () => points.forEach((p) => line([middle, p], LINK, 3))];
    }
    for (const spring of data.springs) {
      const ends = triples(spring[index]);
      yield [depth(ends), () => line(ends, SPRING, 4)];
    }
  }
  function* bodywork() {
    if (!data.sides[0][index].length) return; // an axle on a rig
    const [left, other] = data.sides.map((side) => triples(side[index]));
    const panels = left.map((p, i) => [p, other[i], other[(i + 1) % left.length], left[(i + 1) % left.length]]);
    for (const panel of [left, other, ...panels]) {
      yield [depth(panel), () => fill(panel, `rgba(${BODY}, 0.08)`, `rgba(${BODY}, 0.55)`)];
    }
  }
  function* wheels() {
    const rows = ["centers", "axes", "spokes"].map((name) => triples(data[name][index]));
    for (const [i, radius] of data.radii.entries()) {
      const [center, axis, first] = rows.map((row) => row[i]);
      const second = cross(axis, first), half = (Math.sign(dot(axis, towards)) || 1) * 0.5 * data.width * radius;
      const face = add(center, axis, half), back = add(center, axis, -half);
      const circle = (middle, r, angles = AROUND) =>
        angles.map((a) => add(add(middle, first, r * Math.cos(a)), second, r * Math.sin(a)));
      yield [depth([face]), () => {
        const [near, far] = [circle(face, radius), circle(back, radius)];
        near.slice(1).forEach((p, k) => fill([near[k], p, far[k + 1], far[k]], TYRE, TYRE));
        fill(far, TYRE, TYRE);
        fill(near, TYRE, INK);
        fill(circle(face, 0.64 * radius), RIM, INK);
        for (const end of circle(face, 0.6 * radius, SPOKES)) line([face, end], INK, 2);
      }];
    }
  }
  function* cones() {
    const [x, y] = data.places[index];
    for (const [cx, cy] of data.cones) {
      const foot = [cx - x, cy - y, 0];
      if (Math.hypot(foot[0], foot[1]) > 4 * LONG) continue;
      const edge = [-150, 150].map((r) => add(foot, right, r));
      const round = AROUND.map((a) => add(foot, [150 * Math.cos(a), 150 * Math.sin(a), 0]));
      yield [depth([foot]), () => {
        fill(round, FORCE, FORCE);
        fill([...edge, add(foot, [0, 0, 500])], FORCE, FORCE);
      }];
    }
  }
  function arrows() {
    const forces = triples(data.forces[index]);
    for (const [i, start] of triples(data.contacts[index]).entries()) {
      const end = add(start, forces[i], data.mmPerNewton), [a, b] = [on(start), on(end)];
      const long = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (long < 4) continue;
      line([start, end], FORCE, 3);
      const [dx, dy] = [((b[0] - a[0]) / long) * 10, ((b[1] - a[1]) / long) * 10];
      pen.beginPath();
      pen.moveTo(b[0] + dx / 2, b[1] + dy / 2);
      pen.lineTo(b[0] - dx / 2 - dy / 2, b[1] - dy / 2 + dx / 2);
      pen.lineTo(b[0] - dx / 2 + dy / 2, b[1] - dy / 2 - dx / 2);
      pen.fillStyle = FORCE;
      pen.fill();
    }
  }

  // -- the whole path ---------------------------------------------------------------------------

  function fromAbove() {
    const every = data.places.concat(data.cones), edge = 4000;
    const [low, top] = [Math.min, Math.max].map((most) => [0, 1].map((k) => every.reduce((m, p) => most(m, p[k]), every[0][k])));
    const [x, y] = [0, 1].map((k) => top[k] - low[k] + 2 * edge);
    const [width, height] = sized(road, Math.min(Math.max(y / x, 0.06), 0.25));
    const s = Math.min(width / x, height / y);
    const at = (p) => [width / 2 + s * (p[0] - (low[0] + top[0]) / 2), height / 2 - s * (p[1] - (low[1] + top[1]) / 2)];
    const stroke = (places, thick) => {
      pen.beginPath();
      for (const p of places) pen.lineTo(...at(p));
      pen.strokeStyle = PATH;
      pen.lineWidth = thick;
      pen.stroke();
    };
    stroke(data.places, 0.8);
    stroke(data.places.slice(0, index + 1), 2.5);
    pen.fillStyle = FORCE;
    for (const p of data.cones.map(at)) pen.fillRect(p[0] - 1.5, p[1] - 1.5, 3, 3);
    const own = data.places[index];
    pen.beginPath();
    const [left, other] = data.sides.map((side) => triples(side[index]));
    for (const p of [left[0], left.at(-1), other.at(-1), other[0]]) pen.lineTo(...at([own[0] + p[0], own[1] + p[1]]));
    pen.fillStyle = `rgb(${BODY})`;
    pen.fill();
  }

  // -- curves -----------------------------------------------------------------------------------

  function follow(plot, which) {
    const { box, times, lines, decimals, unit } = data.charts[which], cursor = plot.querySelector(".cursor");
    const part = (data.times[index] - times[0]) / (times[1] - times[0]);
    cursor.style.left = `${100 * (box[0] + part * (box[1] - box[0]))}%`;
    cursor.style.top = `${100 * box[2]}%`;
    cursor.style.height = `${100 * (box[3] - box[2])}%`;
    const written = (value) => (value === null ? "–" : `${value.toFixed(decimals)} ${unit}`.trim().replace("-", "\u2212"));
    plot.nextElementSibling.textContent = lines
      .map(([name, values]) => `${name} ${written(values[index])}`.trim())
      .join(" · ");
  }
  function setFrom(plot, which, event) {
    const { box, times } = data.charts[which], frame = plot.getBoundingClientRect();
    const part = ((event.clientX - frame.left) / frame.width - box[0]) / (box[1] - box[0]);
    const time = times[0] + part * (times[1] - times[0]);
    const distance = (i) => Math.abs(data.times[i] - time);
    playback.stop();
    set(data.times.reduce((best, _, i) => (distance(i) < distance(best) ? i : best), 0));
  }
  plots.forEach((plot, which) => {
    plot.addEventListener("pointerdown", (event) => {
      plot.setPointerCapture(event.pointerId);
      setFrom(plot, which, event);
    });
    plot.addEventListener("pointermove", (event) => {
      if (plot.hasPointerCapture(event.pointerId)) setFrom(plot, which, event);
    });
  });

  // -- moving -----------------------------------------------------------------------------------

  function set(position) {
    index = position;
    draw();
  }
  const playback = new Playback(find("play"), find("speed"), set);
  if (data.times.length > 1) {
    find("play").addEventListener("click", () => {
      if (playback.isPlaying) return playback.stop();
      playback.start(data.times, index);
    });
    slider.addEventListener("input", () => {
      playback.stop();
      set(Number(slider.value));
    });
  }
  find("body").addEventListener("input", draw);
  for (const button of root.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => {
      [turn, tilt] = button.dataset.view.split(" ").map(Number);
      draw();
    });
  }
  for (const button of root.querySelectorAll("[data-by]")) {
    button.addEventListener("click", () => {
      nearer = Math.max(0.3, Math.min(4, nearer * Number(button.dataset.by)));
      draw();
    });
  }
  onDrag(view, (about, upward) => {
    turn += about;
    tilt = Math.max(-10, Math.min(90, tilt + upward));
    draw();
  });
  window.addEventListener("resize", draw);
  draw();
}

for (const root of document.querySelectorAll("[data-player]")) connect(root);
