// The wearer's height over time, with the levels of the plan if there is one.

import { Surface, circle, paint, polyline, range, round } from "./canvas.js";
import { Labels } from "./labels.js";
import { clock, fixed, signed, write } from "./words.js";

const MIN_RANGE = 1; // m, least range of heights that is shown
const LABEL_WIDTH = 44; // px, for heights as numbers; names of levels are on their lines
const TIME_SPACE = 20; // px, for the times below
const TIME_STEPS = [5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200]; // s between two times
const TIME_WIDTH = 64; // px, least distance of two times
const REACH = 4; // px around the line in which the name of a level is rather not
const NEAR = 5; // m by which a level may be above or below the track and still be shown

export class Height {
  uses = ["tracks", "places", "place", "scene", "theme"];
  interval = 250; // ms between two pictures

  constructor(redraw) {
    this.surface = new Surface("height", redraw);
    this.labels = new Labels(this.surface, "card");
  }

  draw(state) {
    const context = this.surface.start();
    const { width, height } = this.surface;
    const { points, levels } = series(state);
    const last = points.at(-1);
    const onPlan = levels.length > 0;
    write("height-now", last ? `${onPlan ? fixed(last[1], 1) : signed(last[1], 1)} m` : "");
    const against = onPlan ? "in the heights of the plan" : "against the start";
    this.surface.setText(() => (last ? `Height over time: now ${fixed(last[1], 1)} m ${against}` : "Height: no stride yet"));
    let [low, high] = last ? range(points.map(([, z]) => z)) : [0, 0];
    [low, high] = range([low, high, ...levels.map(({ elevation: z }) => z).filter((z) => z > low - NEAR && z < high + NEAR)]);
    const lacks = Math.max(0, MIN_RANGE - (high - low)) / 2;
    [low, high] = [low - lacks, high + lacks];
    const [top, bottom] = [onPlan ? 22 : 10, height - TIME_SPACE - 6];
    const y = (z) => bottom - ((z - low) / (high - low)) * (bottom - top);
    const [from, to] = last ? [points[0][0], Math.max(last[0], points[0][0] + 10)] : [0, 10];
    const side = onPlan ? 0 : LABEL_WIDTH;
    const x = (t) => side + ((t - from) / (to - from)) * (width - side - 8);
    const line = points.map(([t, z]) => [x(t), y(z)]);

    this.labels.start();
    for (const [a, b] of line) this.labels.avoid(a - REACH, b - REACH, 2 * REACH, 2 * REACH);
    for (const { elevation: z, name } of onPlan ? levels : roundHeights(low, high, 2.5)) {
      if (y(z) < 2 || y(z) > height - TIME_SPACE) continue;
      const at = Math.round(y(z)) + 0.5;
      paint(context, polyline([[side, at], [width, at]]), { line: "strong-line", dash: [2, 4], cap: "butt" });
      // the level at which the wearer is has its name first
      const weight = 5 - Math.min(4, last ? Math.abs(z - last[1]) : 0);
      const above = [[2, y(z) - 11, "left"], [width - 12, y(z) - 11, "right"]];
      this.labels.add(name, onPlan ? above : [[side - 8, y(z), "right"]], { weight });
    }
    const step = TIME_STEPS.find((s) => ((to - from) / s) * TIME_WIDTH < width - side) ?? round((to - from) / 4);
    for (let t = Math.ceil((from - state.start) / step) * step; t <= to - state.start; t += step) {
      const at = x(state.start + t);
      if (at > side) this.labels.add(clock(t), [[at, height - 8]], { weight: 6 });
    }
    paint(context, polyline(line), { line: "wearer", width: 2.5 });
    if (last) paint(context, circle(line.at(-1), 5), { fill: "wearer" });
    this.labels.finish();
  }
}

// Round heights between two, about `count` apart, and what they are called, as levels have them.
export function roundHeights(low, high, count) {
  const step = round((high - low) / count);
  const first = Math.ceil(low / step);
  const heights = Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step);
  return heights.map((elevation) => ({ elevation, name: `${fixed(elevation, step < 1 ? 1 : 0)} m` }));
}

// [t, z] of the known points, and the levels if the points are in the plan frame.
function series({ plan, place, places, track, t }) {
  const heights = track.map(([t, , , z]) => [t, z]);
  if (plan === null || places.length < 2) return { points: heights, levels: [] };
  const before = onPlanHeights(track, places).filter(([t]) => t < places[0][0]); // the ride or the stairs that gave the place
  const points = [...before, ...places].map((point) => [point[0], point.at(-1)]);
  const now = place?.decided ? place.position[2] : NaN; // `places` are decided, this one may not be
  if (Number.isFinite(now) && t > points.at(-1)[0]) points.push([t, now]);
  return { points, levels: plan.levels.filter(({ elevation }) => elevation !== null) };
}

// Points [t, x, y, z] with the heights that the places [t, level, x, y, z] give, so that all drawings have one zero; before
// the first place and between two of them the height changes as along the track.
export function onPlanHeights(points, places) {
  let [k, seen] = [0, 0];
  let offset = null;
  return points.map(([t, x, y, z]) => {
    while (k < places.length && (offset === null || places[k][0] <= t)) {
      while (seen + 1 < points.length && points[seen + 1][0] <= places[k][0]) seen += 1;
      offset = places[k][4] - points[seen][3];
      k += 1;
    }
    return [t, x, y, z + offset];
  });
}
