// The track in space, above its floor, as the report draws it (show/report/figures/space.py): an isometric projection
// without perspective, with heights drawn larger where the track is flat. It is shown once there are heights to see.

import { Surface, bounds, circle, paint, polyline, range, round } from "./canvas.js";
import { onPlanHeights, roundHeights } from "./height.js";
import { Labels } from "./labels.js";
import { fixed, setData, show, write } from "./words.js";

const LEAST_RISE = 1; // m, least range of heights that is drawn: half a storey's flight
const SLANT = Math.PI / 6; // angle of the x and the y axis to the horizontal of the drawing
const EXAGGERATIONS = [1, 2, 5, 10]; // factors by which heights may be drawn larger
const LEAST_HEIGHT_SHARE = 0.25; // height of the track in the drawing, as a share of the width of its floor
const LEAST_EXTENT = 2; // m, least side of the floor
const SQUARES = 8; // largest number of squares along a side of the floor, about
const [MARGIN, LABEL_WIDTH] = [18, 44]; // px around the drawing, and for the heights at its left
const LINE = { width: 1, line: "muted" };

// Place in the drawing, right and down, m, of a position in space: x to the lower right, y to the upper.
export const project = ([x, y, z], exaggeration) => [
  (x + y) * Math.cos(SLANT),
  (x - y) * Math.sin(SLANT) - z * exaggeration,
];

export class Space {
  uses = ["tracks", "places", "scene", "theme"];
  interval = 1000; // ms between two pictures: a stride is not much shorter

  constructor(redraw) {
    this.surface = new Surface("space", redraw);
    this.labels = new Labels(this.surface, "card");
  }

  draw({ track, places, plan }) {
    const points = (plan && places.length > 1 ? onPlanHeights(track, places) : track).map((point) => point.slice(1));
    const [low, high] = range(points.map((point) => point[2]));
    show("space-card", high - low >= LEAST_RISE);
    if (!(high - low >= LEAST_RISE)) return;
    this.surface.fit(); // it had no size while the card was hidden
    this.#picture(points, low, high);
  }

  #picture(places, low, high) {
    const [step, xs, ys] = floor(places);
    const wide = (xs[1] - xs[0] + ys[1] - ys[0]) * Math.cos(SLANT);
    const exaggeration = EXAGGERATIONS.find((k) => k * (high - low) >= LEAST_HEIGHT_SHARE * wide) ?? EXAGGERATIONS.at(-1);
    const corners = xs.flatMap((x) => ys.map((y) => [x, y, low]));
    const all = [...corners, [xs[0], ys[0], high], ...places].map((place) => project(place, exaggeration));
    const [left, right, top, bottom] = bounds(all);
    const { width, height } = this.surface;
    const scale = Math.min((width - 2 * (MARGIN + LABEL_WIDTH)) / (right - left), (height - 2 * MARGIN) / (bottom - top));
    const px = (place) => {
      const [u, v] = project(place, exaggeration);
      return [0.5 * width + (u - (left + right) / 2) * scale, 0.5 * height + (v - (top + bottom) / 2) * scale];
    };

    const context = this.surface.start();
    const rules = new Path2D();
    for (const x of marks(xs, step)) polyline([px([x, ys[0], low]), px([x, ys[1], low])], rules);
    for (const y of marks(ys, step)) polyline([px([xs[0], y, low]), px([xs[1], y, low])], rules);
    paint(context, rules, { line: "line" });
    paint(context, polyline(places.map(([x, y]) => px([x, y, low]))), { ...LINE, dash: [3, 4] });
    paint(context, polyline(places.map(px)), { line: "wearer", width: 2.5 });
    this.labels.start();
    for (const [[x, y, z], words, fill, radius] of [[places[0], "start", "muted", 4.5], [places.at(-1), "now", "wearer", 6]]) {
      const [a, b] = px([x, y, z]);
      paint(context, polyline([[a, b], px([x, y, low])]), LINE);
      paint(context, circle([a, b], radius), { fill });
      this.labels.keepAround([a, b], radius);
      const off = radius + 5;
      const spots = [[a + off, b - 4, "left"], [a - off, b - 4, "right"], [a, b - 15], [a, b + 15]];
      this.labels.add(words, spots, { weight: 3 + radius, colour: "ink", bold: words === "now" });
    }
    const axis = (z) => px([xs[0], ys[0], z]); // of heights, at the left corner of the floor
    paint(context, polyline([axis(low), axis(high)]), LINE);
    for (const { elevation, name } of roundHeights(low, high, 4)) {
      const [a, b] = axis(elevation);
      this.labels.add(name, [[a - 8, b, "right"]], { weight: 2 });
    }
    this.labels.finish();
    const larger = exaggeration > 1 ? ` Heights are drawn ${exaggeration} times as large.` : "";
    write("space-note", `A square of the floor is ${step} m wide.${larger}`);
    this.surface.setText(() => `The track in space, with heights from ${fixed(low, 1)} to ${fixed(high, 1)} m`);
    setData("space", { points: places.length, exaggeration });
  }
}

// Side of a square of the floor, and the ends of the floor along x and along y, m.
function floor(places) {
  const [x0, x1, y0, y1] = bounds(places);
  const step = round(Math.max(LEAST_EXTENT, x1 - x0, y1 - y0) / SQUARES);
  const ends = [[x0, x1], [y0, y1]].map(([a, b]) => {
    const first = Math.floor(a / step) * step;
    return [first, Math.max(Math.ceil(b / step) * step, first + step)];
  });
  return [step, ...ends];
}

const marks = ([from, to], step) => Array.from({ length: Math.round((to - from) / step) + 1 }, (_, k) => from + k * step);
