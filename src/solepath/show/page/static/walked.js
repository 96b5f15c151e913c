// The way walked: its extent and its lines.

import { sure, stroke } from "./marks.js";
import { MAX_JUMP } from "./following.js";
import { FEET } from "./state.js";
import { theme } from "./theme.js";

const MIN_EXTENT = 3; // m, least width and height that are shown
const FAINT_WIDTH = 1.75; // px, of what was walked elsewhere or was drawn before

// [least x, least y, greatest x, greatest y] of the track alone, m.
export function boxOf({ tracks, feet, wearer }, feetShown) {
  const box = [0, 0, 0, 0];
  const hold = (x, y) => {
    if (x < box[0]) box[0] = x;
    if (y < box[1]) box[1] = y;
    if (x > box[2]) box[2] = x;
    if (y > box[3]) box[3] = y;
  };
  for (const name of feetShown ? [...FEET, "wearer"] : ["wearer"]) {
    for (const point of tracks[name]) hold(point[1], point[2]);
    if (feet[name]?.position) hold(feet[name].position[0], feet[name].position[1]);
  }
  if (wearer?.covariance) {
    // as much of the uncertainty as leaves the track large enough to see
    const most = 0.25 * Math.max(MIN_EXTENT, box[2] - box[0], box[3] - box[1]);
    const [x, y] = wearer.position;
    const [dx, dy] = [0, 3].map((k) => Math.min(most, sure(wearer.covariance[k])));
    hold(x - dx, y - dy);
    hold(x + dx, y + dy);
  }
  for (const k of [0, 1]) {
    const lacks = Math.max(0, MIN_EXTENT - (box[k + 2] - box[k])) / 2;
    box[k] -= lacks;
    box[k + 2] += lacks;
  }
  return box;
}

export const DASH = [5, 9]; // px, of a track that is wrong; its ends are round

// A line through [t, x, y, ...]. Consecutive points on the same pixel are drawn as one.
export function drawLine(context, points, px, width, colour, dash = []) {
  const path = new Path2D();
  let [lastX, lastY] = [Infinity, Infinity];
  points.forEach(([, mx, my], i) => {
    const [x, y] = px([mx, my]);
    if (i < points.length - 1 && Math.abs(x - lastX) < 0.8 && Math.abs(y - lastY) < 0.8) return;
    if (lastX === Infinity) path.moveTo(x, y);
    else path.lineTo(x, y);
    [lastX, lastY] = [x, y];
  });
  context.setLineDash(dash);
  stroke(context, path, width, colour);
  context.setLineDash([]);
}

// Labels are rather not on the places [t, level, x, y, ...] of this level.
export function avoidPlaces(labels, places, level, px) {
  const [reach, side] = [6, 12]; // px
  let last = null;
  for (const [, of, mx, my] of places) {
    const [x, y] = px([mx, my]);
    const seen = of === level && x > -side && y > -side && x < labels.width + side && y < labels.height + side;
    const far = last ? Math.hypot(x - last[0], y - last[1]) : Infinity;
    if (far < reach) continue;
    const between = seen && far < 10 * side ? Math.floor(far / side) : 0; // so that no gap is left to the last one
    for (let i = 0; i < between; i++) {
      const share = i / between;
      labels.avoid(last[0] + share * (x - last[0]) - reach, last[1] + share * (y - last[1]) - reach, side, side);
    }
    if (seen) labels.avoid(x - reach, y - reach, side, side);
    last = [x, y];
  }
}

// Places [t, level, x, y, ...] from the index `from` on. Only a line between two places on this level is solid; on others it
// is dotted. Before the index `since` the track of a rejected candidate is dashed.
export function drawPlaces(context, places, from, since, level, px, width, dash = []) {
  const paths = { here: new Path2D(), elsewhere: new Path2D(), before: new Path2D() };
  for (let i = Math.max(1, from); i < places.length; i++) {
    const [[, a, x1, y1], [, b, x2, y2]] = [places[i - 1], places[i]];
    const here = a === level && b === level;
    if (Math.hypot(x2 - x1, y2 - y1) > MAX_JUMP || i === since || (i < since && !here)) continue;
    const path = paths[i < since ? "before" : here ? "here" : "elsewhere"];
    path.moveTo(...px([x1, y1]));
    path.lineTo(...px([x2, y2]));
  }
  context.setLineDash([4, 6]);
  stroke(context, paths.before, FAINT_WIDTH, theme.colours.muted);
  context.setLineDash([0.1, 5]);
  stroke(context, paths.elsewhere, 1.5 * FAINT_WIDTH, theme.colours.wearer);
  context.setLineDash(dash);
  stroke(context, paths.here, width, theme.colours.wearer);
  context.setLineDash([]);
}
