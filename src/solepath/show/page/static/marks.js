// Marks on the plane of the track: grid, ruler, feet, the wearer, and their uncertainty. Positions are in px.

import { circle, paint, polygon, polyline, rectangle, round } from "./canvas.js";
import { fixed, percent } from "./words.js";

const CONFIDENCE_FACTOR = Math.sqrt(5.991); // 95 % quantile of chi squared with 2 degrees of freedom
const MAX_RADIUS = 4000; // px; a larger circle goes beyond every screen
const MIN_SHOWN_WEIGHT = 0.05; // share from which a candidate has its weight beside it
const LEAST_RULER = [56, 0.13]; // px, and share of the canvas: the lesser; the ruler is up to 2.5 times as long
export const WEARER_RADIUS = 9; // px
const TIP = 19; // px from the middle of the wearer's dot to the tip of its wedge

// Half axis of the 95 % ellipse for a variance, m.
export const sure = (variance) => CONFIDENCE_FACTOR * Math.sqrt(Math.max(0, variance));

// Half axes of the ellipse that holds the position with 95 % probability, m, and the angle of the long one, rad.
export function axes([xx, xy, , yy]) {
  const middle = 0.5 * (xx + yy);
  const off = Math.hypot(0.5 * (xx - yy), xy);
  return { long: sure(middle + off), wide: sure(middle - off), angle: 0.5 * Math.atan2(2 * xy, xx - yy) };
}

// scale: px per m; the lines go through the start
export function drawGrid(context, [width, height], [startX, startY], scale) {
  const step = round(48 / scale) * scale;
  const path = new Path2D();
  const first = (origin) => ((origin % step) + step) % step;
  const sharp = (at) => Math.round(at) + 0.5;
  for (let at = first(startX); at < width; at += step) polyline([[sharp(at), 0], [sharp(at), height]], path);
  for (let at = first(startY); at < height; at += step) polyline([[0, sharp(at)], [width, sharp(at)]], path);
  paint(context, path, { line: "grid" });
}

export const drawStart = (context, at) => paint(context, circle(at, 6), { fill: "inset", line: "muted", width: 2 });

// The words of the start, and nothing over its ring.
export function nameStart(labels, [x, y]) {
  labels.keepAround([x, y], 7);
  labels.add("start", [[x, y + 18], [x, y - 18], [x - 12, y, "right"], [x + 12, y, "left"]], { weight: 8 });
}

export function drawRuler(context, labels, { width, height }, scale) {
  const metres = round(Math.min(LEAST_RULER[0], LEAST_RULER[1] * width) / scale);
  const [x, y, length] = [14, height - 14, metres * scale];
  const path = polyline([[x, y - 5], [x, y], [x + length, y], [x + length, y - 5]]);
  paint(context, path, { line: labels.ground, width: 4.5 });
  paint(context, path, { line: "ink", width: 1.5 });
  labels.keep(x - 4, y - 4, length + 8, 8);
  const words = metres < 1 ? `${fixed(100 * metres)} cm` : `${fixed(metres)} m`;
  labels.add(words, [[x + length / 2, y - 12]], { weight: 10, colour: "ink" });
}

// A foot beside the wearer's dot: the left one is round and the right one square, for people who do not see the colours.
export function drawFoot(context, foot, [x, y]) {
  const path = foot === "left" ? circle([x, y], 5) : rectangle(x - 4.5, y - 4.5, 9, 9);
  paint(context, path, { fill: foot, line: "inset", width: 1.5, cap: "butt" });
}

// The wearer: a dot with a wedge into the heading, rad, if that is known.
export function drawWearer(context, [x, y], heading) {
  const path = circle([x, y], WEARER_RADIUS);
  if (heading !== null) {
    const at = (angle, far) => [x + far * Math.cos(angle), y - far * Math.sin(angle)];
    const off = Math.acos(WEARER_RADIUS / TIP); // where the wedge touches the dot
    polygon([at(heading + off, WEARER_RADIUS), at(heading, TIP), at(heading - off, WEARER_RADIUS)], path);
  }
  paint(context, path, { line: "card", width: 6 });
  paint(context, path, { fill: "wearer" });
  paint(context, circle([x, y], 3), { fill: "card" });
}

// A position that a person reported: a diamond, or a cross where it contradicts the track.
export function drawReport(context, [x, y], used) {
  const size = 5;
  const at = (points) => points.map(([right, down]) => [x + size * right, y + size * down]);
  if (used === false) {
    const path = polyline(at([[1, 1], [-1, -1]]), polyline(at([[1, -1], [-1, 1]])));
    paint(context, path, { line: "candidate", width: 2 });
  } else {
    paint(context, polygon(at([[0, -1], [1, 0], [0, 1], [-1, 0]])), { fill: "inset", line: "candidate", width: 2 });
  }
}

// The place that is reported without a pointer: the middle of the drawing.
export function drawCross(context, [x, y]) {
  const path = new Path2D();
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) polyline([5, 16].map((far) => [x + far * dx, y + far * dy]), path);
  paint(context, path, { line: "ink", width: 2 });
}

// The area of the wearer; half axes in px; dashed: it may be too small. Returns whether there was anything to see.
export function drawArea(context, [x, y], { long, wide, angle }, dashed) {
  if (long < TIP) return false; // all of it is below the mark
  const path = new Path2D();
  path.ellipse(x, y, Math.min(MAX_RADIUS, long), Math.min(MAX_RADIUS, wide), -angle, 0, 2 * Math.PI);
  paint(context, path, { fill: "wearer", alpha: dashed ? 0.06 : 0.13 });
  paint(context, path, dashed ? { line: "wearer", width: 1.5, dash: [5, 5], cap: "butt" } : { line: "wearer", alpha: 0.75 });
  return true;
}

// A candidate's mark is larger the likelier it is; on other levels it is faint. The likeliest, which comes first, has a
// ring, and those that matter have their weights.
export function drawCandidates(context, labels, candidates, level, px) {
  const radiusOf = (weight) => 3 + 9 * Math.sqrt(weight);
  for (const { level: of, x, y, weight } of candidates) {
    const [a, b] = px([x, y]);
    paint(context, circle([a, b], radiusOf(weight)), { fill: "candidate", alpha: of === level ? 0.8 : 0.2 });
    if (of !== level || weight < MIN_SHOWN_WEIGHT) continue;
    const off = radiusOf(weight) + 6;
    labels.keepAround([a, b], off / 2);
    const spots = [[a + off, b, "left"], [a - off, b, "right"], [a, b - off - 6], [a, b + off + 6]];
    labels.add(percent(weight), spots, { weight: 7 + weight, colour: "ink", bold: true });
  }
  const [best] = candidates;
  if (best?.level === level) paint(context, circle(px([best.x, best.y]), radiusOf(best.weight) + 3.5), { line: "ink", width: 2 });
}
