// How the view follows the wearer, and how what is shown moves between two messages.

import { clamp, reducedMotion } from "./canvas.js";

export const MAX_JUMP = 5; // m between two places; above it another candidate became the likeliest, without a walk there
const ACROSS = [30, 16]; // m that are shown at least, from left to right and from top to bottom
const BORDER = 1.5; // m around the plan
const MIDDLE = 0.3; // share of the picture to each side of its middle in which the wearer stays with reduced motion
const ZOOMS = [0.25, 8]; // limits of the factor by which the followed part is nearer than usual
export const ZOOM_FACTOR = 1.4;
const PATIENCE = 3000; // ms for which the likeliest candidate is followed after the place was decided
const LEAST_STEP = 0.5; // m between two places that show a direction

// A list of numbers that arrives at each goal when the next one comes, so that it never stops amid a walk.
export class Glide {
  #from = null;
  #to = null;
  #start = 0;
  #span = 1;

  // spans: least and longest time in which it goes to a goal, ms; it jumps to one that is farther than `farthest`
  constructor(spans, farthest) {
    Object.assign(this, { spans, farthest });
  }

  aim(goal, now) {
    const far = this.#to === null ? Infinity : Math.hypot(...goal.map((value, k) => value - this.#to[k]));
    if (far === 0) return;
    this.#from = far > this.farthest || reducedMotion.matches ? goal : this.at(now);
    this.#span = clamp(now - this.#start, ...this.spans);
    this.#start = now;
    this.#to = goal;
  }

  at(now) {
    const share = Math.min(1, (now - this.#start) / this.#span);
    return this.#to.map((value, k) => this.#from[k] + share * (value - this.#from[k]));
  }

  moving(now) {
    return this.#to !== null && now - this.#start < this.#span;
  }

  // Forgets the goal, for instance on another level.
  clear() {
    this.#to = null;
  }
}

// The part of the plan around the wearer.
export class Follower {
  zoom = 1; // by how much it is nearer than usual
  #decidedAt = -Infinity; // ms
  #shown = null;

  nearer(nearer) {
    this.zoom = clamp(this.zoom * (nearer ? ZOOM_FACTOR : 1 / ZOOM_FACTOR), ...ZOOMS);
  }

  // What is followed: the wearer's mark, or the likeliest candidate while it is not long that the place was decided; or null.
  target(place, level, wearer, now) {
    if (wearer) this.#decidedAt = now;
    const best = place?.candidates[0];
    const isFollowed = !wearer && best?.level === level.id && now - this.#decidedAt < PATIENCE;
    return isFollowed ? [best.x, best.y] : wearer;
  }

  // {x, y, scale} of the view; it stops at the edge of the plan, and a plan that fits is in the middle
  part([x, y], [x0, x1, y0, y1], { width, height }) {
    const [wide, deep] = [x1 - x0 + 2 * BORDER, y1 - y0 + 2 * BORDER];
    const near = Math.min(width / ACROSS[0], height / ACROSS[1]) * this.zoom;
    const scale = this.zoom < 1 ? near : Math.max(near, Math.min(width / wide, height / deep)); // a small plan is shown whole
    const [w, h] = [width / scale, height / scale];
    const before = this.#shown;
    const inside = before?.scale === scale && Math.abs(x - before.x) < MIDDLE * w && Math.abs(y - before.y) < MIDDLE * h;
    if (reducedMotion.matches && inside) return before;
    const held = (at, middle, room, side) => middle + clamp(at - middle, ...[-1, 1].map((k) => (k * Math.max(0, room - side)) / 2));
    this.#shown = { x: held(x, (x0 + x1) / 2, wide, w), y: held(y, (y0 + y1) / 2, deep, h), scale };
    return this.#shown;
  }
}

// Direction of the last steps, rad, of points [x, y], or null.
export function heading(points) {
  const last = points.at(-1);
  for (const [x, y] of points.slice(-6, -1).reverse()) {
    const [dx, dy] = [last[0] - x, last[1] - y];
    const far = Math.hypot(dx, dy);
    if (far > MAX_JUMP) return null;
    if (far > LEAST_STEP) return Math.atan2(dy, dx);
  }
  return null;
}
