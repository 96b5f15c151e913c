// How the view follows the wearer, and how the wearer's mark moves between two places.

import { reducedMotion } from "./canvas.js";

export const MAX_JUMP = 5; // m between two places; above it another candidate became the likeliest, without a walk there
const SPANS = [150, 900]; // ms, least and longest time in which the mark goes to a new place
const ACROSS = [30, 16]; // m that are shown at least, from left to right and from top to bottom
const BORDER = 1.5; // m around the plan
const MIDDLE = 0.3; // share of the picture to each side of its middle in which the wearer stays with reduced motion
const ZOOMS = [0.25, 8]; // limits of the factor by which the followed part is nearer than usual
const ZOOM_FACTOR = 1.4;
const MIN_WEIGHT = 0.05; // share from which on a candidate counts
const MAX_SPREAD = 8; // m from the likeliest candidate to the others, within which it is followed
const PATIENCE = 3000; // ms for which the likeliest candidate is followed after the place was decided
const LEAST_STEP = 0.5; // m between two places that show a direction

// A mark that arrives at each place when the next one comes, so that it never stops amid a walk.
export class Glide {
  #from = null;
  #to = null;
  #start = 0;
  #span = 1;

  aim(place, now) {
    if (this.#to !== null && place[0] === this.#to[0] && place[1] === this.#to[1]) return;
    const jump = this.#to === null || reducedMotion.matches || Math.hypot(place[0] - this.#to[0], place[1] - this.#to[1]) > MAX_JUMP;
    this.#from = jump ? place : this.at(now);
    this.#span = Math.min(SPANS[1], Math.max(SPANS[0], now - this.#start));
    this.#start = now;
    this.#to = [place[0], place[1]];
  }

  at(now) {
    const share = this.moving(now) ? (now - this.#start) / this.#span : 1;
    return [0, 1].map((k) => this.#from[k] + share * (this.#to[k] - this.#from[k]));
  }

  moving(now) {
    return this.#to !== null && now - this.#start < this.#span;
  }

  // Forgets the place, for instance on another level.
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
    this.zoom = Math.min(ZOOMS[1], Math.max(ZOOMS[0], this.zoom * (nearer ? ZOOM_FACTOR : 1 / ZOOM_FACTOR)));
  }

  // What is followed: the wearer's mark, or the likeliest candidate while the others are close to it, and while it is not
  // long that the place was decided. null: the candidates are spread.
  target(place, level, wearer, now) {
    if (wearer) this.#decidedAt = now;
    if (wearer || !place) return wearer;
    const [best, ...others] = place.candidates.filter(({ weight }, i) => i === 0 || weight >= MIN_WEIGHT);
    if (!best || best.level !== level.id) return null;
    const close = others.every(({ level: of, x, y }) => of === level.id && Math.hypot(x - best.x, y - best.y) < MAX_SPREAD);
    return close || now - this.#decidedAt < PATIENCE ? [best.x, best.y] : null;
  }

  // {x, y, scale} of the view
  part([x, y], extent, { width, height }) {
    const [wide, deep] = [extent[2] - extent[0] + 2 * BORDER, extent[3] - extent[1] + 2 * BORDER];
    const near = Math.min(width / ACROSS[0], height / ACROSS[1]) * this.zoom;
    const scale = this.zoom < 1 ? near : Math.max(near, Math.min(width / wide, height / deep)); // a small plan is shown whole
    const [w, h] = [width / scale, height / scale];
    const before = this.#shown;
    const inside = before?.scale === scale && Math.abs(x - before.x) < MIDDLE * w && Math.abs(y - before.y) < MIDDLE * h;
    if (reducedMotion.matches && inside) return before;
    // the view stops at the edge of the plan, and a plan that fits is in the middle
    const held = (at, from, to, side) =>
      to - from <= side ? (from + to) / 2 : Math.min(to - side / 2, Math.max(from + side / 2, at));
    this.#shown = {
      x: held(x, extent[0] - BORDER, extent[2] + BORDER, w),
      y: held(y, extent[1] - BORDER, extent[3] + BORDER, h),
      scale,
    };
    return this.#shown;
  }
}

// Direction of the last steps, rad, of points [x, y], or null.
export function heading(points) {
  const last = points.at(-1);
  for (let i = points.length - 2; i >= Math.max(0, points.length - 6); i--) {
    const [dx, dy] = [last[0] - points[i][0], last[1] - points[i][1]];
    const far = Math.hypot(dx, dy);
    if (far > MAX_JUMP) return null;
    if (far > LEAST_STEP) return Math.atan2(dy, dx);
  }
  return null;
}
