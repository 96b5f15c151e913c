// One level of a floor plan: rooms, walls, doors, stairs and lifts, and what they are called.

import { bounds, clamp, paint, polygon, polyline, rectangle } from "./canvas.js";
import { measured } from "./labels.js";
import { WEARER_RADIUS } from "./marks.js";
import { nameIn, usualKind } from "./rooms.js";
import { badgeSize, drawBadge, drawFlight } from "./symbols.js";

const OUTER = [0.1, 2.5, 4]; // width of an outer wall: m, and its limits, px
const INNER = [0.045, 1.2, 2];
const HERE = { bold: true, colour: "ink", ground: "here", weight: 6 }; // name of the wearer's room
const ASIDE = [0, -0.5, 0.5, -1, 1]; // where a name may be across its room: shares of the way from its middle to the walls
const LEAST_WAY = 90; // px between two places for a name along its room
const NARROW = 8; // px; where a name has no more space to each side it is left out rather than put on the track
const CLEAR = 22; // px from the middle of the wearer's mark within which nothing else is
const MAX_PLACES = 12; // places for a name along its room, to each side of its middle

// Outer walls are those beside the ground that is reached from outside without a wall or a door in between, on a small
// picture of the level.
const SIDE = 256; // px of the picture
const BORDER = 6; // px around the level
const LINE = 1.6; // px, width of a wall in the picture
const OFF = 2.5; // px from a wall to the ground beside it
const SAMPLES = [0.25, 0.5, 0.75]; // along a wall; most of them must be beside the outside
const OPAQUE = 60; // opacity of a px from which on it is no ground

// [least x, greatest x, least y, greatest y] of all levels, m; null for an empty plan.
export function extent({ levels, connectors }) {
  const points = levels.flatMap(({ walls, rooms }) => [...walls.flatMap(([a, b, c, d]) => [[a, b], [c, d]]), ...rooms.flat()]);
  points.push(...connectors.flatMap(({ stops }) => stops.flatMap(({ outline }) => outline)));
  return points.length > 0 ? bounds(points) : null;
}

const stopsOn = ({ connectors }, level) =>
  connectors.flatMap(({ kind, name, stops }) => stops.filter((stop) => stop.level === level.id).map((stop) => ({ kind, name, ...stop })));

// What does not move. px: ([x, y]) => [px, px]; scale: px per m; size: of the picture, px; here: number of the wearer's
// room; whole: extent of the plan
export function drawLevel(context, plan, level, { px, scale, size }, here, whole) {
  const flights = stopsOn(plan, level).filter(({ outline }) => outline.length > 2);
  const outlines = flights.map(({ outline }) => outline);
  if (level.rooms.length > 0) paint(context, rectangle(0, 0, ...size), { fill: "outside" });
  const rooms = new Path2D();
  for (const ring of [...level.rooms, ...outlines]) polygon(ring.map(px), rooms);
  paint(context, rooms, { fill: "room" });
  if (here >= 0) paint(context, polygon(level.rooms[here].map(px)), { fill: "here" });
  for (const { kind, outline } of flights) drawFlight(context, kind, outline.map(px), scale);
  const outer = outerWalls(level, outlines, whole);
  const [thick, thin] = [OUTER, INNER].map(([metres, least, most]) => clamp(metres * scale, least, most));
  const lines = (some) => {
    const path = new Path2D();
    for (const [x1, y1, x2, y2] of some) polyline([px([x1, y1]), px([x2, y2])], path);
    return path;
  };
  paint(context, lines(level.walls.filter((_, i) => !outer[i])), { line: "inner-wall", width: thin });
  paint(context, lines(level.walls.filter((_, i) => outer[i])), { line: "wall", width: thick });
  // a door is a gap, also where the file draws the wall through it
  paint(context, lines(level.doors), { line: "room", width: thick + 0.5, cap: "butt" });
}

// Badges and names of stairs and lifts. The wearer's mark at `wearer`, px, covers none of them: there they are above it, or
// below it at the top.
export function drawStops(context, labels, plan, level, px, scale, wearer) {
  const badge = badgeSize(scale);
  for (const { kind, name, place, outline } of stopsOn(plan, level)) {
    const [x0, x1, y0, y1] = bounds(outline.length > 2 ? outline : [place]);
    const [x, y] = px([(x0 + x1) / 2, (y0 + y1) / 2]);
    const covered = wearer !== null && Math.hypot(x - wearer[0], y - wearer[1]) < WEARER_RADIUS + badge / 2 + 3;
    const off = CLEAR + badge / 2;
    const at = covered ? [wearer[0], wearer[1] + (wearer[1] > 2 * off ? -off : off)] : [x, y];
    const words = isConnector(name) ? name : `${kind} ${name}`.trim();
    const [wide, high] = [(x1 - x0) * scale, (y1 - y0) * scale];
    drawBadge(context, kind, at, badge);
    labels.keepAround(at, badge / 2);
    if (covered) {
      const spots = [[at[0] + badge / 2 + 6, at[1], "left"], [at[0] - badge / 2 - 6, at[1], "right"]];
      labels.add(words, spots, { weight: 9, bold: true, colour: "ink" });
    } else if (name && (wide >= 3 * badge || high >= 2.4 * badge) && nameIn(outline, words, scale)) {
      labels.add(words, wide > high ? [[x + badge / 2 + 5, y, "left"]] : [[x, y + badge / 2 + 9]], { weight: 4 });
    }
  }
}

// Whether this is the name of stairs or of a lift.
const isConnector = (name) => /lift|elevator|stair|escalator|ramp/i.test(name);

// Names of rooms, where they fit.
export function nameRooms(labels, level, px, scale, here) {
  const { width, height } = labels.surface;
  const kind = usualKind(level);
  level.rooms.forEach((room, i) => {
    const name = level.room_names[i];
    const style = i === here ? HERE : { weight: 5 };
    const found = name ? nameIn(room, name, scale, style.bold, kind) : null;
    if (found === null) return;
    const spots = spotsOf(found, px(found.at), style.bold).filter(([x, y]) => x > 0 && y > 0 && x < width && y < height);
    const strict = Math.min(...found.slack) < NARROW || i === here; // a note names the wearer's room
    labels.add(found.words, spots, { ...style, upright: found.upright, strict });
  });
}

// Where a name may be: in the middle of its room, and else aside of it or farther along the room. The places do not move
// with the view, so that a name stays where it is as long as it is seen.
function spotsOf({ words, upright, slack }, [x, y], bold) {
  const [wide, high] = measured(words, bold);
  const lying = slack[0] >= slack[1];
  const way = Math.max(LEAST_WAY, (lying === upright ? high : wide) + 20);
  const [along, across] = lying ? slack : [slack[1], slack[0]];
  const count = Math.min(MAX_PLACES, Math.floor(along / way));
  const step = count > 0 ? way : along;
  const ways = Array.from({ length: 2 * Math.max(1, count) + 1 }, (_, i) => (i % 2 ? 1 : -1) * Math.ceil(i / 2) * step);
  return ways.flatMap((a) => ASIDE.map((share) => (lying ? [x + a, y + share * across] : [x + share * across, y + a])));
}

const known = new WeakMap(); // which walls of a level are outer ones

// A list with true for each outer wall. outlines: those of the level's stairs and lifts; extent: of the plan.
function outerWalls(level, outlines, extent) {
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
