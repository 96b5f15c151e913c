// Which walls of a level are outer ones: those beside the ground that is reached from outside without a wall or a door
// in between, on a small picture of the level.

import { paint, polygon, polyline } from "./canvas.js";

const SIDE = 256; // px of the picture
const BORDER = 6; // px around the level
const LINE = 1.6; // px, width of a wall in the picture
const OFF = 2.5; // px from a wall to the ground beside it
const SAMPLES = [0.25, 0.5, 0.75]; // along a wall; most of them must be beside the outside
const OPAQUE = 60; // opacity of a px from which on it is no ground

const known = new WeakMap();

// A list with true for each outer wall. outlines: those of the level's stairs and lifts; extent: of the plan.
export function outerWalls(level, outlines, extent) {
  if (!known.has(level)) known.set(level, found(level, outlines, extent));
  return known.get(level);
}

function found({ walls, doors, rooms }, outlines, [x0, x1, y0, y1]) {
  const scale = (SIDE - 2 * BORDER) / Math.max(1, x1 - x0, y1 - y0);
  const px = ([x, y]) => [BORDER + (x - x0) * scale, BORDER + (y - y0) * scale];
  const path = new Path2D();
  for (const ring of [...rooms, ...outlines]) polygon(ring.map(px), path);
  const canvas = Object.assign(document.createElement("canvas"), { width: SIDE, height: SIDE });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  paint(context, path, { fill: "#000", line: "#000", width: LINE });
  const lines = new Path2D();
  for (const [ax, ay, bx, by] of [...walls, ...doors]) polyline([px([ax, ay]), px([bx, by])], lines);
  paint(context, lines, { line: "#000", width: LINE });
  const outside = flooded(context.getImageData(0, 0, SIDE, SIDE).data);
  return walls.map(([ax, ay, bx, by]) => {
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const off = [((ay - by) / length) * OFF, ((bx - ax) / length) * OFF];
    const beside = SAMPLES.filter((share) => {
      const [x, y] = px([ax + share * (bx - ax), ay + share * (by - ay)]);
      return outside(x + off[0], y + off[1]) || outside(x - off[0], y - off[1]);
    });
    return 2 * beside.length > SAMPLES.length;
  });
}

// Whether a place is reached from the corner of the picture.
function flooded(data) {
  const reached = new Uint8Array(SIDE * SIDE);
  const open = [0];
  while (open.length > 0) {
    const at = open.pop();
    if (at < 0 || at >= reached.length || reached[at] || data[4 * at + 3] > OPAQUE) continue;
    reached[at] = 1;
    open.push(at - 1, at + 1, at - SIDE, at + SIDE); // the ends of two rows touch in the border, which is ground
  }
  return (x, y) => reached[Math.round(y) * SIDE + Math.round(x)] === 1;
}
