// Buttons and keys that move the view of the track: nearer, farther, around the wearer, all of it, another level, plan or
// track alone, both feet.

import { child, element, press, show } from "./words.js";

const ZOOMS = { "+": true, "=": true, "-": false, _: false }; // nearer
const WAYS = { ArrowLeft: [-48, 0], ArrowRight: [48, 0], ArrowUp: [0, 48], ArrowDown: [0, -48] }; // px to the right and up

export class Looking {
  #levels = ""; // those that have buttons

  constructor(track, redraw) {
    Object.assign(this, { track, redraw });
    const chosen = (choice) => {
      Object.assign(track, choice);
      redraw();
    };
    const alone = (byItself) => {
      Object.assign(track, { byItself, whole: false });
      track.view.all(true);
    };
    const actions = {
      "zoom-in": () => track.nearer(true),
      "zoom-out": () => track.nearer(false),
      "zoom-fit": () => track.all(),
      "zoom-follow": () => track.follow(),
      "show-plan": () => alone(false),
      "show-track": () => alone(true),
      "show-feet": () => chosen({ feetShown: !track.feetShown }),
    };
    for (const [id, act] of Object.entries(actions)) element(id).addEventListener("click", act);
    element("levels").addEventListener("click", ({ target }) => target.value && chosen({ level: target.value }));
    element("track-section").addEventListener("keydown", (event) => this.#arrow(event));
  }

  // Returns true when the key was one of these.
  key(key) {
    if (key === "0") this.track.all();
    else if (key in ZOOMS) this.track.nearer(ZOOMS[key]);
    else return false;
    return true;
  }

  draw(state) {
    const { track } = this;
    const onPlan = track.onPlan(state);
    press("zoom-fit", track.view.follows && !track.following);
    press("zoom-follow", track.following);
    show("zoom-follow", state.plan !== null); // before there is a place on it as well, so that no button moves
    element("zoom-follow").disabled = !onPlan;
    show("track-choice", state.plan !== null);
    press("show-plan", onPlan);
    press("show-track", !onPlan);
    press("show-feet", track.feetShown);
    const levels = onPlan && state.plan.levels.length > 1 ? state.plan.levels : [];
    show("levels", levels.length > 0);
    const key = JSON.stringify(levels.map(({ id, name }) => [id, name]));
    if (key !== this.#levels) {
      this.#levels = key;
      element("levels").replaceChildren();
      for (const { id, name } of levels) Object.assign(child(element("levels"), "button", "", name), { type: "button", value: id });
    }
    for (const button of element("levels").children) press(button, button.value === track.shown(state).id);
  }

  #arrow(event) {
    const way = WAYS[event.key];
    if (!way || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.track.view.move(...way);
  }
}
