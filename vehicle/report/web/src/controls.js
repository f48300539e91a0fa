// Sliders, their values, and the buttons of the simulated second.

import { quantity } from "./format.js";

const byId = (id) => document.getElementById(id);

/** A slider over one axis of the grid, in millimetres. */
function slider(id, axis, onInput) {
  const input = byId(id);
  input.min = (axis.first * 1e3).toFixed(1);
  input.max = (axis.last * 1e3).toFixed(1);
  input.addEventListener("input", () => onInput(Number(input.value) / 1e3));
  return (value) => {
    const text = quantity(value * 1e3, 1, "mm", { signed: true });
    input.value = value * 1e3;
    input.setAttribute("aria-valuetext", text);
    byId(`${id}-value`).textContent = text;
  };
}

export function connectControls(position, player) {
  const { grid } = position;
  const showTravel = slider("travel", grid.travel, (travel) => position.setByHand({ travel }));
  const showRack = slider("rack", grid.rack, (rack) => position.setByHand({ rack }));
  byId("design").addEventListener("click", () => position.toDesign());
  position.onChange(() => {
    showTravel(position.travel);
    showRack(position.rack);
  });
  if (position.motion) connectPlayer(position, player);
}

function connectPlayer(position, player) {
  const [button, time, speed] = ["play", "time", "speed"].map(byId);
  time.max = position.motion.axis.last;
  button.addEventListener("click", () => (player.playing ? player.pause() : player.play()));
  time.addEventListener("input", () => {
    player.pause();
    position.setTime(Number(time.value));
  });
  speed.addEventListener("change", () => {
    player.speed = Number(speed.value);
  });
  player.speed = Number(speed.value);
  player.onChange(() => {
    button.textContent = player.playing ? "Pause" : "Play";
  });
  position.onChange(() => {
    const text = quantity(position.time, 3, "s");
    time.value = position.time;
    time.setAttribute("aria-valuetext", text);
    byId("time-value").textContent = text;
  });
}
