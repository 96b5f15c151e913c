// Pause, speed and seek of a recording; a watcher without control sees only the time.

import { clock, describe, show, setData, write } from "./words.js";

const SEEK_STEP = 5; // s
const LONG_SEEK_STEP = 30; // s, with Shift
const MAX_WAIT = 1500; // ms for which a requested time is shown before it is reached
const SEEK_INTERVAL = 150; // ms between seeks while the bar is dragged

export class Playback {
  uses = ["playback", "scene"];
  #requested = null; // {t, at} of the newest seek
  #sent = 0;
  #dragged = false;

  constructor(send) {
    this.send = send;
    for (const id of ["playback", "play", "seek", "speed-choice", "time-now", "time-end", "playback-note"])
      this[id] = document.getElementById(id);
    this.play.addEventListener("click", () => this.toggle());
    this["speed-choice"].addEventListener("change", () =>
      this.send({ do: "speed", value: Number(this["speed-choice"].value) }),
    );
    this.seek.addEventListener("input", () => {
      this.#dragged = true;
      this.#request(Number(this.seek.value), false);
    });
    this.seek.addEventListener("change", () => {
      this.#dragged = false;
      this.#request(Number(this.seek.value), true);
    });
  }

  draw(state) {
    const { playback, control } = state;
    this.state = state;
    show(this.playback, playback !== null);
    if (playback === null) return "done";
    const { start, end, t, state: how, speed, seeking } = playback;
    const requested = this.#requested && performance.now() - this.#requested.at < MAX_WAIT ? this.#requested.t : null;
    const shown = this.#dragged ? Number(this.seek.value) : (seeking ?? requested ?? t);
    setData(this.playback, { state: how });
    describe(this.play, "aria-label", how === "playing" ? "Pause" : how === "ended" ? "Play again" : "Play");
    describe(this.seek, "min", String(start));
    describe(this.seek, "max", String(Math.max(end, start + 0.1)));
    if (!this.#dragged) this.seek.value = shown;
    const whither = seeking === null ? "" : "on the way to ";
    describe(this.seek, "aria-valuetext", `${whither}${clock(shown - start)} of ${clock(end - start)}`);
    write(this["time-now"], clock((seeking === null ? shown : t) - start)); // the bar already shows the target
    write(this["time-end"], clock(end - start));
    this.#speed(speed);
    for (const part of [this.play, this.seek, this["speed-choice"]])
      if (part.disabled === control) part.disabled = !control;
    show(this["playback-note"], !control);
    if (!control)
      write(
        this["playback-note"],
        "This page may watch only. To pause and seek, open the whole address that solepath printed: it holds the key.",
      );
    return "done";
  }

  toggle() {
    if (!this.#mayControl()) return;
    const { state, start } = this.state.playback;
    if (state === "ended") this.#request(start, true);
    this.send({ do: state === "playing" ? "pause" : "play" });
  }

  // Returns true when the key was one of these.
  key(key, shift) {
    if (!this.#mayControl()) return false;
    if (key === " ") this.toggle();
    else if (key === "ArrowLeft" || key === "ArrowRight") {
      const step = (shift ? LONG_SEEK_STEP : SEEK_STEP) * (key === "ArrowLeft" ? -1 : 1);
      this.#request(this.#here() + step, true);
    } else return false;
    return true;
  }

  #mayControl() {
    return Boolean(this.state?.playback && this.state.control);
  }

  #here() {
    const fresh = this.#requested && performance.now() - this.#requested.at < MAX_WAIT;
    return fresh ? this.#requested.t : (this.state.playback.seeking ?? this.state.playback.t);
  }

  #request(t, surely) {
    const { start, end } = this.state.playback;
    const now = performance.now();
    const value = Math.min(end, Math.max(start, t));
    this.#requested = { t: value, at: now };
    if (surely || now - this.#sent > SEEK_INTERVAL) {
      this.#sent = now;
      this.send({ do: "seek", value });
    }
    this.draw(this.state);
  }

  // A speed that is not among the choices, perhaps from a command line, is added to them.
  #speed(speed) {
    const choice = this["speed-choice"];
    if (Number(choice.value) === speed || (document.activeElement === choice && choice.matches(":open"))) return;
    if (![...choice.options].some((option) => Number(option.value) === speed)) {
      const option = document.createElement("option");
      option.value = speed;
      option.textContent = `${speed}×`;
      choice.append(option);
    }
    choice.value = speed;
  }
}
