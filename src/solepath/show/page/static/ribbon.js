// The phases of both feet over the last seconds: a ramp up while the foot is loaded, level while it is flat, a ramp
// down while it pushes off, a line while it swings. Between the feet: the times with both on the ground.

import { Surface, paint, polygon, polyline, rectangle, within } from "./canvas.js";
import { Glide } from "./following.js";
import { Labels } from "./labels.js";
import { isGone } from "./trust.js";
import { FEET, LINKS, PHASES, SUPPORTS, capital, clock, wordOf } from "./words.js";

const TIME_WINDOW = 8; // s
const GLIDE_TIMES = [30, 1000]; // ms, least and longest time in which the shown time goes on to that of a message
const NAMED_WIDTH = 340; // px from which on the feet have their whole names
const LABEL_WIDTHS = [20, 44]; // px for the letters of the feet, and for their names
const [TIMES_HEIGHT, BETWEEN] = [20, 12]; // px for the times below, and for the times with both feet on the ground
// Height of a phase at its start and at its end, as shares of the row, and its shade.
const SHAPES = {
  LOADING: [0.32, 1, "-soft"],
  STATIONARY: [1, 1, ""],
  PUSH_OFF: [1, 0.32, "-soft"],
  SWING: [0.08, 0.08, ""],
};
const [HATCH, LEAST_NAMED] = [7, 64]; // px between the lines where a foot sends nothing, and from which width on it says so

export class Ribbon {
  uses = ["t", "phases", "scene", "theme", "playback", "links"];
  slow = 500; // ms between two pictures with reduced motion
  moving = false;
  #time = new Glide(GLIDE_TIMES, TIME_WINDOW);

  constructor(redraw) {
    this.surface = new Surface("ribbon", redraw);
    this.labels = new Labels(this.surface, "card");
  }

  draw(state, now) {
    const { generation, phases } = state;
    if (generation !== this.generation) this.#time.clear();
    this.generation = generation;
    this.#time.aim([state.t], now);
    this.moving = FEET.some((foot) => phases[foot].length > 0) && this.#time.moving(now);
    const [t] = this.#time.at(now);
    const context = this.surface.start();
    const { width, height } = this.surface;
    const named = width >= NAMED_WIDTH;
    const side = LABEL_WIDTHS[named ? 1 : 0];
    const x = (when) => side + Math.max(0, ((when - t + TIME_WINDOW) * (width - side)) / TIME_WINDOW);
    const band = Math.floor((height - TIMES_HEIGHT - BETWEEN) / 2);
    this.labels.start();
    this.#seconds(context, x, t, side, state.start);
    const spans = FEET.map((foot, k) => {
      const top = k * (band + BETWEEN);
      this.labels.add(named ? capital(foot) : capital(foot)[0], [[0, top + band / 2, "left"]], { weight: 9, colour: foot, bold: true });
      return this.#row(context, phases[foot], foot, top, band, x, t);
    });
    for (const [from, to] of spans[0].flatMap((one) => spans[1].map((other) => overlap(one, other)))) {
      if (to > from) paint(context, rectangle(x(from), band + BETWEEN / 2 - 3, Math.max(1, x(to) - x(from)), 6), { fill: "both" });
    }
    this.labels.finish();
    this.surface.setText(() => {
      const words = FEET.map((foot) => `${foot} ${phaseWords(state, foot)}`);
      const ground = wordOf(SUPPORTS, state.support) || "not known";
      return `Phases of both feet over the last ${TIME_WINDOW} seconds. Now: ${words.join(", ")}; on the ground: ${ground}`;
    });
  }

  #seconds(context, x, t, side, start) {
    const { height } = this.surface;
    const path = new Path2D();
    for (let second = Math.max(0, Math.ceil(t - start - TIME_WINDOW)); second <= t - start; second++) {
      const at = Math.round(x(start + second)) + 0.5;
      if (at < side + 1) continue;
      polyline([[at, 0], [at, height - TIMES_HEIGHT + 2]], path);
      if (second % 2 === 0 && at > side + 16) this.labels.add(clock(second), [[at, height - 8]]);
    }
    paint(context, path, { line: "line", cap: "butt" });
  }

  // Draws a row and returns the spans on the ground.
  #row(context, phases, foot, y, band, x, t) {
    const ground = [];
    phases.forEach(([from, phase], i) => {
      const to = Math.min(t, phases[i + 1]?.[0] ?? t);
      if (to <= t - TIME_WINDOW || to <= from) return;
      if (phase === null) return this.#silent(context, x(from), x(to), y, band);
      if (phase !== "SWING") ground.push([from, to]);
      const [rise, fall, shade] = SHAPES[phase];
      // a phase that started before the window is drawn from the window's start
      const top = rise + (fall - rise) * Math.max(0, (t - TIME_WINDOW - from) / (to - from));
      const heights = [[from, 0], [from, top], [to, fall], [to, 0]];
      const path = polygon(heights.map(([when, share]) => [x(when), y + band * (1 - share)]));
      paint(context, path, { fill: foot + shade, line: shade && foot, cap: "butt" }); // the pale shapes by themselves are hard to see
    });
    return ground;
  }

  // Hatched: what the foot did is not known.
  #silent(context, from, to, y, band) {
    const path = new Path2D();
    for (let at = from - band - (from % HATCH); at < to; at += HATCH) polyline([[at, y + band], [at + band, y]], path);
    within(context, rectangle(from, y, to - from, band), () => paint(context, path, { line: "sole-line", cap: "butt" }));
    if (to - from >= LEAST_NAMED) this.labels.add("no data", [[(from + to) / 2, y + band / 2]], { weight: 7, colour: "ink" });
  }
}

const overlap = ([a, b], [c, d]) => [Math.max(a, c), Math.min(b, d)];

function phaseWords(state, foot) {
  const phases = state.phases[foot];
  const phase = phases.at(-1)?.[1];
  if (phase) return wordOf(PHASES, phase);
  if (isGone(state, foot)) return wordOf(LINKS, state.links[`${foot} foot`].state);
  return phases.length > 0 ? "no data any more" : "no data yet";
}
