// Draws both soles from above: pressure where the positions of the cells are known, else bars, contact, or outlines.

import { Alternative, Surface, reducedMotion } from "./canvas.js";
import { Field } from "./field.js";
import { around, shoe, spacing } from "./outline.js";
import { pressure, scaleOf } from "./scales.js";
import { FEET } from "./state.js";
import { theme } from "./theme.js";
import { LINKS, PHASES, capital, fixed, wordOf, show, setData, write } from "./words.js";

const DEFAULT_LENGTH = 0.27; // m, length of a shoe without a known layout
const PADDING = 6; // px
const MIN_TEXT_INTERVAL = 120; // ms between changes of a number, so that it can be read

export class Soles {
  // "second", since the newest number may not have been written yet
  uses = ["feet", "scales", "links", "theme", "scene", "second", "playback"];

  constructor(redraw) {
    this.soles = FEET.map((foot) => new Sole(foot, redraw));
    this.scale = document.getElementById("scale");
    this.bar = document.getElementById("scale-bar");
    this.top = document.getElementById("scale-top");
    this.note = document.getElementById("soles-note");
    this.drawn = 0;
  }

  // Returns whether it drew; with reduced motion there are ten pictures a second.
  draw(state, now, changed) {
    if (reducedMotion.matches && now - this.drawn < 100 && !changed.has("theme")) return "later";
    this.drawn = now;
    for (const sole of this.soles) sole.draw(state, now);
    this.#legend(state);
    return "done";
  }

  #legend({ layouts, scales }) {
    const shapes = FEET.filter((foot) =>
      this.soles.some((sole) => sole.foot === foot && sole.shows === "pressure"),
    ).map((foot) => layouts[foot]);
    show(this.scale, shapes.length > 0);
    const ends = shapes.map((shape) => {
      const { top, beyond } = scaleOf(scales, shape);
      return `${beyond ? "≥ " : ""}${fixed(top)} ${shape.word}`;
    });
    write(this.top, [...new Set(ends)].join(", "));
    const gradient = `linear-gradient(to right, ${theme.stops.map((stop) => `rgb(${stop})`).join(", ")})`;
    if (this.gradient !== gradient) this.bar.style.background = this.gradient = gradient;
    const shown = this.soles.map((sole) => sole.shows);
    const words = shown.includes("bars")
      ? "Where the cells sit is not known: one bar each, in their order."
      : shown.includes("contact")
        ? "No pressure cells"
        : "";
    write(this.note, words);
    show(this.note, words !== "");
  }
}

function shown(foot, layout) {
  if (!foot) return "outline";
  if (foot.cells) return layout ? "pressure" : "bars";
  if (foot.phase) return "contact";
  return layout ? "pressure" : "outline"; // nothing came for a while, so no load is shown
}

class Sole {
  shows = "outline"; // "pressure" | "bars" | "contact" | "outline"

  constructor(foot, redraw) {
    this.foot = foot;
    this.figure = document.getElementById(`foot-${foot}`);
    this.phase = document.getElementById(`phase-${foot}`);
    this.force = document.getElementById(`force-${foot}`);
    const canvas = document.getElementById(`sole-${foot}`);
    this.surface = new Surface(canvas, redraw);
    this.alternative = new Alternative(canvas);
    this.written = 0;
    this.#shape(null);
  }

  // Computed once for a layout: outline, and the field within it.
  #shape(layout) {
    this.layout = layout;
    const apart = layout && spacing(layout.cells);
    this.ring = layout ? around(layout.cells, layout.length, this.foot, apart) : shoe(this.foot, DEFAULT_LENGTH);
    const [xs, ys] = [0, 1].map((k) => this.ring.map((point) => point[k]));
    this.box = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    this.field = layout && new Field(layout.cells, apart, this.box);
  }

  draw(state, now) {
    const layout = state.layouts[this.foot];
    if (layout !== this.layout) this.#shape(layout);
    const foot = state.feet[this.foot];
    const link = state.links[`${this.foot} foot`]?.state ?? "waiting";
    const lost = link === "lost" || link === "silent";
    this.shows = shown(foot, layout);
    setData(this.figure, { link, shows: this.shows, phase: foot?.phase ?? "" });
    this.#words(foot, layout, lost, link, now, state.finished);

    const context = this.surface.start();
    const place = this.#placed();
    const outline = this.#path(this.ring.map(place));
    context.globalAlpha = lost ? 0.3 : 1;
    context.fillStyle = theme.colours.sole;
    context.fill(outline);
    if (this.shows === "pressure") this.#pressure(context, outline, place, foot, scaleOf(state.scales, layout).top);
    if (this.shows === "bars") this.#bars(context, place, foot);
    if (this.shows === "contact") this.#contact(context, outline, place, foot.phase);
    context.lineWidth = 1.5;
    context.strokeStyle = foot?.phase && foot.phase !== "SWING" ? theme.colours[this.foot] : theme.colours["sole-line"];
    context.setLineDash(foot?.phase === "SWING" ? [4, 4] : []);
    context.stroke(outline);
    context.setLineDash([]);
    if (this.shows === "pressure") this.#centre(context, place, state.trails[this.foot], foot.centre);
    context.globalAlpha = 1;
  }

  // The text below the picture and its text alternative show one moment: both are written together.
  #words(foot, layout, lost, link, now, finished) {
    const phase = foot?.phase ? wordOf(PHASES, foot.phase) : "–";
    const force = foot && foot.force !== null && !lost ? fixed(foot.force) : "";
    write(this.phase, lost ? wordOf(LINKS, link) : finished && foot?.phase ? `last: ${phase}` : phase);
    this.#number(force && `${force} ${layout?.forces ? "N" : "counts"}`, phase, now);
    this.alternative.setText(() => {
      this.put();
      const side = capital(this.foot);
      if (lost) return `${side} sole: no signal`;
      if (!foot) return `${side} sole: no data yet`;
      const load = force && `, ${force} ${layout?.forces ? "newton" : "counts"}`;
      return `${side} sole: ${phase}${load}${this.#where(foot)}`;
    });
  }

  // Writes the force at most every MIN_TEXT_INTERVAL, but at once with a new phase; the last text is always written.
  #number(words, phase, now) {
    clearTimeout(this.timer);
    const wait = phase === this.writtenPhase ? MIN_TEXT_INTERVAL - (now - this.written) : 0;
    this.writtenPhase = phase;
    this.put = () => {
      clearTimeout(this.timer);
      this.written = performance.now();
      write(this.force, words);
    };
    if (wait > 0) this.timer = setTimeout(this.put, wait);
    else this.put();
  }

  #where(foot) {
    if (foot.centre === null) return "";
    const share = (foot.centre[0] - this.box[0]) / (this.box[1] - this.box[0]);
    return `, pressure centred on the ${share < 0.35 ? "heel" : share < 0.62 ? "midfoot" : "forefoot"}`;
  }

  // From the foot frame to px: toes up, the wearer's left on the left.
  #placed() {
    const { width, height } = this.surface;
    const [back, front, right, left] = this.box;
    const fits = Math.min((width - 2 * PADDING) / (left - right), (height - 2 * PADDING) / (front - back));
    const scale = Math.max(1, fits);
    const [cx, cy] = [0.5 * (back + front), 0.5 * (left + right)];
    return ([x, y]) => [0.5 * width - scale * (y - cy), 0.5 * height - scale * (x - cx)];
  }

  #path(points) {
    const path = new Path2D();
    points.forEach(([x, y]) => path.lineTo(x, y));
    path.closePath();
    return path;
  }

  #pressure(context, outline, place, foot, highest) {
    const { cells } = this.layout;
    const { values } = this.field;
    for (let i = 0; i < values.length; i++) {
      values[i] = pressure(this.layout, i, ((foot.cells?.[i] ?? 0) / 255) * foot.peak) / highest;
    }
    const [x0, y0] = place([this.box[1], this.box[3]]);
    const [x1, y1] = place([this.box[0], this.box[2]]);
    context.save();
    context.clip(outline);
    context.drawImage(this.field.paint(values, theme.pressure), x0, y0, x1 - x0, y1 - y0);
    context.fillStyle = theme.colours["sole-line"];
    context.globalAlpha *= 0.5;
    for (const cell of cells) {
      const [x, y] = place(cell);
      context.fillRect(x - 0.75, y - 0.75, 1.5, 1.5);
    }
    context.restore();
  }

  #bars(context, place, foot) {
    const [back, front, right, left] = this.box;
    const [x0, y0] = place([back + 0.9 * (front - back), left - 0.2 * (left - right)]);
    const [x1, y1] = place([back + 0.1 * (front - back), right + 0.2 * (left - right)]);
    const step = (y1 - y0) / foot.cells.length;
    foot.cells.forEach((value, i) => {
      const y = y0 + i * step;
      const colour = 3 * value;
      context.fillStyle = theme.colours.grid;
      context.fillRect(x0, y, x1 - x0, Math.max(1, step - 2));
      context.fillStyle = `rgb(${theme.pressure.subarray(colour, colour + 3).join()})`;
      context.fillRect(x0, y, ((x1 - x0) * value) / 255, Math.max(1, step - 2));
    });
  }

  // Draws heel, whole sole, or forefoot; nothing in the air.
  #contact(context, outline, place, phase) {
    const part = { LOADING: [0, 0.42], STATIONARY: [0, 1], PUSH_OFF: [0.56, 1] }[phase];
    if (!part) return;
    const [back, front, right, left] = this.box;
    const [x0, y0] = place([back + part[1] * (front - back), left]);
    const [x1, y1] = place([back + part[0] * (front - back), right]);
    context.save();
    context.clip(outline);
    context.fillStyle = theme.colours[`${this.foot}-soft`];
    context.fillRect(x0, y0, x1 - x0, y1 - y0);
    context.restore();
  }

  // A white line on a dark one can be seen on every colour of the scale.
  #centre(context, place, trail, centre) {
    context.lineJoin = "round";
    context.lineCap = "butt";
    const points = trail.map(place);
    const parts = 6; // older parts are fainter
    for (let part = 0; part < parts; part++) {
      const [from, to] = [part, part + 1].map((k) => Math.floor((k * (points.length - 1)) / parts));
      if (to <= from) continue;
      const path = new Path2D();
      for (let i = from; i <= to; i++) path.lineTo(...points[i]);
      const alpha = ((part + 1) / parts) * (centre ? 1 : 0.4);
      context.lineWidth = 3.5;
      context.strokeStyle = `rgba(10, 20, 30, ${0.65 * alpha})`;
      context.stroke(path);
      context.lineWidth = 1.75;
      context.strokeStyle = `rgba(255, 255, 255, ${alpha})`;
      context.stroke(path);
    }
    if (!centre) return;
    const [x, y] = place(centre);
    context.beginPath();
    context.arc(x, y, 6, 0, 2 * Math.PI);
    context.fillStyle = "#ffffff";
    context.fill();
    context.lineWidth = 2.5;
    context.strokeStyle = "#0a141e";
    context.stroke();
  }
}
