// The session's time between two messages, so that what scrolls does so evenly.

const AHEAD = 0.6; // s that it may go on without hearing anything
const FAR = 0.7; // s off: jump

export class Pace {
  #shown = null;
  #last = 0;
  #heard = 0;
  #t = 0;
  #generation = 0;

  heard(state, now) {
    if (state.generation !== this.#generation) this.#shown = null;
    this.#generation = state.generation;
    if (state.t !== this.#t) this.#heard = now;
    this.#t = state.t;
  }

  // s; whether it moves on by itself is `moving`
  at(state, now) {
    const { playback } = state;
    const speed = playback === null ? 1 : playback.state === "playing" ? playback.speed : 0;
    const since = (now - this.#heard) / 1000;
    this.moving = speed > 0 && since < AHEAD;
    const goal = this.#t + (this.moving ? since * speed : 0);
    if (this.#shown === null || Math.abs(goal - this.#shown) > FAR * Math.max(1, speed)) this.#shown = goal;
    const passed = Math.min(0.1, (now - this.#last) / 1000);
    this.#last = now;
    this.#shown += this.moving ? passed * speed : 0;
    this.#shown += (goal - this.#shown) * Math.min(1, 4 * passed);
    return this.#shown;
  }
}
