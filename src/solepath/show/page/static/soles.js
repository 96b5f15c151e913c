// Draws both soles from above: pressure where the positions of the cells are known, else contact, or outlines.

import { Surface, bounds, circle, paint, polygon, polyline, rectangle, within } from "./canvas.js";
import { Field, outlineOf } from "./field.js";
import { theme } from "./theme.js";
import { isGone } from "./trust.js";
import { FEET, LINKS, PHASES, capital, element, fixed, note, setData, show, wordOf, write } from "./words.js";

const DEFAULT_LENGTH = 0.27; // m, length of a shoe without a known layout
const PADDING = 6; // px
const MIN_TEXT_INTERVAL = 120; // ms between changes of a number, so that it can be read
const CONTACTS = { LOADING: [0, 0.42], STATIONARY: [0, 1], PUSH_OFF: [0.56, 1] }; // from heel to toe, shares of the length
const TRAIL_PARTS = 6; // older parts of the path are fainter

// What the values of the cells are shown in: newtons without areas are no pressure.
const unitOf = ({ unit, cells }) => (unit === "N" && cells.every(([, , area]) => area > 0) ? "kPa" : unit);

export class Soles {
  uses = ["feet", "scales", "links", "theme", "scene", "second", "playback"]; // "second": the newest number may not be written yet
  slow = 100; // ms between two pictures with reduced motion

  constructor(redraw) {
    this.soles = FEET.map((foot) => new Sole(foot, redraw));
  }

  // The soles are side by side.
  get surface() {
    return this.soles[0].surface;
  }

  draw(state, now) {
    for (const sole of this.soles) sole.draw(state, now);
    const shapes = this.soles.filter(({ shows }) => shows === "pressure").map(({ layout }) => layout);
    const ends = shapes.map((shape) => {
      const unit = unitOf(shape);
      const { top, beyond } = state.scales[unit];
      return `${beyond ? "≥ " : ""}${fixed(top)} ${unit}${unit === "kPa" ? "" : " a cell"}`;
    });
    show("scale", ends.length > 0);
    write("scale-top", [...new Set(ends)].join(", "));
    const gradient = `linear-gradient(to right, ${theme.stops.join(", ")})`;
    if (this.gradient !== gradient) element("scale-bar").style.background = this.gradient = gradient;
    const shown = this.soles.map(({ shows }) => shows);
    const unplaced = shown.includes("contact") && FEET.some((foot) => state.feet[foot]?.cells);
    note("soles-note", unplaced ? "Where the cells sit is not known" : shown.includes("contact") ? "No pressure cells" : "");
  }
}

class Sole {
  shows = "outline"; // "pressure" | "contact" | "outline"

  constructor(foot, redraw) {
    this.foot = foot;
    this.surface = new Surface(`sole-${foot}`, redraw);
    this.#shape(null);
  }

  // Computed once for a layout: outline, and the field within it.
  #shape(layout) {
    this.layout = layout;
    this.ring = outlineOf(this.foot, layout?.length ?? DEFAULT_LENGTH, layout?.cells ?? []);
    this.box = bounds(this.ring);
    this.field = layout && new Field(layout.cells, this.box);
  }

  draw(state, now) {
    const layout = state.layouts[this.foot];
    if (layout !== this.layout) this.#shape(layout);
    const foot = state.feet[this.foot];
    const link = state.links[`${this.foot} foot`]?.state ?? "waiting";
    const lost = isGone(state, this.foot);
    // without cells nothing came for a while, and no load is shown, unless there are none
    this.shows = foot && layout && (foot.cells || !foot.phase) ? "pressure" : foot?.phase ? "contact" : "outline";
    setData(`foot-${this.foot}`, { link, shows: this.shows, phase: foot?.phase ?? "" });
    this.#words(foot, layout, lost, link, now, state.finished);

    const context = this.surface.start();
    const place = this.#placed();
    const outline = polygon(this.ring.map(place));
    const swings = foot?.phase === "SWING";
    context.globalAlpha = lost ? 0.3 : 1;
    paint(context, outline, { fill: "sole" });
    if (this.shows === "pressure") this.#pressure(context, outline, place, foot, state.scales);
    const contact = CONTACTS[foot?.phase]; // none in the air
    if (this.shows === "contact" && contact) this.#contact(context, outline, place, contact);
    const line = foot?.phase && !swings ? this.foot : "sole-line";
    paint(context, outline, { line, width: 1.5, dash: swings ? [4, 4] : [], cap: "butt" });
    if (this.shows === "pressure") this.#centre(context, state.trails[this.foot].map(place), foot.centre && place(foot.centre));
  }

  #words(foot, layout, lost, link, now, finished) {
    const phase = foot?.phase ? wordOf(PHASES, foot.phase) : "–";
    const force = foot && foot.force !== null && !lost ? fixed(foot.force) : "";
    const forces = layout?.unit === "N";
    write(`phase-${this.foot}`, lost ? wordOf(LINKS, link) : finished && foot?.phase ? `last: ${phase}` : phase);
    this.#number(force && `${force} ${forces ? "N" : "counts"}`, phase, now);
    this.surface.setText(() => {
      const side = capital(this.foot);
      if (lost) return `${side} sole: no signal`;
      if (!foot) return `${side} sole: no data yet`;
      const load = force && `, ${force} ${forces ? "newton" : "counts"}`;
      return `${side} sole: ${phase}${load}${this.#where(foot)}`;
    });
  }

  // Writes the force at most every MIN_TEXT_INTERVAL, but at once with a new phase.
  #number(words, phase, now) {
    if (phase === this.writtenPhase && now - this.writtenAt < MIN_TEXT_INTERVAL) return;
    [this.writtenPhase, this.writtenAt] = [phase, now];
    write(`force-${this.foot}`, words);
  }

  #where({ centre }) {
    if (centre === null) return "";
    const share = (centre[0] - this.box[0]) / (this.box[1] - this.box[0]);
    return `, pressure centred on the ${share < 0.35 ? "heel" : share < 0.62 ? "midfoot" : "forefoot"}`;
  }

  // From the foot frame to px: toes up, the wearer's left on the left.
  #placed() {
    const { width, height } = this.surface;
    const [back, front, right, left] = this.box;
    const scale = Math.max(1, Math.min((width - 2 * PADDING) / (left - right), (height - 2 * PADDING) / (front - back)));
    return ([x, y]) => [0.5 * width - scale * (y - 0.5 * (left + right)), 0.5 * height - scale * (x - 0.5 * (back + front))];
  }

  #pressure(context, outline, place, { cells: loads, peak }, scales) {
    const { cells } = this.layout;
    const unit = unitOf(this.layout);
    const { values } = this.field;
    for (let i = 0; i < values.length; i++) {
      const value = ((loads?.[i] ?? 0) / 255) * peak;
      values[i] = (unit === "kPa" ? value / cells[i][2] / 1000 : value) / scales[unit].top;
    }
    const [x0, y0] = place([this.box[1], this.box[3]]);
    const [x1, y1] = place([this.box[0], this.box[2]]);
    within(context, outline, () => {
      context.drawImage(this.field.paint(values, theme.pressure), x0, y0, x1 - x0, y1 - y0);
      const dots = new Path2D();
      for (const [x, y] of cells.map(place)) dots.rect(x - 0.75, y - 0.75, 1.5, 1.5);
      paint(context, dots, { fill: "sole-line", alpha: 0.5 });
    });
  }

  // Draws heel, whole sole, or forefoot.
  #contact(context, outline, place, [from, to]) {
    const [back, front, right, left] = this.box;
    const [x0, y0] = place([back + to * (front - back), left]);
    const [x1, y1] = place([back + from * (front - back), right]);
    within(context, outline, () => paint(context, rectangle(x0, y0, x1 - x0, y1 - y0), { fill: `${this.foot}-soft` }));
  }

  // A white line on a dark one can be seen on every colour of the scale.
  #centre(context, trail, centre) {
    for (let part = 0; part < TRAIL_PARTS; part++) {
      const [from, to] = [part, part + 1].map((k) => Math.floor((k * (trail.length - 1)) / TRAIL_PARTS));
      if (to <= from) continue;
      const path = polyline(trail.slice(from, to + 1));
      const alpha = ((part + 1) / TRAIL_PARTS) * (centre ? 1 : 0.4);
      paint(context, path, { line: "#0a141e", width: 3.5, alpha: 0.65 * alpha, cap: "butt" });
      paint(context, path, { line: "#fff", width: 1.75, alpha, cap: "butt" });
    }
    if (centre) paint(context, circle(centre, 6), { fill: "#fff", line: "#0a141e", width: 2.5 });
  }
}
