// Buttons and keys that move the view of the track: nearer, farther, another level, plan or track alone.

import { describe, show } from "./words.js";

export class Looking {
  constructor(track, redraw) {
    this.track = track;
    this.redraw = redraw;
    this.fit = document.getElementById("zoom-fit");
    this.levels = document.getElementById("levels");
    this.choice = document.getElementById("track-choice");
    this.onPlan = document.getElementById("show-plan");
    this.alone = document.getElementById("show-track");
    document.getElementById("zoom-in").addEventListener("click", () => track.view.zoom(true));
    document.getElementById("zoom-out").addEventListener("click", () => track.view.zoom(false));
    this.fit.addEventListener("click", () => track.view.all());
    this.onPlan.addEventListener("click", () => this.#show(false));
    this.alone.addEventListener("click", () => this.#show(true));
    document.getElementById("track-section").addEventListener("keydown", (event) => this.#arrow(event));
  }

  // Returns true when the key was one of these.
  key(key) {
    const { view } = this.track;
    if (key === "+" || key === "=") view.zoom(true);
    else if (key === "-" || key === "_") view.zoom(false);
    else if (key === "0") view.all();
    else return false;
    return true;
  }

  draw(state) {
    const { track } = this;
    press(this.fit, track.view.follows);
    show(this.choice, state.plan !== null);
    const onPlan = track.onPlan(state);
    press(this.onPlan, onPlan);
    press(this.alone, !onPlan);
    const levels = onPlan && state.plan.levels.length > 1 ? state.plan.levels : [];
    show(this.levels, levels.length > 0);
    const key = JSON.stringify(levels.map(({ id, name }) => [id, name]));
    if (key !== this.listed) this.#list(levels, key);
    if (levels.length === 0) return;
    const shown = track.shown(state).id;
    press(this.levels.firstChild, track.level === null);
    levels.forEach((level, i) => press(this.levels.children[i + 1], level.id === shown));
  }

  #list(levels, key) {
    this.listed = key;
    this.levels.replaceChildren();
    for (const [id, name] of [[null, "Follow"], ...levels.map((level) => [level.id, level.name])]) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name;
      button.addEventListener("click", () => {
        this.track.level = id;
        this.redraw();
      });
      this.levels.append(button);
    }
  }

  #show(byItself) {
    this.track.byItself = byItself;
    this.track.view.all();
  }

  #arrow(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!way || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.track.view.push(...way);
  }
}

const press = (button, pressed) => describe(button, "aria-pressed", String(pressed));
