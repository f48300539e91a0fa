// Plays the simulated second.

export class Player {
  #before = null;
  #listeners = [];

  constructor(position) {
    this.position = position;
    this.speed = 0.1;
    this.playing = false;
    position.onChange(() => {
      if (position.byHand) this.pause();
    });
  }

  onChange(listener) {
    this.#listeners.push(listener);
  }

  play() {
    if (this.playing) return;
    const { axis } = this.position.motion;
    if (this.position.time >= axis.last) this.position.setTime(axis.first);
    this.playing = true;
    this.#before = null;
    this.#tell();
    requestAnimationFrame((now) => this.#step(now));
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.#tell();
  }

  #step(now) {
    if (!this.playing) return;
    const { axis } = this.position.motion;
    const elapsed = this.#before === null ? 0 : (now - this.#before) / 1000;
    this.#before = now;
    this.position.setTime(this.position.time + this.speed * elapsed);
    if (this.position.time >= axis.last) this.pause();
    else requestAnimationFrame((next) => this.#step(next));
  }

  #tell() {
    for (const listener of this.#listeners) listener(this);
  }
}
