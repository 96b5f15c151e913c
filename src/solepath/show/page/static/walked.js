// The way walked: its extent, its lines, and the part of it that belongs to the present candidate.

import { bounds, paint } from "./canvas.js";
import { MAX_JUMP } from "./following.js";
import { sure } from "./marks.js";

const MIN_EXTENT = 3; // m, least width and height that are shown
const MAX_AREA_SHARE = 0.25; // of the extent of the track, for each side of the wearer's uncertainty
const FAINT_WIDTH = 1.75; // px, of what was walked elsewhere or was drawn before
const [REACH, SIDE, MAX_STEPS] = [6, 12, 10]; // px, of squares along the way in which labels are rather not; their number
const MIN_DIFFERENCE = 5; // m by which the place moves more than the wearer when another candidate becomes the likeliest
const DRIFT_SHARE = 0.2; // error of the track as a share of the distance between two places
const DASH = [5, 9]; // px, of a track that is wrong; its ends are round

export const LINES = {
  left: { line: "left", width: 1.5 },
  right: { line: "right", width: 1.5 },
  wearer: { line: "wearer", width: 4 },
};
export const dashed = (line) => ({ ...line, dash: DASH });

// [least x, greatest x, least y, greatest y] of these tracks, m, with the uncertainty of the wearer.
export function boxOf({ tracks, feet, wearer }, names) {
  const points = names.flatMap((name) => [...tracks[name].map((point) => point.slice(1)), feet[name]?.position ?? [0, 0]]);
  const box = bounds([[0, 0], ...points]);
  if (wearer?.covariance) {
    // as much of the uncertainty as leaves the track large enough to see
    const most = MAX_AREA_SHARE * Math.max(MIN_EXTENT, box[1] - box[0], box[3] - box[2]);
    const [x, y] = wearer.position;
    const [dx, dy] = [0, 3].map((k) => Math.min(most, sure(wearer.covariance[k])));
    points.push([x - dx, y - dy], [x + dx, y + dy]);
  }
  const [x0, x1, y0, y1] = bounds([[0, 0], ...points]);
  const lacks = (from, to) => Math.max(0, MIN_EXTENT - (to - from)) / 2;
  return [x0 - lacks(x0, x1), x1 + lacks(x0, x1), y0 - lacks(y0, y1), y1 + lacks(y0, y1)];
}

// A line through [t, x, y, ...]. Consecutive points on the same pixel are drawn as one.
export function drawLine(context, points, px, style) {
  const path = new Path2D();
  let last = [Infinity, Infinity];
  points.forEach(([, ...at], i) => {
    const [x, y] = px(at);
    if (i > 0 && i < points.length - 1 && Math.abs(x - last[0]) < 0.8 && Math.abs(y - last[1]) < 0.8) return;
    path.lineTo(x, y);
    last = [x, y];
  });
  paint(context, path, style);
}

// Labels are rather not on the places [t, level, x, y, ...] of this level, nor between two that are close.
export function avoidPlaces(labels, places, level, px) {
  let last = null;
  for (const [, of, ...at] of places) {
    const [x, y] = px(at);
    const [x0, y0] = last ?? [x, y];
    const far = Math.hypot(x - x0, y - y0);
    if (last !== null && far < REACH) continue;
    const steps = far < MAX_STEPS * SIDE ? Math.max(1, Math.ceil(far / SIDE)) : 1;
    for (let k = 1; k <= steps && of === level; k++) {
      labels.avoid(x0 + (k / steps) * (x - x0) - REACH, y0 + (k / steps) * (y - y0) - REACH, SIDE, SIDE);
    }
    last = [x, y];
  }
}

// Places [t, level, x, y, ...] from the index `from` on. Only a line between two places on this level is solid; on others it
// is dotted. Before the index `since` the track of a rejected candidate is dashed.
export function drawPlaces(context, places, from, since, level, px, style) {
  const paths = { here: new Path2D(), elsewhere: new Path2D(), before: new Path2D() };
  for (let i = Math.max(1, from); i < places.length; i++) {
    const [[, a, x1, y1], [, b, x2, y2]] = [places[i - 1], places[i]];
    const here = a === level && b === level;
    if (Math.hypot(x2 - x1, y2 - y1) > MAX_JUMP || i === since || (i < since && !here)) continue;
    const path = paths[i < since ? "before" : here ? "here" : "elsewhere"];
    path.moveTo(...px([x1, y1]));
    path.lineTo(...px([x2, y2]));
  }
  paint(context, paths.before, { line: "muted", width: FAINT_WIDTH, dash: [4, 6] });
  paint(context, paths.elsewhere, { line: "wearer", width: 1.5 * FAINT_WIDTH, dash: [0.1, 5] });
  paint(context, paths.here, style);
}

// Finds where the track on the plan changes from a candidate that was rejected to the present one.
export class Possibility {
  #key = "";
  #seen = 0;
  #since = 0;

  // Returns the index of the first place of the track that belongs to the present place.
  since({ places, tracks, generation, thinned }) {
    const key = `${generation} ${thinned}`;
    if (key !== this.#key) [this.#key, this.#seen, this.#since] = [key, 1, 0];
    for (; this.#seen < places.length; this.#seen++) {
      if (jumped(places[this.#seen - 1], places[this.#seen], tracks.wearer)) this.#since = this.#seen;
    }
    return this.#since;
  }
}

// The track turns and drifts against the plan, but its length is right.
function jumped([t1, , x1, y1], [t2, , x2, y2], track) {
  const [a, b] = [t1, t2].map((t) => track.findLast((point) => point[0] <= t) ?? track[0] ?? [0, 0, 0]);
  const walked = Math.hypot(b[1] - a[1], b[2] - a[2]);
  return Math.abs(Math.hypot(x2 - x1, y2 - y1) - walked) > MIN_DIFFERENCE + DRIFT_SHARE * walked;
}
