// The shown part of the plane: its middle and px per metre. It follows what is drawn until a person chooses a part.

import { reducedMotion } from "./canvas.js";

const EASING_TIME = 220; // ms in which the view covers about two thirds of the distance to its goal
const [MIN_SCALE, MAX_SCALE] = [0.2, 400]; // px per metre
const ZOOM_FACTOR = 1.4;
const PUSH_DISTANCE = 48; // px

export class View {
  follows = true; // true while it shows everything by itself
  above = 0; // px by which its middle is above the canvas's, and left of it
  aside = 0;
  #goal = null;
  #now = null;
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

  // box: [least x, least y, greatest x, greatest y] to be shown, m; spare: share of the picture left for new parts.
  // It changes only when something gets near the edge. A view by hand ends with `all`.
  fit(box, width, height, spare) {
    if (!this.follows || width < 1 || height < 1) return;
    const [x, y] = [0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])];
    const fits = Math.min(width / Math.max(1e-3, box[2] - box[0]), height / Math.max(1e-3, box[3] - box[1]));
    const scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, fits));
    if (this.#goal !== null && this.#suits(box, width, height, scale)) return;
    this.#go({ x, y, scale: scale * (1 - spare) });
  }

  // Shows this part, as long as no person chose another: {x, y, scale}.
  follow(part) {
    if (this.follows) this.#go({ ...part, scale: Math.min(MAX_SCALE, Math.max(MIN_SCALE, part.scale)) });
  }

  #go(goal) {
    this.#goal = goal;
    if (this.#jumps || reducedMotion.matches || this.#now === null) this.#now = { ...goal };
    this.#jumps = false;
  }

  // Returns whether the box is within the view and fills enough of it.
  #suits(box, width, height, scale) {
    const { x, y, scale: shown } = this.#goal;
    const [w, h] = [(0.5 * width) / shown, (0.5 * height) / shown];
    const inside = box[0] >= x - w && box[2] <= x + w && box[1] >= y - h && box[3] <= y + h;
    return inside && shown > 0.45 * scale;
  }

  // Returns the view at the moment `now`: {x, y, scale}; `settled` once it has reached its goal.
  at(now) {
    if (this.#now === null) return { x: 0, y: 0, scale: 30 };
    if (this.#goal === null) return this.#now; // hidden since its size changed
    const passed = Math.min(100, now - this.#last);
    this.#last = now;
    const share = this.settled ? 0 : 1 - Math.exp(-passed / EASING_TIME);
    for (const key of ["x", "y"]) this.#now[key] += share * (this.#goal[key] - this.#now[key]);
    this.#now.scale *= (this.#goal.scale / this.#now.scale) ** share;
    if (Math.abs(Math.log(this.#goal.scale / this.#now.scale)) < 0.002) this.#now.scale = this.#goal.scale;
    const off = Math.hypot(this.#goal.x - this.#now.x, this.#goal.y - this.#now.y) * this.#now.scale;
    if (off < 0.3 && this.#now.scale === this.#goal.scale) this.#now = { ...this.#goal };
    return this.#now;
  }

  get settled() {
    return this.#now === null || this.#goal === null || ["x", "y", "scale"].every((key) => this.#now[key] === this.#goal[key]);
  }

  // True once it has reached its scale.
  get scaled() {
    return this.#now === null || this.#goal === null || this.#now.scale === this.#goal.scale;
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
    this.#take({ ...this.#here(), scale: this.#here().scale * (nearer ? ZOOM_FACTOR : 1 / ZOOM_FACTOR) });
  }

  push(right, up) {
    const { x, y, scale } = this.#here();
    this.#take({ x: x + (right * PUSH_DISTANCE) / scale, y: y + (up * PUSH_DISTANCE) / scale, scale }, true);
  }

  #here() {
    return this.#goal ?? { x: 0, y: 0, scale: 30 };
  }

  #take(view, atOnce) {
    this.follows = false;
    this.#goal = { ...view, scale: Math.min(MAX_SCALE, Math.max(MIN_SCALE, view.scale)) };
    if (atOnce || reducedMotion.matches || this.#now === null) this.#now = { ...this.#goal };
    this.moved();
  }

  // Zooms so that the same place stays under the point (px from the canvas's middle).
  #about(px, py, factor) {
    const { x, y, scale } = this.#here();
    const next = Math.min(MAX_SCALE, Math.max(MIN_SCALE, scale * factor));
    this.#take({ x: x + px / scale - px / next, y: y - py / scale + py / next, scale: next }, true);
  }

  #down(event) {
    if (event.pointerType === "mouse" && event.button !== 0) return;
    this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.classList.add("dragged");
  }

  #move(event) {
    const before = this.#fingers.get(event.pointerId);
    if (before === undefined) return;
    const old = [...this.#fingers.values()];
    this.#fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const now = [...this.#fingers.values()];
    if (now.length > 2) return;
    const middle = (points, k) => points.reduce((sum, point) => sum + point[k], 0) / points.length;
    const [dx, dy] = [middle(now, 0) - middle(old, 0), middle(now, 1) - middle(old, 1)];
    const { x, y, scale } = this.#here();
    this.#take({ x: x - dx / scale, y: y + dy / scale, scale }, true);
    if (now.length === 2) {
      const apart = ([a, b]) => Math.max(10, Math.hypot(a[0] - b[0], a[1] - b[1]));
      const frame = this.canvas.getBoundingClientRect();
      this.#about(
        middle(now, 0) - frame.x - frame.width / 2 + this.aside,
        middle(now, 1) - frame.y - frame.height / 2 + this.above,
        apart(now) / apart(old),
      );
    }
  }

  #up(event) {
    this.#fingers.delete(event.pointerId);
    if (this.#fingers.size === 0) this.canvas.classList.remove("dragged");
  }

  // A bare wheel scrolls the page; with Ctrl, as touchpads send for a pinch, it zooms.
  #wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const frame = this.canvas.getBoundingClientRect();
    this.#about(
      event.clientX - frame.x - frame.width / 2 + this.aside,
      event.clientY - frame.y - frame.height / 2 + this.above,
      Math.exp(-event.deltaY * 0.004),
    );
  }
}
