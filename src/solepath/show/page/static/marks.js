// Marks on the plane of the track: grid, ruler, feet, the wearer, and their uncertainty. Positions are in px.

import { round } from "./canvas.js";
import { theme } from "./theme.js";
import { fixed, percent } from "./words.js";

const CONFIDENCE_FACTOR = Math.sqrt(5.991); // 95 % quantile of chi squared with 2 degrees of freedom
const MAX_RADIUS = 4000; // px; a larger circle goes beyond every screen
const MIN_SHOWN_WEIGHT = 0.05; // share from which a candidate has its weight beside it

const LEAST_RULER = [56, 0.13]; // px, and share of the canvas: the lesser; the ruler is up to 2.5 times as long

// Half axis of the 95 % ellipse for a variance, m.
export const sure = (variance) => CONFIDENCE_FACTOR * Math.sqrt(Math.max(0, variance));

// Half axes of the ellipse that holds the position with 95 % probability, m, and the angle of the long one, rad.
export function axes([xx, xy, , yy]) {
  const middle = 0.5 * (xx + yy);
  const off = Math.hypot(0.5 * (xx - yy), xy);
  return { long: sure(middle + off), wide: sure(middle - off), angle: 0.5 * Math.atan2(2 * xy, xx - yy) };
}

// scale: px per m; the lines go through the start
export function drawGrid(context, { width, height }, [startX, startY], scale) {
  const step = round(48 / scale) * scale;
  const path = new Path2D();
  const first = (origin) => ((origin % step) + step) % step;
  const sharp = (at) => Math.round(at) + 0.5;
  for (let at = first(startX); at < width; at += step) segment(path, sharp(at), 0, sharp(at), height);
  for (let at = first(startY); at < height; at += step) segment(path, 0, sharp(at), width, sharp(at));
  context.lineWidth = 1;
  context.strokeStyle = theme.colours.grid;
  context.stroke(path);
}

function segment(path, x1, y1, x2, y2) {
  path.moveTo(x1, y1);
  path.lineTo(x2, y2);
}

export function drawStart(context, [x, y]) {
  circle(context, x, y, 6);
  context.fillStyle = theme.colours.inset;
  context.fill();
  context.lineWidth = 2;
  context.strokeStyle = theme.colours.muted;
  context.stroke();
}

// The words of the start, and nothing over its ring.
export function nameStart(labels, [x, y]) {
  labels.keep(x - 7, y - 7, 14, 14);
  labels.add("start", [[x, y + 18], [x, y - 18], [x - 12, y, "right"], [x + 12, y, "left"]], { weight: 8 });
}

export function drawRuler(context, labels, { width, height }, scale) {
  const metres = round(Math.min(LEAST_RULER[0], LEAST_RULER[1] * width) / scale);
  const [x, y, length] = [14, height - 14, metres * scale];
  const path = new Path2D();
  path.moveTo(x, y - 5);
  path.lineTo(x, y);
  path.lineTo(x + length, y);
  path.lineTo(x + length, y - 5);
  stroke(context, path, 4.5, theme.colours[labels.ground]);
  stroke(context, path, 1.5, theme.colours.ink);
  labels.keep(x - 4, y - 4, length + 8, 8);
  const words = metres < 1 ? `${fixed(100 * metres)} cm` : `${fixed(metres)} m`;
  labels.add(words, [[x + length / 2, y - 12]], { weight: 10, colour: "ink" });
}

// A foot beside the wearer's dot: the left one is round and the right one square, for people who do not see the colours.
export function drawFoot(context, foot, [x, y]) {
  context.beginPath();
  if (foot === "left") context.arc(x, y, 5, 0, 2 * Math.PI);
  else context.rect(x - 4.5, y - 4.5, 9, 9);
  context.fillStyle = theme.colours[foot];
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = theme.colours.inset;
  context.stroke();
}

export const WEARER_RADIUS = 9; // px
const TIP = 19; // px from the middle of the wearer's dot to the tip of its wedge

// The wearer: a dot with a wedge into the heading, rad, if that is known.
export function drawWearer(context, [x, y], heading) {
  const path = new Path2D();
  path.arc(x, y, WEARER_RADIUS, 0, 2 * Math.PI);
  path.closePath();
  if (heading !== null) {
    const at = (angle, far) => [x + far * Math.cos(angle), y - far * Math.sin(angle)];
    const off = Math.acos(WEARER_RADIUS / TIP); // where the wedge touches the dot
    path.moveTo(...at(heading + off, WEARER_RADIUS));
    path.lineTo(...at(heading, TIP));
    path.lineTo(...at(heading - off, WEARER_RADIUS));
    path.closePath();
  }
  stroke(context, path, 6, theme.colours.card);
  context.fillStyle = theme.colours.wearer;
  context.fill(path);
  circle(context, x, y, 3);
  context.fillStyle = theme.colours.card;
  context.fill();
}

// A position that a person reported: a diamond, or a cross where it contradicts the track.
export function drawReport(context, [x, y], used) {
  const path = new Path2D();
  const size = 5;
  if (used === false) {
    segment(path, x - size, y - size, x + size, y + size);
    segment(path, x - size, y + size, x + size, y - size);
  } else {
    path.moveTo(x, y - size);
    for (const [dx, dy] of [[size, 0], [0, size], [-size, 0]]) path.lineTo(x + dx, y + dy);
    path.closePath();
    context.fillStyle = theme.colours.inset;
    context.fill(path);
  }
  stroke(context, path, 2, theme.colours.candidate);
}

// The place that is reported without a pointer: the middle of the drawing.
export function drawCross(context, [x, y]) {
  const path = new Path2D();
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) segment(path, x + 5 * dx, y + 5 * dy, x + 16 * dx, y + 16 * dy);
  stroke(context, path, 2, theme.colours.ink);
}

// dashed: it may be too small. Returns whether there was anything to see.
export function drawEllipse(context, [x, y], { long, wide, angle }, scale, dashed) {
  if (long * scale < TIP) return false; // all of it is below the mark
  context.beginPath();
  context.ellipse(x, y, Math.min(MAX_RADIUS, long * scale), Math.min(MAX_RADIUS, wide * scale), -angle, 0, 2 * Math.PI);
  veil(context, dashed);
  return true;
}

export function drawSpread(context, [x, y], radius, dashed) {
  if (radius < TIP) return false;
  circle(context, x, y, Math.min(MAX_RADIUS, Math.max(0, radius)));
  veil(context, dashed);
  return true;
}

// A candidate's mark is larger the likelier it is; on other levels it is faint. The likeliest, which comes first, has a
// ring, and those that matter have their weights.
export function drawCandidates(context, labels, candidates, level, px) {
  context.fillStyle = theme.colours.candidate;
  for (const { level: of, x, y, weight } of candidates) {
    context.globalAlpha = of === level ? 0.8 : 0.2;
    circle(context, ...px([x, y]), radiusOf(weight));
    context.fill();
  }
  context.globalAlpha = 1;
  const here = candidates.filter((one) => one.level === level);
  if (here.length > 0 && here[0] === candidates[0]) {
    circle(context, ...px([here[0].x, here[0].y]), radiusOf(here[0].weight) + 3.5);
    context.lineWidth = 2;
    context.strokeStyle = theme.colours.ink;
    context.stroke();
  }
  for (const { x, y, weight } of here) {
    if (weight < MIN_SHOWN_WEIGHT) continue;
    const [a, b] = px([x, y]);
    const off = radiusOf(weight) + 6;
    labels.keep(a - off / 2, b - off / 2, off, off);
    const spots = [[a + off, b, "left"], [a - off, b, "right"], [a, b - off - 6], [a, b + off + 6]];
    labels.add(percent(weight), spots, { weight: 7 + weight, colour: "ink", bold: true });
  }
}

const radiusOf = (weight) => 3 + 9 * Math.sqrt(Math.min(1, Math.max(0, weight)));

export function stroke(context, path, width, colour) {
  context.lineWidth = width;
  context.lineCap = context.lineJoin = "round";
  context.strokeStyle = colour;
  context.stroke(path);
}

function circle(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

function veil(context, dashed) {
  context.fillStyle = context.strokeStyle = theme.colours.wearer;
  context.globalAlpha = dashed ? 0.06 : 0.13;
  context.fill();
  context.globalAlpha = dashed ? 1 : 0.75;
  context.lineWidth = dashed ? 1.5 : 1;
  context.setLineDash(dashed ? [5, 5] : []);
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}
