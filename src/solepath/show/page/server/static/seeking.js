// On the way to another time of a recording, which takes as long as it takes to compute it: until it is there, what is
// seen is of another moment than the bar says, and looks so.

import { clock, describe, show, write } from "./words.js";

const SOON = 400; // ms: what is there sooner needs no words
const LONG = 900; // ms: what takes longer is said to who does not see it

export class Seeking {
  wants = ["playback", "scene", "second"];
  #since = null; // when it set out, ms
  #said = false;

  // say(words): to who listens
  constructor(say) {
    this.say = say;
    this.main = document.querySelector("main");
    for (const id of ["seeking", "seek-way", "seek-done"]) this[id] = document.getElementById(id);
  }

  draw({ playback }, now) {
    const { begin, end, t, seeking } = playback ?? { seeking: null };
    const going = seeking !== null;
    this.#since = going ? (this.#since ?? now) : null;
    const passed = going ? now - this.#since : 0;
    const seen = passed >= SOON;
    describe(this.main, "aria-busy", String(seen));
    show(this.seeking, seen);
    show(this["seek-way"], seen);
    if (!going) this.#said = false;
    if (!seen) return going ? "later" : "done";
    write(this.seeking, `Going to ${clock(seeking - begin)}, now at ${clock(t - begin)}`);
    this["seek-done"].style.width = `${(100 * (t - begin)) / Math.max(0.1, end - begin)}%`;
    if (passed >= LONG && !this.#said) {
      this.#said = true;
      this.say(`Going to ${clock(seeking - begin)}`);
    }
    return "done";
  }
}
