"use strict";
// Rotation of a picture by dragging, and playing of a motion, for any page.

/** Call `turned` with the angles of each drag over a picture: about z, and upward [deg]. */
function onDrag(picture, turned) {
  let grabbed = null;
  picture.addEventListener("pointerdown", (event) => {
    grabbed = [event.clientX, event.clientY];
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!grabbed) return;
    const [x, y] = grabbed;
    grabbed = [event.clientX, event.clientY];
    turned(-0.4 * (event.clientX - x), 0.4 * (event.clientY - y));
  });
  for (const end of ["pointerup", "pointercancel"]) {
    picture.addEventListener(end, () => { grabbed = null; });
  }
}

/** A motion in real time, or slower by the value of `speed`; `show` draws a position by its index. */
class Playback {
  constructor(button, speed, show) {
    Object.assign(this, { button, speed, show, frame: null });
  }
  get isPlaying() { return this.frame !== null; }
  stop() {
    if (!this.isPlaying) return;
    cancelAnimationFrame(this.frame);
    this.frame = null;
    this.button.textContent = "Play";
  }
  /** Play from a position, or from the first one if it is the last; times are those of all [s]. */
  start(times, index) {
    const last = times.length - 1;
    let time = times[index < last ? index : 0], before = null;
    this.button.textContent = "Pause";
    const step = (now) => {
      if (before !== null) time += ((now - before) / 1000) * Number(this.speed.value);
      before = now;
      const next = times.findIndex((t) => t >= time);
      this.show(next < 0 ? last : next);
      if (next < 0) return this.stop();
      this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
  }
}
