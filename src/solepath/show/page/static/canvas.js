// A canvas that always has as many pixels as the screen shows of it, and what is drawn on it: paths in px.

import { colour } from "./theme.js";
import { describe, element } from "./words.js";

const MAX_PIXEL_RATIO = 2; // device pixels per CSS px; more cost time and show nothing
const NEAR = "100px"; // what is so close to the edge of the screen is drawn as if it were seen
const SPEECH_INTERVAL = 1000; // ms between two text alternatives, so that a screen reader is not interrupted

export class Surface {
  width = 0; // CSS px
  height = 0;
  ratio = 1;
  seen = true; // false while it is out of sight
  #words = null; // a function that makes the text alternative; null while the last one is said
  #silent = false;

  // resized() is called when the canvas has another size, and is blank, and when it comes into sight again.
  constructor(id, resized) {
    this.canvas = element(id);
    this.context = this.canvas.getContext("2d");
    this.resized = resized;
    new ResizeObserver(() => this.fit()).observe(this.canvas);
    new IntersectionObserver((entries) => this.#see(entries.at(-1).isIntersecting), { rootMargin: NEAR }).observe(this.canvas);
    addEventListener("resize", () => this.fit()); // zooming the page may change only the pixel ratio, not the size
    this.fit();
  }

  #see(seen) {
    const wasSeen = this.seen;
    this.seen = seen;
    if (seen && !wasSeen) this.resized();
  }

  fit() {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = Math.min(MAX_PIXEL_RATIO, devicePixelRatio || 1);
    if (clientWidth === this.width && clientHeight === this.height && ratio === this.ratio) return;
    Object.assign(this, { width: clientWidth, height: clientHeight, ratio });
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    this.resized();
  }

  // Clears the canvas; sizes are in CSS px.
  start() {
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    return this.context;
  }

  // Sets the text alternative. The last one of an interval is the one that is said.
  setText(words) {
    this.#words = words;
    if (!this.#silent) this.#speak();
  }

  #speak() {
    describe(this.canvas, "aria-label", this.#words());
    this.#words = null;
    this.#silent = true;
    setTimeout(() => {
      this.#silent = false;
      if (this.#words !== null) this.#speak();
    }, SPEECH_INTERVAL);
  }
}

// Adds a line through points to a path, and returns the path.
export function polyline(points, path = new Path2D()) {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  return path;
}

export function polygon(points, path = new Path2D()) {
  polyline(points, path).closePath();
  return path;
}

export function circle([x, y], radius, path = new Path2D()) {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
  return path;
}

export function rectangle(x, y, width, height) {
  const path = new Path2D();
  path.rect(x, y, width, height);
  return path;
}

// Fills a path with a colour, draws its line in another, or both: colours of style.css by name, or any other.
export function paint(context, path, { fill, line, width = 1, dash = [], cap = "round", alpha = 1 }) {
  context.save();
  context.globalAlpha *= alpha;
  if (fill) {
    context.fillStyle = colour(fill);
    context.fill(path);
  }
  if (line) {
    context.strokeStyle = colour(line);
    context.lineWidth = width;
    context.lineCap = cap;
    context.lineJoin = cap === "round" ? "round" : "miter";
    context.setLineDash(dash);
    context.stroke(path);
  }
  context.restore();
}

// Calls draw() while only what is within the path is drawn.
export function within(context, path, draw) {
  context.save();
  context.clip(path);
  draw();
  context.restore();
}

// The least round number (1, 2 or 5 times a power of ten) that is not below `value`.
export function round(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-6)));
  return [1, 2, 5, 10].find((step) => step * power >= value * 0.999) * power;
}

// [least, greatest] of values.
export const range = (values) => values.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);

// Of points: the least and the greatest x, the least and the greatest y.
export const bounds = (points) => [0, 1].flatMap((k) => range(points.map((point) => point[k])));

export const clamp = (value, least, most) => Math.min(most, Math.max(least, value));

export const TEXT_SIZE = 12; // px, least size of a text
export const FONT_FAMILY = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif';
export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
