// Buttons and keys that move the view of the track: nearer, farther, around the wearer, all of it, another level, plan or
// track alone.

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
    this.follow = document.getElementById("zoom-follow") ?? followButton(this.fit);
    document.getElementById("zoom-in").addEventListener("click", () => track.nearer(true));
    document.getElementById("zoom-out").addEventListener("click", () => track.nearer(false));
    this.fit.addEventListener("click", () => track.all());
    this.follow.addEventListener("click", () => track.follow());
    this.onPlan.addEventListener("click", () => this.#show(false));
    this.alone.addEventListener("click", () => this.#show(true));
    document.getElementById("track-section").addEventListener("keydown", (event) => this.#arrow(event));
  }

  // Returns true when the key was one of these.
  key(key) {
    const { track } = this;
    if (key === "+" || key === "=") track.nearer(true);
    else if (key === "-" || key === "_") track.nearer(false);
    else if (key === "0") track.all();
    else return false;
    return true;
  }

  draw(state) {
    const { track } = this;
    const onPlan = track.onPlan(state);
    press(this.fit, track.view.follows && !track.following);
    press(this.follow, track.following);
    show(this.follow, onPlan);
    show(this.choice, state.plan !== null);
    press(this.onPlan, onPlan);
    press(this.alone, !onPlan);
    const levels = onPlan && state.plan.levels.length > 1 ? state.plan.levels : [];
    show(this.levels, levels.length > 0);
    const key = JSON.stringify(levels.map(({ id, name }) => [id, name]));
    if (key !== this.listed) this.#list(levels, key);
    if (levels.length === 0) return;
    const shown = track.shown(state).id;
    levels.forEach((level, i) => press(this.levels.children[i], level.id === shown));
  }

  #list(levels, key) {
    this.listed = key;
    this.levels.replaceChildren();
    for (const { id, name } of levels) {
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
    Object.assign(this.track, { byItself, whole: false });
    this.track.view.all(true);
  }

  #arrow(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!way || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.track.view.push(...way);
  }
}

// A button that shows the part of the plan around the wearer again.
function followButton(fit) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", id: "zoom-follow", title: "Follow the wearer" });
  button.setAttribute("aria-label", "Follow the wearer");
  const space = "http://www.w3.org/2000/svg";
  const picture = document.createElementNS(space, "svg");
  const path = document.createElementNS(space, "path");
  const given = { viewBox: "0 0 24 24", width: 20, height: 20, fill: "none", stroke: "currentColor", "stroke-width": 2, "aria-hidden": true };
  for (const [name, value] of Object.entries(given)) picture.setAttribute(name, value);
  path.setAttribute("d", "M12 6a6 6 0 1 0 0 12 6 6 0 1 0 0-12M12 2v4M12 18v4M2 12h4M18 12h4M12 11.5v1");
  picture.append(path);
  button.append(picture);
  fit.before(button);
  return button;
}

const press = (button, pressed) => describe(button, "aria-pressed", String(pressed));
