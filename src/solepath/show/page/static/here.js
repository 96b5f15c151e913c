// A person reports where the wearer is: back at the start, or at a place on the drawing, by a click or at the cross.

import { describe, show, write } from "./words.js";

const LEAST_SIGMA = 1; // m, standard deviation with which a person knows the place
const CLICK_SIGMA = 8; // px, standard deviation of a click
const MAX_DRIFT = 6; // px; a pointer that moved farther has dragged the drawing

export class Here {
  uses = ["scene", "playback", "reports", "theme"];
  #pressed = null; // {id, x, y} where the pointer went down
  #failed = false;

  // send(command) returns false if nothing was sent; announce(words) announces to a screen reader; watchOnly says why
  // this page may send nothing; if it is empty, nothing is shown then
  constructor(track, send, announce, redraw, watchOnly) {
    Object.assign(this, { track, send, announce, redraw, watchOnly });
    for (const id of ["here", "here-start", "here-place", "here-cross", "here-note", "here-legend"])
      this[id] = document.getElementById(id);
    this["here-start"].addEventListener("click", () => this.#report({}, 0));
    this["here-place"].addEventListener("click", () => this.#point(!track.pointing));
    this["here-cross"].addEventListener("click", () => this.#place(null));
    track.canvas.addEventListener("pointerdown", ({ pointerId: id, button, clientX: x, clientY: y }) => {
      if (button !== 0) return;
      this.#pressed = this.#pressed === null ? { id, x, y } : { id: null }; // two fingers choose no place
    });
    track.canvas.addEventListener("pointerup", (event) => this.#up(event));
    track.canvas.addEventListener("pointercancel", () => (this.#pressed = null));
  }

  draw(state) {
    const live = state.source === "live" && state.playback === null;
    const may = live && state.control;
    if (!may && this.track.pointing) this.#point(false);
    const { pointing } = this.track;
    show(this.here, live && (may || this.watchOnly !== ""));
    show(this["here-legend"], state.reports.length > 0);
    for (const id of ["here-start", "here-place", "here-cross"]) if (this[id].disabled === may) this[id].disabled = !may;
    describe(this["here-place"], "aria-pressed", String(pointing));
    show(this["here-cross"], pointing);
    this.track.canvas.classList.toggle("pointed", pointing);
    const words = this.#words(may, pointing, this.track.onPlan(state));
    write(this["here-note"], words);
    show(this["here-note"], words !== "");
    return "done";
  }

  // Returns true when the key was one of these.
  key(key) {
    if (key !== "Escape" || !this.track.pointing) return false;
    this.#point(false);
    this["here-place"].focus();
    return true;
  }

  #words(may, pointing, onPlan) {
    if (!may) return this.watchOnly;
    if (this.#failed) return "Not reported: there is no connection.";
    if (!pointing) return "";
    return `Click where you are on the ${onPlan ? "plan" : "track"}, or move that place below the cross and press “At the cross”.`;
  }

  #point(on) {
    this.track.pointing = on;
    this.#failed = false;
    if (on) this.announce("Choose where you are on the drawing, or move that place below the cross");
    this.redraw();
  }

  #up({ pointerId, clientX, clientY }) {
    const pressed = this.#pressed;
    this.#pressed = null;
    if (!this.track.pointing || pressed?.id !== pointerId) return;
    if (Math.hypot(clientX - pressed.x, clientY - pressed.y) > MAX_DRIFT) return;
    const frame = this.track.canvas.getBoundingClientRect();
    this.#place([clientX - frame.x, clientY - frame.y]);
  }

  #place(point) {
    const { at, level, scale } = this.track.placeAt(point);
    this.#report({ at, ...(level === null ? {} : { level }) }, CLICK_SIGMA / scale);
  }

  // The page's log says what came of it.
  #report(place, sigma) {
    this.#point(false);
    this.#failed = this.send({ do: "here", sigma: Math.hypot(LEAST_SIGMA, sigma), ...place }) === false;
    if (this.#failed) this.announce("Not reported: there is no connection");
    this.redraw();
  }
}
