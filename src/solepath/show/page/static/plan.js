// One level of a floor plan.

import { FONT } from "./canvas.js";
import { theme } from "./theme.js";

// [least x, least y, greatest x, greatest y] of all levels, m; null for an empty plan.
export function extent(plan) {
  const points = plan.levels
    .flatMap((level) => [
      ...level.walls.flatMap(([x1, y1, x2, y2]) => [
        [x1, y1],
        [x2, y2],
      ]),
      ...level.rooms.flat(),
    ])
    .concat(plan.connectors.flatMap((one) => one.stops.flatMap((stop) => stop.outline)));
  if (points.length === 0) return null;
  return points.reduce(
    ([a, b, c, d], [x, y]) => [Math.min(a, x), Math.min(b, y), Math.max(c, x), Math.max(d, y)],
    [Infinity, Infinity, -Infinity, -Infinity],
  );
}

// px: ([x, y]) => [px, px]; scale: px per m
export function drawLevel(context, plan, level, px, scale) {
  const { colours } = theme;
  const rooms = new Path2D();
  for (const room of level.rooms) ring(rooms, room.map(px));
  context.fillStyle = colours.room;
  context.fill(rooms);
  for (const connector of plan.connectors) {
    for (const stop of connector.stops) if (stop.level === level.id) drawStop(context, connector.kind, stop, px, scale);
  }
  lines(context, level.doors, px, colours["sole-line"], 1, [2, 3]);
  lines(context, level.walls, px, colours.wall, Math.min(2.5, Math.max(1, 0.12 * scale)), []);
}

function drawStop(context, kind, { place, outline }, px, scale) {
  const { colours } = theme;
  const shape = new Path2D();
  if (outline.length > 2) {
    ring(shape, outline.map(px));
    context.fillStyle = colours.grid;
    context.fill(shape);
    context.lineWidth = 1;
    context.strokeStyle = colours["sole-line"];
    context.stroke(shape);
  }
  const middle =
    outline.length > 2 ? [0, 1].map((k) => outline.reduce((sum, point) => sum + point[k], 0) / outline.length) : place;
  if (middle === null) return;
  const [x, y] = px(middle);
  const size = Math.min(9, Math.max(3.5, 0.7 * scale));
  context.lineWidth = 1.25;
  context.strokeStyle = colours.muted;
  context.beginPath();
  if (kind === "stairs") {
    context.moveTo(x - size, y + size * 0.7);
    for (let k = 0; k < 3; k++) {
      context.lineTo(x - size + (2 * size * k) / 3, y + size * (0.7 - 0.5 * (k + 1)));
      context.lineTo(x - size + (2 * size * (k + 1)) / 3, y + size * (0.7 - 0.5 * (k + 1)));
    }
  } else {
    for (const up of [-1, 1]) {
      context.moveTo(x - 0.45 * size, y + up * size * 0.4);
      context.lineTo(x, y + up * size);
      context.lineTo(x + 0.45 * size, y + up * size * 0.4);
    }
  }
  context.stroke();
}

function lines(context, some, px, colour, width, dash) {
  const path = new Path2D();
  for (const [x1, y1, x2, y2] of some) {
    path.moveTo(...px([x1, y1]));
    path.lineTo(...px([x2, y2]));
  }
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.lineCap = "round";
  context.setLineDash(dash);
  context.stroke(path);
  context.setLineDash([]);
}

function ring(path, points) {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
}

export function label(context, words, x, y, colour) {
  context.font = FONT;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeStyle = theme.colours.inset;
  context.strokeText(words, x, y);
  context.fillStyle = colour;
  context.fillText(words, x, y);
}
