// Stairs and lifts on a plan: treads and a cabin in their outlines, and a badge that is recognised at any scale.

import { bounds, clamp, paint, polygon, polyline, within } from "./canvas.js";

const TREAD = 0.3; // m between two lines
const LEAST_TREAD = 4; // px
// Steps for stairs, and arrows up and down for a lift, in a square from -1 to 1.
const STEPS = [[-0.65, 0.55], [-0.65, 0.19], [-0.23, 0.19], [-0.23, -0.17], [0.19, -0.17], [0.19, -0.53], [0.61, -0.53]];
const ARROWS = [-1, 1].map((up) => [[-0.5, up * 0.14], [0, up * 0.7], [0.5, up * 0.14]]);

export const badgeSize = (scale) => Math.round(clamp(0.75 * scale, 12, 20));

// The outline with treads across its longer side, or with the diagonals of a cabin.
export function drawFlight(context, kind, points, scale) {
  const shape = polygon(points);
  const marks = new Path2D();
  if (kind === "stairs") treads(marks, points, Math.max(LEAST_TREAD, TREAD * scale));
  else if (points.length === 4) for (const k of [0, 1]) polyline([points[k], points[k + 2]], marks);
  within(context, shape, () => paint(context, marks, { line: "tread", cap: "butt" }));
  paint(context, shape, { line: "inner-wall", cap: "butt" });
}

function treads(path, points, step) {
  const sides = points.map(([x1, y1], i) => {
    const [x2, y2] = points[(i + 1) % points.length];
    return [x2 - x1, y2 - y1];
  });
  const [dx, dy] = sides.reduce((a, b) => (Math.hypot(...b) > Math.hypot(...a) ? b : a));
  const [cos, sin] = [dx, dy].map((d) => d / Math.hypot(dx, dy));
  const [from, to, least, most] = bounds(points.map(([x, y]) => [x * cos + y * sin, y * cos - x * sin]));
  for (let i = 1; i < (to - from) / step; i++) {
    const at = from + i * step;
    polyline([least, most].map((across) => [at * cos - across * sin, at * sin + across * cos]), path);
  }
}

export function drawBadge(context, kind, [x, y], size) {
  for (const [fill, half] of [["room", size / 2 + 1.5], ["muted", size / 2]]) {
    const path = new Path2D();
    path.roundRect(x - half, y - half, 2 * half, 2 * half, half / 2);
    paint(context, path, { fill });
  }
  const at = (points) => points.map(([right, down]) => [x + (right * size) / 2, y + (down * size) / 2]);
  if (kind === "stairs") paint(context, polyline(at(STEPS)), { line: "room", width: Math.max(1.5, size / 9), cap: "butt" });
  else for (const arrow of ARROWS) paint(context, polygon(at(arrow)), { fill: "room" });
}
