// Stairs and lifts on a plan: treads and a cabin in their outlines, and a badge that is recognised at any scale.

import { theme } from "./theme.js";

const TREAD = 0.3; // m between two lines
const LEAST_TREAD = 4; // px
const MAX_TREADS = 200;

export const badgeSize = (scale) => Math.round(Math.min(20, Math.max(12, 0.75 * scale)));

// The outline with treads across its longer side, or with the diagonals of a cabin.
export function drawFlight(context, kind, outline, px, scale) {
  const points = outline.map(px);
  const shape = new Path2D();
  for (const point of points) shape.lineTo(...point);
  shape.closePath();
  const marks = new Path2D();
  if (kind === "stairs") treads(marks, points, Math.max(LEAST_TREAD, TREAD * scale));
  else {
    for (const k of points.length === 4 ? [0, 1] : []) {
      marks.moveTo(...points[k]);
      marks.lineTo(...points[k + 2]);
    }
  }
  context.save();
  context.clip(shape);
  context.lineWidth = 1;
  context.strokeStyle = theme.colours["tread"];
  context.stroke(marks);
  context.restore();
  context.lineWidth = 1;
  context.strokeStyle = theme.colours["inner-wall"];
  context.stroke(shape);
}

function treads(path, points, step) {
  let [long, along] = [0, [1, 0]];
  points.forEach(([x1, y1], i) => {
    const [x2, y2] = points[(i + 1) % points.length];
    const length = Math.hypot(x2 - x1, y2 - y1);
    if (length > long) [long, along] = [length, [(x2 - x1) / length, (y2 - y1) / length]];
  });
  const across = [-along[1], along[0]];
  const spans = [along, across].map((axis) => {
    const values = points.map(([x, y]) => x * axis[0] + y * axis[1]);
    return [Math.min(...values), Math.max(...values)];
  });
  for (let i = 1; i < Math.min(MAX_TREADS, (spans[0][1] - spans[0][0]) / step); i++) {
    const at = spans[0][0] + i * step;
    for (const [k, end] of spans[1].entries()) {
      const point = [at * along[0] + end * across[0], at * along[1] + end * across[1]];
      if (k === 0) path.moveTo(...point);
      else path.lineTo(...point);
    }
  }
}

export function drawBadge(context, [x, y], size) {
  context.beginPath();
  context.roundRect(x - size / 2 - 1.5, y - size / 2 - 1.5, size + 3, size + 3, size / 4 + 1);
  context.fillStyle = theme.colours.room;
  context.fill();
  context.beginPath();
  context.roundRect(x - size / 2, y - size / 2, size, size, size / 4);
  context.fillStyle = theme.colours.muted;
  context.fill();
}

// Steps for stairs, and arrows up and down for a lift.
export function drawSymbol(context, kind, [x, y], size) {
  const unit = size / 2;
  context.fillStyle = context.strokeStyle = theme.colours.room;
  context.beginPath();
  if (kind === "stairs") {
    context.lineWidth = Math.max(1.5, size / 9);
    context.lineCap = "butt";
    context.lineJoin = "miter";
    context.moveTo(x - 0.65 * unit, y + 0.55 * unit);
    for (let k = 0; k < 3; k++) {
      context.lineTo(x + (-0.65 + 0.42 * k) * unit, y + (0.55 - 0.36 * (k + 1)) * unit);
      context.lineTo(x + (-0.65 + 0.42 * (k + 1)) * unit, y + (0.55 - 0.36 * (k + 1)) * unit);
    }
    context.stroke();
    return;
  }
  for (const up of [-1, 1]) {
    context.moveTo(x - 0.5 * unit, y + up * 0.14 * unit);
    context.lineTo(x, y + up * 0.7 * unit);
    context.lineTo(x + 0.5 * unit, y + up * 0.14 * unit);
    context.closePath();
  }
  context.fill();
}
