// A person reports where the wearer is: back at the start, or at a place on the drawing, by a click or at the cross.

import { element, note, press, show } from "./words.js";

const LEAST_SIGMA = 1; // m, standard deviation with which a person knows the place
const CLICK_SIGMA = 8; // px, standard deviation of a click
const MAX_DRIFT = 6; // px; a pointer that moved farther has dragged the drawing
const BUTTONS = ["here-start", "here-place", "here-cross"];

export class Here {
  uses = ["scene", "feet", "playback", "reports", "theme"];
  #pressed = null; // {id, x, y} where the pointer went down
  #failed = false;

  // send(command) returns false if nothing was sent; announce(words) announces to a screen reader; watchOnly says why
  // this page may send nothing; if it is empty, nothing is shown then
  constructor(track, send, announce, redraw, watchOnly) {
    Object.assign(this, { track, send, announce, redraw, watchOnly });
    element("here-start").addEventListener("click", () => this.#report({}, 0));
    element("here-place").addEventListener("click", () => this.#point(!track.pointing));
    element("here-cross").addEventListener("click", () => this.#place(null));
    track.canvas.addEventListener("pointerdown", ({ pointerId: id, button, clientX: x, clientY: y }) => {
      if (button !== 0) return;
      this.#pressed = this.#pressed === null ? { id, x, y } : { id: null }; // two fingers choose no place
    });
    track.canvas.addEventListener("pointerup", (event) => this.#up(event));
    track.canvas.addEventListener("pointercancel", () => (this.#pressed = null));
  }

  draw(state) {
    const live = state.source === "live" && state.playback === null;
    const may = live && state.control && state.strides !== null; // before there are data there is no place to correct
    if (!may && this.track.pointing) this.#point(false);
    const { pointing } = this.track;
    show("here", live && (state.control || this.watchOnly !== ""));
    element("here").style.visibility = state.strides === null ? "hidden" : ""; // its room is there, so that nothing moves
    show("here-legend", state.reports.length > 0);
    for (const id of BUTTONS) element(id).disabled = !may;
    press("here-place", pointing);
    show("here-cross", pointing);
    this.track.canvas.classList.toggle("pointed", pointing);
    note("here-note", this.#words(may, this.track.onPlan(state) ? "plan" : "track"));
  }

  // Returns true when the key was one of these.
  key(key) {
    if (key !== "Escape" || !this.track.pointing) return false;
    this.#point(false);
    element("here-place").focus();
    return true;
  }

  #words(may, drawing) {
    if (!may) return this.watchOnly;
    if (this.#failed) return "Not reported: there is no connection.";
    if (!this.track.pointing) return "";
    return `Click where you are on the ${drawing}, or move that place below the cross and press “At the cross”.`;
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
    this.#report(level === null ? { at } : { at, level }, CLICK_SIGMA / scale);
  }

  // The page's log says what came of it.
  #report(place, sigma) {
    this.#point(false);
    this.#failed = this.send({ do: "here", sigma: Math.hypot(LEAST_SIGMA, sigma), ...place }) === false;
    if (this.#failed) this.announce("Not reported: there is no connection");
    this.redraw();
  }
}
