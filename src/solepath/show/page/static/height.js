// The wearer's height over time, with the levels of the plan if there is one.

import { Alternative, Surface, round } from "./canvas.js";
import { Labels } from "./labels.js";
import { onPlanHeights } from "./heights.js";
import { theme } from "./theme.js";
import { clock, fixed, signed, write } from "./words.js";

const MIN_RANGE = 1; // m, least range of heights that is shown
const LABEL_WIDTH = 44; // px, for heights as numbers; names of levels are on their lines
const TIME_SPACE = 20; // px, for the times below
const NEAR = 5; // m by which a level may be above or below the track and still be shown
const REDRAW_INTERVAL = 250; // ms between two pictures

export class Height {
  uses = ["tracks", "places", "place", "scene", "theme"];

  constructor(redraw) {
    const canvas = document.getElementById("height");
    this.surface = new Surface(canvas, redraw);
    this.alternative = new Alternative(canvas);
    this.labels = new Labels(canvas, "card");
    this.now = document.getElementById("height-now");
    this.drawn = 0;
  }

  draw(state, now, changed) {
    if (now - this.drawn < REDRAW_INTERVAL && !changed.has("theme") && !changed.has("scene")) return "later";
    this.drawn = now;
    const context = this.surface.start();
    const { width, height } = this.surface;
    const { points, lines } = series(state);
    const last = points.at(-1);
    write(this.now, last ? `${lines.length > 0 ? fixed(last[1], 1) : signed(last[1], 1)} m` : "");
    const against = lines.length > 0 ? "in the heights of the plan" : "against the start";
    this.alternative.setText(() =>
      last ? `Height over time: now ${fixed(last[1], 1)} m ${against}` : "Height: no stride yet",
    );
    let [low, high] = points.reduce(([a, b], [, z]) => [Math.min(a, z), Math.max(b, z)], [Infinity, -Infinity]);
    if (!last) [low, high] = [0, 0];
    for (const { z } of lines) if (z > low - NEAR && z < high + NEAR) [low, high] = [Math.min(low, z), Math.max(high, z)];
    const lacks = Math.max(0, MIN_RANGE - (high - low)) / 2;
    [low, high] = [low - lacks, high + lacks];
    const [top, bottom] = [lines.length > 0 ? 22 : 10, height - TIME_SPACE - 6];
    const y = (z) => bottom - ((z - low) / (high - low)) * (bottom - top);
    const [from, to] = last ? [points[0][0], Math.max(last[0], points[0][0] + 10)] : [0, 10];
    const side = lines.length > 0 ? 0 : LABEL_WIDTH;
    const x = (t) => side + ((t - from) / (to - from)) * (width - side - 8);

    this.labels.start(this.surface);
    const step = round((high - low) / 2.5);
    const marks =
      lines.length > 0
        ? lines
        : Array.from({ length: 5 }, (_, i) => (Math.ceil(low / step) + i) * step)
            .filter((z) => z <= high)
            .map((z) => ({ z, name: `${fixed(z, step < 1 ? 1 : 0)} m` }));
    for (const { z, name } of marks) {
      if (y(z) < 2 || y(z) > height - TIME_SPACE) continue;
      context.strokeStyle = theme.colours["strong-line"];
      context.lineWidth = 1;
      context.setLineDash([2, 4]);
      context.beginPath();
      context.moveTo(side, Math.round(y(z)) + 0.5);
      context.lineTo(width, Math.round(y(z)) + 0.5);
      context.stroke();
      context.setLineDash([]);
      // the level at which the wearer is has its name first
      const weight = 5 - Math.min(4, last ? Math.abs(z - last[1]) : 0);
      const spots = lines.length > 0 ? levelSpots(points, x, y, z, width) : [[side - 8, y(z), "right"]];
      this.labels.add(name, spots, { weight });
    }
    this.#times(from, to, x, side, state.start);
    if (!last) return this.labels.finish(context) ?? "done";
    context.beginPath();
    let shown = -Infinity;
    points.forEach(([t, z], i) => {
      if (x(t) - shown < 0.5 && i < points.length - 1) return;
      shown = x(t);
      context.lineTo(shown, y(z));
    });
    context.lineWidth = 2.5;
    context.lineJoin = "round";
    context.strokeStyle = theme.colours.wearer;
    context.stroke();
    context.beginPath();
    context.arc(x(last[0]), y(last[1]), 5, 0, 2 * Math.PI);
    context.fillStyle = theme.colours.wearer;
    context.fill();
    this.labels.finish(context);
    return "done";
  }

  #times(from, to, x, side, start) {
    const { width, height } = this.surface;
    const step =
      [5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200].find((s) => ((to - from) / s) * 64 < width - side) ??
      round((to - from) / 4);
    for (let t = Math.ceil((from - start) / step) * step; t <= to - start; t += step) {
      if (x(start + t) > side) this.labels.add(clock(t), [[x(start + t), height - 8]], { weight: 6 });
    }
  }
}

// Above the line of a level, at that end at which the track does not run there, or else below it.
function levelSpots(points, x, y, z, width) {
  const between = (a, b, from, to) => Math.max(a, b) >= from && Math.min(a, b) <= to;
  const near = (from, to) =>
    points.some(([t, at], i) => {
      const [before, under] = points[Math.max(0, i - 1)];
      return between(x(before), x(t), from, to) && between(y(under), y(at), y(z) - 19, y(z) - 3);
    });
  const ends = [[2, "left", 0, 110], [width - 12, "right", width - 110, width]];
  const free = ends.filter(([, , from, to]) => !near(from, to));
  return [...free, ...ends].map(([at, align]) => [at, y(z) - 11, align]);
}

// [t, z] of the known points, and the elevations of the levels if the points are in the plan frame.
function series({ plan, place, places, tracks, t }) {
  if (plan && places.length > 1) {
    const lines = plan.levels
      .filter((level) => level.elevation !== null)
      .map(({ elevation, name }) => ({ z: elevation, name }));
    const before = onPlanHeights(tracks.wearer, places).filter(([t]) => t < places[0][0]); // the ride or the stairs that gave the place
    const points = [...before.map(([t, , , z]) => [t, z]), ...places.map(([t, , , , z]) => [t, z])];
    const now = place?.position[2]; // places are those whose level is decided
    if (Number.isFinite(now) && t > points.at(-1)[0]) points.push([t, now]);
    return { points, lines };
  }
  const track = [tracks.wearer, tracks.left, tracks.right].find((points) => points.length > 1) ?? [];
  return { points: track.map(([t, , , z]) => [t, z]), lines: [] };
}
