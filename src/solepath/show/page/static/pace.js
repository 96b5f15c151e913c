// Estimates the session's time between two messages, so that scrolling pictures move evenly.

// The constants were chosen by hand and not swept.
const MAX_TIME_AHEAD = 0.6; // s for which the shown time goes on without a message
const MAX_ERROR = 0.7; // s of error of the shown time above which it jumps
const SPEED_WINDOW = 1000; // ms over which the real speed of a recording is measured
const MIN_SPEED_WINDOW = 200; // ms, least time over which the real speed is measured
const MIN_SPEED_SHARE = 0.9; // share of the requested speed that counts as that speed: messages do not come evenly

export class Pace {
  #shown = null;
  #last = 0;
  #receivedAt = 0;
  #t = 0;
  #recent = []; // recent [now, t]
  #speed = 0; // requested speed
  #most = Infinity; // limit in multiples of real time: the speed reached where the requested one could not be kept up
  #generation = 0;

  update(state, now) {
    if (state.generation !== this.#generation) {
      this.#shown = null;
      this.#recent = [];
    }
    this.#generation = state.generation;
    if (state.t !== this.#t) {
      if (now - this.#receivedAt > 1000 * MAX_TIME_AHEAD) this.#recent = [];
      this.#receivedAt = now;
      this.#recent.push([now, state.t]);
      while (this.#recent.length > 2 && this.#recent[1][0] <= now - SPEED_WINDOW) this.#recent.shift();
    }
    this.#t = state.t;
  }

  // Returns the time to show, s; `moving` says that it changes without messages.
  at(state, now) {
    const { playback } = state;
    const speed = playback === null ? 1 : this.#real(playback.state === "playing" ? playback.speed : 0);
    const since = (now - this.#receivedAt) / 1000;
    this.moving = speed > 0 && since < MAX_TIME_AHEAD;
    const goal = this.#t + (this.moving ? since * speed : 0);
    if (this.#shown === null || Math.abs(goal - this.#shown) > MAX_ERROR * Math.max(1, speed)) this.#shown = goal;
    const passed = Math.min(0.1, (now - this.#last) / 1000);
    this.#last = now;
    this.#shown += this.moving ? passed * speed : 0;
    this.#shown += (goal - this.#shown) * Math.min(1, 4 * passed);
    return this.#shown;
  }

  // A slow machine plays slower than requested; scrolling pictures must not run ahead of it.
  #real(speed) {
    if (speed !== this.#speed) this.#recent = [];
    this.#speed = speed;
    const took = this.#recent.length > 0 ? this.#receivedAt - this.#recent[0][0] : 0;
    if (took >= MIN_SPEED_WINDOW) {
      const rate = (1000 * (this.#t - this.#recent[0][1])) / took;
      this.#most = rate > MIN_SPEED_SHARE * speed ? Infinity : Math.max(0, rate);
    }
    return Math.min(speed, this.#most);
  }
}
