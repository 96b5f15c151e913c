// Rooms of a level: in which one a place is, and where the name of each fits; and which of its walls are outer ones.

import { bounds, paint, polygon, polyline } from "./canvas.js";
import { measured } from "./labels.js";

const SEARCHED = 9; // places tried along each side of a room
const CENTRED = 0.3; // by how much a box at the edge of a room must be larger than one in its middle, as a share
const MAX_NAME = 60; // letters
const LEAST_ROOM = 20; // px; no text is smaller
const TALL = 2; // height by width from which on a name is rather read from below than on several lines
const PADDING = [4, 1.5]; // px between the ends of a name and the walls, and above and below it

const SIDE = 256; // px of the picture
const BORDER = 6; // px around the level
const LINE = 1.6; // px, width of a wall in the picture
const OFF = 2.5; // px from a wall to the ground beside it
const SAMPLES = [0.25, 0.5, 0.75]; // along a wall; most of them must be beside the outside
const OPAQUE = 60; // opacity of a px from which on it is no ground

const known = new WeakMap(); // what was computed of a room, by its outline, of a level, and of its walls

function once(key, make) {
  if (!known.has(key)) known.set(key, make());
  return known.get(key);
}

// Calls visit(from, to) with the ends of each wall of a room.
const eachWall = (ring, visit) => ring.forEach((from, i) => visit(from, ring[(i + 1) % ring.length]));

function facts(ring) {
  return once(ring, () => {
    let twice = 0;
    eachWall(ring, ([x, y], [a, b]) => (twice += x * b - a * y));
    return { ends: bounds(ring), area: Math.abs(twice) / 2, boxes: {} };
  });
}

// Number of the smallest room at a place; -1 outside of all.
export function roomAt({ rooms }, [x, y]) {
  let [found, least] = [-1, Infinity];
  rooms.forEach((ring, i) => {
    const { area } = facts(ring);
    if (area < least && isWithin(ring, x, y)) [found, least] = [i, area];
  });
  return found;
}

function isWithin(ring, x, y) {
  let odd = false;
  eachWall(ring, ([x1, y1], [x2, y2]) => {
    if (y1 > y !== y2 > y && x < x1 + ((x2 - x1) * (y - y1)) / (y2 - y1)) odd = !odd;
  });
  return odd;
}

// Where a name fits in the room, or a shorter form of it: {words, at: [x, y] in m, upright, slack: px by which it may be
// moved to either side, and up or down} or null. scale: px per m; kind: what most rooms are called, as in "room 12".
export function nameIn(ring, name, scale, bold = false, kind = null) {
  const one = facts(ring);
  const key = `${name} ${scale} ${bold}`;
  if (one.named?.key !== key) one.named = { key, found: fitted(one, ring, name, scale, bold, kind) };
  return one.named.found;
}

function fitted(one, ring, name, scale, bold, kind) {
  const [x0, x1, y0, y1] = one.ends;
  if (Math.max(x1 - x0, y1 - y0) * scale < LEAST_ROOM) return null;
  for (const [words, upright] of forms(name.slice(0, MAX_NAME), y1 - y0 > TALL * (x1 - x0), kind)) {
    const size = measured(words, bold).map((side, k) => side / 2 + PADDING[k]);
    const [wide, high] = upright ? [size[1], size[0]] : size;
    const key = `${words} ${upright} ${bold}`;
    const { at, half } = (one.boxes[key] ??= largestBox(ring, one.ends, wide / high));
    const slack = [(half * wide * scale) / high - wide, half * scale - high];
    if (slack[1] >= 0) return { words, at, upright, slack };
  }
  return null;
}

// The name on one line, in a tall room read from below, on two lines and on three, and the number at its end alone.
function* forms(name, tall, kind) {
  yield [name, false];
  if (tall) yield [name, true];
  const words = name.split(" ");
  for (const count of [2, 3]) if (words.length >= count && name.length > 9) yield [wrapped(words, count), false];
  if (words.length > 1 && kindOf(name) === kind) yield [words.at(-1), false];
}

// The words on so many lines, so that the longest line is short.
function wrapped(words, count) {
  if (count === 1) return words.join(" ");
  const splits = words.slice(count - 1).map((_, i) => `${words.slice(0, i + 1).join(" ")}\n${wrapped(words.slice(i + 1), count - 1)}`);
  const longest = (text) => Math.max(...text.split("\n").map((line) => line.length));
  return splits.reduce((best, one) => (longest(one) < longest(best) ? one : best));
}

// What a room is called without the number at its end; "" without one.
const kindOf = (name) => /^(.+) \S{0,3}\d\S{0,3}$/.exec(name)?.[1] ?? "";

// What most of the numbered rooms of a level are called: their numbers alone say enough. null if none is numbered.
export function usualKind(level) {
  return once(level, () => {
    const counts = new Map();
    for (const kind of level.room_names.map(kindOf).filter(Boolean)) counts.set(kind, (counts.get(kind) ?? 0) + 1);
    return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? null;
  });
}

// The largest box of this aspect in the room: its middle and half its height, m.
function largestBox(ring, [x0, x1, y0, y1], aspect) {
  const [mx, my] = [(x0 + x1) / 2, (y0 + y1) / 2];
  const far = Math.hypot(x1 - x0, y1 - y0) || 1;
  const shares = Array.from({ length: SEARCHED }, (_, i) => (i + 0.5) / SEARCHED);
  const places = shares.flatMap((a) => shares.map((b) => [x0 + a * (x1 - x0), y0 + b * (y1 - y0)]));
  let best = { at: [mx, my], half: 0, worth: 0 };
  for (const [x, y] of [[mx, my], ...places]) {
    const half = isWithin(ring, x, y) ? halfAt(ring, x, y, aspect) : 0;
    const worth = half * (1 - (CENTRED * Math.hypot(x - mx, y - my)) / far);
    if (worth > best.worth) best = { at: [x, y], half, worth };
  }
  return best;
}

// Half the height of the largest box of this aspect about a place that no wall of the room crosses, m.
function halfAt(ring, x, y, aspect) {
  let least = Infinity;
  eachWall(ring, (from, to) => {
    const [u1, v1, u2, v2] = [(from[0] - x) / aspect, from[1] - y, (to[0] - x) / aspect, to[1] - y];
    const [du, dv] = [u2 - u1, v2 - v1];
    // max(|u|, |v|) is convex along the wall: it is least at an end, where |u| = |v|, or where one of them is 0
    for (const t of [0, 1, -(u1 - v1) / (du - dv), -(u1 + v1) / (du + dv), -u1 / du, -v1 / dv]) {
      if (t >= 0 && t <= 1) least = Math.min(least, Math.max(Math.abs(u1 + t * du), Math.abs(v1 + t * dv)));
    }
  });
  return least;
}

// A list with true for each outer wall: those beside the ground that is reached from outside without a wall or a door in
// between, on a small picture of the level. outlines: those of the level's stairs and lifts; extent: of the plan.
export const outerWalls = (level, outlines, extent) => once(level.walls, () => foundOuter(level, outlines, extent));

function foundOuter({ walls, doors, rooms }, outlines, [x0, x1, y0, y1]) {
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
