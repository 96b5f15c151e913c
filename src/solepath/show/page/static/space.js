// The track in space, above its floor, as the report draws it (show/report/figures/space.py): an isometric projection
// without perspective, with heights drawn larger where the track is flat. It is shown once there are heights to see.

import { Alternative, Surface, round } from "./canvas.js";
import { onPlanHeights } from "./heights.js";
import { Labels } from "./labels.js";
import { theme } from "./theme.js";
import { fixed, setData, show, write } from "./words.js";

const LEAST_RISE = 1; // m, least range of heights that is drawn: half a storey's flight
const SLANT = Math.PI / 6; // angle of the x and the y axis to the horizontal of the drawing
const EXAGGERATIONS = [1, 2, 5, 10]; // factors by which heights may be drawn larger
const LEAST_HEIGHT_SHARE = 0.25; // height of the track in the drawing, as a share of the width of its floor
const LEAST_EXTENT = 2; // m, least side of the floor
const SQUARES = 8; // largest number of squares along a side of the floor, about
const [MARGIN, LABEL_WIDTH] = [18, 44]; // px around the drawing, and for the heights at its left
const REDRAW_INTERVAL = 1000; // ms between two pictures: a stride is not much shorter

// Place in the drawing, right and down, m, of a position in space: x to the lower right, y to the upper.
export const project = ([x, y, z], exaggeration) => [
  (x + y) * Math.cos(SLANT),
  (x - y) * Math.sin(SLANT) - z * exaggeration,
];

export class Space {
  uses = ["tracks", "places", "scene", "theme"];
  #drawnAt = -Infinity;
  #rise = 0; // m, and number of points for which it is
  #low = 0;
  #counted = "";

  constructor(redraw) {
    this.card = document.getElementById("space-card");
    const canvas = document.getElementById("space");
    this.surface = new Surface(canvas, redraw);
    this.alternative = new Alternative(canvas);
    this.labels = new Labels(canvas, "card");
    this.note = document.getElementById("space-note");
  }

  draw({ tracks, places, plan, generation, thinned }, now, changed) {
    const track = [tracks.wearer, tracks.left, tracks.right].find((some) => some.length > 1) ?? [];
    const counted = `${generation} ${thinned} ${track.length} ${places.length}`;
    if (counted !== this.#counted) {
      this.#counted = counted;
      const points = (this.points = plan && places.length > 1 ? onPlanHeights(track, places) : track);
      const [low, high] = range(points.map((point) => point[3]));
      [this.#low, this.#rise] = [low, points.length > 1 ? high - low : 0];
      show(this.card, this.#rise >= LEAST_RISE);
    }
    if (this.#rise < LEAST_RISE) return "done";
    if (now - this.#drawnAt < REDRAW_INTERVAL && !changed.has("theme") && !changed.has("scene")) return "later";
    this.#drawnAt = now;
    this.surface.fit(); // it had no size while the card was hidden
    this.#picture(this.points.map((point) => point.slice(1)));
    return "done";
  }

  #picture(places) {
    const [low, rise] = [this.#low, this.#rise];
    const [step, xs, ys] = floor(places);
    const wide = (xs[1] - xs[0] + ys[1] - ys[0]) * Math.cos(SLANT);
    const exaggeration = EXAGGERATIONS.find((k) => k * rise >= LEAST_HEIGHT_SHARE * wide) ?? EXAGGERATIONS.at(-1);
    const corners = xs.flatMap((x) => ys.map((y) => [x, y, low]));
    const all = [...corners, [xs[0], ys[0], low + rise], ...places].map((place) => project(place, exaggeration));
    const [[left, right], [top, bottom]] = [0, 1].map((k) => range(all.map((one) => one[k])));
    const { width, height } = this.surface;
    const scale = Math.min((width - 2 * (MARGIN + LABEL_WIDTH)) / (right - left), (height - 2 * MARGIN) / (bottom - top));
    const from = [0.5 * (width - (right - left) * scale), 0.5 * (height - (bottom - top) * scale)];
    const px = (place) => {
      const [u, v] = project(place, exaggeration);
      return [from[0] + (u - left) * scale, from[1] + (v - top) * scale];
    };

    const context = this.surface.start();
    const rules = new Path2D();
    for (const x of marks(xs, step)) line(rules, [px([x, ys[0], low]), px([x, ys[1], low])]);
    for (const y of marks(ys, step)) line(rules, [px([xs[0], y, low]), px([xs[1], y, low])]);
    stroke(context, rules, 1, theme.colours.line);
    stroke(context, line(new Path2D(), places.map(([x, y]) => px([x, y, low]))), 1, theme.colours.muted, [3, 4]);
    stroke(context, line(new Path2D(), places.map(px)), 2.5, theme.colours.wearer);
    this.labels.start(this.surface);
    for (const [place, words] of [[places[0], "start"], [places.at(-1), "now"]]) {
      const [a, b] = px(place);
      stroke(context, line(new Path2D(), [[a, b], px([place[0], place[1], low])]), 1, theme.colours.muted);
      const radius = words === "now" ? 6 : 4.5;
      context.beginPath();
      context.arc(a, b, radius, 0, 2 * Math.PI);
      context.fillStyle = words === "now" ? theme.colours.wearer : theme.colours.muted;
      context.fill();
      this.labels.keep(a - radius, b - radius, 2 * radius, 2 * radius);
      const off = radius + 5;
      const spots = [[a + off, b - 4, "left"], [a - off, b - 4, "right"], [a, b - 15], [a, b + 15]];
      this.labels.add(words, spots, { weight: words === "now" ? 9 : 8, colour: "ink", bold: words === "now" });
    }
    this.#upright(context, px, [xs[0], ys[0]]);
    this.labels.finish(context);
    const larger = exaggeration > 1 ? ` Heights are drawn ${exaggeration} times as large.` : "";
    write(this.note, `A square of the floor is ${step} m wide.${larger}`);
    this.alternative.setText(() => `The track in space, with heights from ${fixed(low, 1)} to ${fixed(low + rise, 1)} m`);
    setData(this.surface.canvas, { points: places.length, exaggeration });
  }

  // The axis of heights at the left corner of the floor.
  #upright(context, px, [x, y]) {
    const [low, high] = [this.#low, this.#low + this.#rise];
    stroke(context, line(new Path2D(), [px([x, y, low]), px([x, y, high])]), 1, theme.colours.muted);
    const step = round((high - low) / 4);
    for (let z = Math.ceil(low / step) * step; z <= high; z += step) {
      const [a, b] = px([x, y, z]);
      this.labels.add(`${fixed(z, step < 1 ? 1 : 0)} m`, [[a - 8, b, "right"]], { weight: 2 });
    }
  }
}

// Side of a square of the floor, and the ends of the floor along x and along y, m.
function floor(places) {
  const both = [0, 1].map((k) => range(places.map((place) => place[k])));
  const step = round(Math.max(LEAST_EXTENT, ...both.map(([a, b]) => b - a)) / SQUARES);
  const ends = both.map(([a, b]) => {
    const first = Math.floor(a / step) * step;
    return [first, Math.max(Math.ceil(b / step) * step, first + step)];
  });
  return [step, ...ends];
}

const range = (values) => values.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);

const marks = ([from, to], step) => Array.from({ length: Math.round((to - from) / step) + 1 }, (_, k) => from + k * step);

function line(path, points) {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  return path;
}

function stroke(context, path, width, colour, dash = []) {
  context.lineWidth = width;
  context.lineCap = context.lineJoin = "round";
  context.strokeStyle = colour;
  context.setLineDash(dash);
  context.stroke(path);
  context.setLineDash([]);
}
