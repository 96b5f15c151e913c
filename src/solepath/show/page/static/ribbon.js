// The phases of both feet over the last seconds: a ramp up while the foot is loaded, level while it is flat, a ramp
// down while it pushes off, a line while it swings. Between the feet: the times with both on the ground.

import { Alternative, Surface, reducedMotion } from "./canvas.js";
import { Labels } from "./labels.js";
import { FEET } from "./state.js";
import { theme } from "./theme.js";
import { LINKS, PHASES, SUPPORTS, capital, clock, wordOf } from "./words.js";

const TIME_WINDOW = 8; // s
const NAMED_WIDTH = 340; // px from which on the feet have their whole names
const LABEL_WIDTHS = [20, 44]; // px for the letters of the feet, and for their names
const [TIMES_HEIGHT, BETWEEN] = [20, 12]; // px for the times below, and for the times with both feet on the ground
// Height of a phase at its start and at its end, as shares of the row.
const RAMPS = { LOADING: [0.32, 1], STATIONARY: [1, 1], PUSH_OFF: [1, 0.32], SWING: [0.08, 0.08] };
const SHADES = { LOADING: "-soft", STATIONARY: "", PUSH_OFF: "-soft", SWING: "" };
const [HATCH, LEAST_NAMED] = [7, 64]; // px between the lines where a foot sends nothing, and from which width on it says so
const SLOW_INTERVAL = 500; // ms between pictures with reduced motion

export class Ribbon {
  uses = ["phases", "scene", "theme", "playback", "links"];

  constructor(redraw) {
    const canvas = document.getElementById("ribbon");
    this.surface = new Surface(canvas, redraw);
    this.alternative = new Alternative(canvas);
    this.labels = new Labels(canvas, "card");
    this.drawn = 0;
  }

  draw(state, now, changed, t) {
    if (reducedMotion.matches && now - this.drawn < SLOW_INTERVAL && !changed.has("theme")) return "later";
    this.drawn = now;
    const context = this.surface.start();
    const { width, height } = this.surface;
    const named = width >= NAMED_WIDTH;
    const side = LABEL_WIDTHS[named ? 1 : 0];
    const scale = (width - side) / TIME_WINDOW;
    const x = (when) => side + Math.max(0, (when - t + TIME_WINDOW) * scale);
    const band = Math.floor((height - TIMES_HEIGHT - BETWEEN) / 2);
    const rows = { left: [0, band], right: [band + BETWEEN, band] };
    this.labels.start(this.surface);
    this.#seconds(context, x, t, side, state.start);
    const spans = {};
    for (const foot of FEET) spans[foot] = this.#row(context, state.phases[foot], foot, rows[foot], x, t);
    context.fillStyle = theme.colours.both;
    for (const [from, to] of overlaps(spans.left, spans.right)) {
      context.fillRect(x(from), band + BETWEEN / 2 - 3, Math.max(1, x(to) - x(from)), 6);
    }
    for (const foot of FEET) {
      const words = named ? capital(foot) : capital(foot)[0];
      this.labels.add(words, [[0, rows[foot][0] + band / 2, "left"]], { weight: 9, colour: foot, bold: true });
    }
    this.labels.finish(context);
    this.alternative.setText(() => {
      const words = FEET.map((foot) => `${foot} ${phaseWords(state, foot)}`);
      const ground = wordOf(SUPPORTS, state.support) || "not known";
      const now = `Now: ${words.join(", ")}; on the ground: ${ground}`;
      return `Phases of both feet over the last ${TIME_WINDOW} seconds. ${now}`;
    });
    return "done";
  }

  #seconds(context, x, t, side, start) {
    const { height } = this.surface;
    const path = new Path2D();
    for (let second = Math.max(0, Math.ceil(t - start - TIME_WINDOW)); second <= t - start; second++) {
      const at = Math.round(x(start + second)) + 0.5;
      if (at < side + 1) continue;
      path.moveTo(at, 0);
      path.lineTo(at, height - TIMES_HEIGHT + 2);
      if (second % 2 === 0 && at > side + 16) this.labels.add(clock(second), [[at, height - 8]]);
    }
    context.lineWidth = 1;
    context.strokeStyle = theme.colours.line;
    context.stroke(path);
  }

  // Draws a row and returns the spans on the ground.
  #row(context, phases, foot, [y, band], x, t) {
    const ground = [];
    const silent = [];
    const paths = { "": new Path2D(), "-soft": new Path2D() };
    for (let i = 0; i < phases.length; i++) {
      const [from, phase] = phases[i];
      const to = Math.min(t, phases[i + 1]?.[0] ?? t);
      if (to <= t - TIME_WINDOW || to <= from) continue;
      if (phase === "") silent.push([x(from), x(to)]); // nothing came of the foot
      if (phase === "") continue;
      if (phase !== "SWING") ground.push([from, to]);
      const [rise, fall] = RAMPS[phase] ?? [0.5, 0.5];
      const path = paths[SHADES[phase] ?? "-soft"];
      // a phase that started before the window is drawn from the window's start
      const share = Math.max(0, (t - TIME_WINDOW - from) / (to - from));
      const top = rise + (fall - rise) * share;
      path.moveTo(x(from), y + band);
      path.lineTo(x(from), y + band * (1 - top));
      path.lineTo(x(to), y + band * (1 - fall));
      path.lineTo(x(to), y + band);
      path.closePath();
    }
    for (const [shade, path] of Object.entries(paths)) {
      context.fillStyle = theme.colours[foot + shade];
      context.fill(path);
      if (shade === "") continue;
      context.lineWidth = 1; // the pale shapes by themselves are hard to see
      context.strokeStyle = theme.colours[foot];
      context.stroke(path);
    }
    for (const [from, to] of silent) this.#silent(context, from, to, y, band);
    return ground;
  }

  // Hatched: what the foot did is not known.
  #silent(context, from, to, y, band) {
    context.save();
    context.beginPath();
    context.rect(from, y, to - from, band);
    context.clip();
    const path = new Path2D();
    for (let at = from - band - (from % HATCH); at < to; at += HATCH) {
      path.moveTo(at, y + band);
      path.lineTo(at + band, y);
    }
    context.lineWidth = 1;
    context.strokeStyle = theme.colours["sole-line"];
    context.stroke(path);
    context.restore();
    if (to - from >= LEAST_NAMED) this.labels.add("no data", [[(from + to) / 2, y + band / 2]], { weight: 7, colour: "ink" });
  }
}

function phaseWords({ phases, links }, foot) {
  const phase = phases[foot].at(-1)?.[1];
  if (phase) return wordOf(PHASES, phase);
  const link = links[`${foot} foot`]?.state;
  if (link === "lost" || link === "silent") return wordOf(LINKS, link);
  return phases[foot].length > 0 ? "no data any more" : "no data yet";
}

// Intersection of two lists of [from, to] in order of time.
function overlaps(one, other) {
  const found = [];
  let [i, j] = [0, 0];
  while (i < one.length && j < other.length) {
    const [from, to] = [Math.max(one[i][0], other[j][0]), Math.min(one[i][1], other[j][1])];
    if (to > from) found.push([from, to]);
    if (one[i][1] < other[j][1]) i += 1;
    else j += 1;
  }
  return found;
}
