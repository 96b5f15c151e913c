// Pause, speed and seek of a recording; a watcher without control sees only the time. A seek takes as long as its
// computation: until it ends, the page shows another moment than the seek bar, and its progress.

import { clamp } from "./canvas.js";
import { clock, describe, element, note, setData, show, write } from "./words.js";

const STEPS = { ArrowLeft: -5, ArrowRight: 5 }; // s
const LONG_STEP = 6; // times as far, with Shift
const MAX_WAIT = 1500; // ms for which a requested time is shown before it is reached
const SEEK_INTERVAL = 150; // ms between seeks while the bar is dragged
const NOTICE_DELAY = 400; // ms; a shorter seek needs no words
const ANNOUNCE_DELAY = 900; // ms; a longer seek is announced to a screen reader
const WATCH_ONLY = "This page may watch only. To pause and seek, open the whole address that solepath printed: it holds the key.";

export class Playback {
  uses = ["playback", "scene", "second"];
  #requested = { t: 0, at: -Infinity }; // the newest seek
  #sent = 0;
  #dragged = false;
  #since = null; // start of a seek that is computed, ms
  #announced = false;

  // send(command) sends it to the program; announce(words) announces to a screen reader
  constructor(send, announce) {
    Object.assign(this, { send, announce });
    for (const id of ["play", "seek", "speed-choice"]) this[id] = element(id);
    this.play.addEventListener("click", () => this.toggle());
    this["speed-choice"].addEventListener("change", ({ target }) => send({ do: "speed", value: Number(target.value) }));
    for (const name of ["input", "change"]) {
      this.seek.addEventListener(name, () => {
        this.#dragged = name === "input";
        this.#request(Number(this.seek.value), !this.#dragged);
      });
    }
  }

  draw(state, now) {
    const { playback, control } = state;
    this.state = state;
    show("playback", playback !== null);
    this.#progress(playback, now);
    if (playback === null) return;
    const { begin, end, t, state: how, speed, seeking } = playback;
    const shown = this.#dragged ? Number(this.seek.value) : (seeking ?? (this.#isFresh() ? this.#requested.t : t));
    setData("playback", { state: how });
    describe(this.play, "aria-label", how === "playing" ? "Pause" : how === "ended" ? "Play again" : "Play");
    describe(this.seek, "min", begin);
    describe(this.seek, "max", Math.max(end, begin + 0.1));
    if (!this.#dragged) this.seek.value = shown;
    const whither = seeking === null ? "" : "on the way to ";
    describe(this.seek, "aria-valuetext", `${whither}${clock(shown - begin)} of ${clock(end - begin)}`);
    write("time-now", clock((seeking === null ? shown : t) - begin)); // the bar already shows the target
    write("time-end", clock(end - begin));
    this.#speed(speed);
    for (const part of [this.play, this.seek, this["speed-choice"]]) part.disabled = !control;
    note("playback-note", control ? "" : WATCH_ONLY);
  }

  #progress(playback, now) {
    const going = playback !== null && playback.seeking !== null;
    this.#since = going ? (this.#since ?? now) : null;
    const passed = going ? now - this.#since : 0;
    const seen = passed >= NOTICE_DELAY;
    describe(document.querySelector("main"), "aria-busy", seen);
    show("seeking", seen);
    show("seek-way", seen);
    this.#announced &&= going;
    if (!seen) return;
    const { begin, end, t, seeking } = playback;
    const whither = `Going to ${clock(seeking - begin)}`;
    write("seeking", `${whither}, now at ${clock(t - begin)}`);
    element("seek-done").style.width = `${(100 * (t - begin)) / Math.max(0.1, end - begin)}%`;
    if (passed < ANNOUNCE_DELAY || this.#announced) return;
    this.#announced = true;
    this.announce(whither);
  }

  toggle() {
    const { state, begin } = this.state.playback;
    if (state === "ended") this.#request(begin, true);
    this.send({ do: state === "playing" ? "pause" : "play" });
  }

  // Returns true when the key was one of these.
  key(key, shift) {
    if (!this.state?.playback || !this.state.control || !(key === " " || key in STEPS)) return false;
    const { seeking, t } = this.state.playback;
    const here = this.#isFresh() ? this.#requested.t : (seeking ?? t);
    if (key === " ") this.toggle();
    else this.#request(here + STEPS[key] * (shift ? LONG_STEP : 1), true);
    return true;
  }

  #isFresh() {
    return performance.now() - this.#requested.at < MAX_WAIT;
  }

  #request(t, surely) {
    const { begin, end } = this.state.playback;
    const now = performance.now();
    this.#requested = { t: clamp(t, begin, end), at: now };
    if (surely || now - this.#sent > SEEK_INTERVAL) {
      this.#sent = now;
      this.send({ do: "seek", value: this.#requested.t });
    }
    this.draw(this.state, now);
  }

  // A speed that is not among the choices, perhaps from a command line, is added to them.
  #speed(speed) {
    const choice = this["speed-choice"];
    if (Number(choice.value) === speed || (document.activeElement === choice && choice.matches(":open"))) return;
    if (![...choice.options].some(({ value }) => Number(value) === speed)) choice.add(new Option(`${speed}×`, speed));
    choice.value = speed;
  }
}
