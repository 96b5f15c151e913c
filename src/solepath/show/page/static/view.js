// The shown part of the plane: its middle and px per metre. It follows what is drawn until a person chooses a part.

import { clamp, reducedMotion } from "./canvas.js";
import { ZOOM_FACTOR } from "./following.js";

const EASING_TIME = 220; // ms in which the view covers about two thirds of the distance to its goal
const SCALES = [0.2, 400]; // px per metre
const WHEEL_FACTOR = 0.004; // of a wheel's movement, in the logarithm of the scale

export class View {
  follows = true; // true while it shows everything by itself
  above = 0; // px by which its middle is above the canvas's, and left of it
  aside = 0;
  #goal = null; // null until what is drawn is fitted again
  #now = { x: 0, y: 0, scale: 30 };
  #jumps = true; // to its next goal
  #fingers = new Map();
  #last = 0;

  // moved() is called when a person changed the view
  constructor(canvas, moved) {
    this.canvas = canvas;
    this.moved = moved;
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.#up(event));
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
  }

  // Shows [least x, greatest x, least y, greatest y], m; spare: share of the picture left for new parts. It changes only
  // when something gets near the edge. A view by hand ends with `all`.
  fit([x0, x1, y0, y1], width, height, spare) {
    if (!this.follows || width < 1 || height < 1) return;
    const scale = clamp(Math.min(width / (x1 - x0), height / (y1 - y0)), ...SCALES);
    if (this.#goal !== null && this.#goal.scale > 0.45 * scale) {
      const { x, y, scale: shown } = this.#goal;
      const [w, h] = [(0.5 * width) / shown, (0.5 * height) / shown];
      if (x0 >= x - w && x1 <= x + w && y0 >= y - h && y1 <= y + h) return;
    }
    this.#go({ x: 0.5 * (x0 + x1), y: 0.5 * (y0 + y1), scale: scale * (1 - spare) }, this.#jumps);
  }

  // Shows this part, as long as no person chose another: {x, y, scale}.
  follow(part) {
    if (this.follows) this.#go(part, this.#jumps);
  }

  #go(goal, jumps) {
    this.#goal = { ...goal, scale: clamp(goal.scale, ...SCALES) };
    if (jumps || reducedMotion.matches) this.#now = { ...this.#goal };
    this.#jumps = false;
  }

  // Returns the view at the moment `now`: {x, y, scale}.
  at(now) {
    const passed = Math.min(100, now - this.#last);
    this.#last = now;
    if (this.settled) return this.#now;
    const share = 1 - Math.exp(-passed / EASING_TIME);
    const { x, y, scale } = this.#goal;
    const before = this.#now;
    const next = before.scale * (scale / before.scale) ** share;
    this.#now = {
      x: before.x + share * (x - before.x),
      y: before.y + share * (y - before.y),
      scale: Math.abs(Math.log(scale / next)) < 0.002 ? scale : next,
    };
    const off = Math.hypot(x - this.#now.x, y - this.#now.y) * scale;
    if (off < 0.3 && this.scaled) this.#now = { ...this.#goal };
    return this.#now;
  }

  // True once it has reached its goal.
  get settled() {
    return this.#goal === null || ["x", "y", "scale"].every((key) => this.#now[key] === this.#goal[key]);
  }

  // True once it has reached its scale.
  get scaled() {
    return this.#goal === null || this.#now.scale === this.#goal.scale;
  }

  // jumps: to another drawing, where nothing lies between.
  all(jumps = false) {
    this.follows = true;
    this.#goal = null;
    this.#jumps ||= jumps;
    this.moved();
  }

  // Adapts the view to a new size of the canvas.
  resized() {
    if (!this.follows) return;
    this.#goal = null;
    this.#jumps = true;
  }

  zoom(nearer) {
    const here = this.#here();
    this.#take({ ...here, scale: here.scale * (nearer ? ZOOM_FACTOR : 1 / ZOOM_FACTOR) }, false);
  }

  // Moves by so many px to the right and up.
  move(right, up) {
    const { x, y, scale } = this.#here();
    this.#take({ x: x + right / scale, y: y + up / scale, scale }, true);
  }

  #here() {
    return this.#goal ?? this.#now;
  }

  #take(view, atOnce) {
    this.follows = false;
    this.#go(view, atOnce);
    this.moved();
  }

  // Zooms so that the same place stays under a point of the window.
  #about(clientX, clientY, factor) {
    const frame = this.canvas.getBoundingClientRect();
    const [px, py] = [clientX - frame.x - frame.width / 2 + this.aside, clientY - frame.y - frame.height / 2 + this.above];
    const { x, y, scale } = this.#here();
    const next = clamp(scale * factor, ...SCALES);
    this.#take({ x: x + px / scale - px / next, y: y - py / scale + py / next, scale: next }, true);
  }

  #down(event) {
    if (event.pointerType === "mouse" && event.button !== 0) return;
    this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.classList.add("dragged");
  }

  #move(event) {
    if (!this.#fingers.has(event.pointerId)) return;
    const old = [...this.#fingers.values()];
    this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const now = [...this.#fingers.values()];
    if (now.length > 2) return;
    const middle = (points, k) => points.reduce((sum, point) => sum + point[k], 0) / points.length;
    this.move(middle(old, 0) - middle(now, 0), middle(now, 1) - middle(old, 1));
    const apart = ([a, b]) => Math.max(10, Math.hypot(a[0] - b[0], a[1] - b[1]));
    if (now.length === 2) this.#about(middle(now, 0), middle(now, 1), apart(now) / apart(old));
  }

  #up(event) {
    this.#fingers.delete(event.pointerId);
    if (this.#fingers.size === 0) this.canvas.classList.remove("dragged");
  }

  // A bare wheel scrolls the page; with Ctrl, as touchpads send for a pinch, it zooms.
  #wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    this.#about(event.clientX, event.clientY, Math.exp(-event.deltaY * WHEEL_FACTOR));
  }
}
