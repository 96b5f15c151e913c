// Shows the progress of a seek, which takes as long as its computation: until it ends, the page shows another moment
// than the seek bar.

import { clock, describe, show, write } from "./words.js";

const NOTICE_DELAY = 400; // ms; a shorter seek needs no words
const ANNOUNCE_DELAY = 900; // ms; a longer seek is announced to a screen reader

export class Seeking {
  uses = ["playback", "scene", "second"];
  #since = null; // start of the seek, ms
  #announced = false;

  // announce(words) announces to a screen reader
  constructor(announce) {
    this.announce = announce;
    this.main = document.querySelector("main");
    for (const id of ["seeking", "seek-way", "seek-done"]) this[id] = document.getElementById(id);
  }

  draw({ playback }, now) {
    const { start, end, t, seeking } = playback ?? { seeking: null };
    const going = seeking !== null;
    this.#since = going ? (this.#since ?? now) : null;
    const passed = going ? now - this.#since : 0;
    const seen = passed >= NOTICE_DELAY;
    describe(this.main, "aria-busy", String(seen));
    show(this.seeking, seen);
    show(this["seek-way"], seen);
    if (!going) this.#announced = false;
    if (!seen) return going ? "later" : "done";
    write(this.seeking, `Going to ${clock(seeking - start)}, now at ${clock(t - start)}`);
    this["seek-done"].style.width = `${(100 * (t - start)) / Math.max(0.1, end - start)}%`;
    if (passed >= ANNOUNCE_DELAY && !this.#announced) {
      this.#announced = true;
      this.announce(`Going to ${clock(seeking - start)}`);
    }
    return "done";
  }
}
