// One level of a floor plan: rooms, walls, doors, stairs and lifts, and what they are called.

import { bounds, clamp, paint, polygon, polyline, rectangle, within } from "./canvas.js";
import { measured } from "./labels.js";
import { WEARER_RADIUS } from "./marks.js";
import { nameIn, outerWalls, usualKind } from "./rooms.js";

const OUTER = [0.1, 2.5, 4]; // width of an outer wall: m, and its limits, px
const INNER = [0.045, 1.2, 2];
const HERE = { bold: true, colour: "ink", ground: "here", weight: 6 }; // name of the wearer's room
const ASIDE = [0, -0.5, 0.5, -1, 1]; // where a name may be across its room: shares of the way from its middle to the walls
const LEAST_WAY = 90; // px between two places for a name along its room
const NARROW = 8; // px; where a name has no more space to each side it is left out rather than put on the track
const CLEAR = 22; // px from the middle of the wearer's mark within which nothing else is
const MAX_PLACES = 12; // places for a name along its room, to each side of its middle
const TREAD = 0.3; // m between two lines of stairs
const LEAST_TREAD = 4; // px
// Steps for stairs, and arrows up and down for a lift, in a square from -1 to 1.
const STEPS = [[-0.65, 0.55], [-0.65, 0.19], [-0.23, 0.19], [-0.23, -0.17], [0.19, -0.17], [0.19, -0.53], [0.61, -0.53]];
const ARROWS = [-1, 1].map((up) => [[-0.5, up * 0.14], [0, up * 0.7], [0.5, up * 0.14]]);

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
      continue;
    }
    const found = name ? nameIn(outline, words, scale) : null;
    if (found === null) continue;
    const { upright } = found;
    const [w, h] = upright ? measured(found.words).toReversed() : measured(found.words);
    const spots = [];
    if (wide / 2 > badge / 2 + 5 + w) spots.push([x + badge / 2 + 5, y, "left"]);
    if (high / 2 > badge / 2 + 2 + h) spots.push([x, y + badge / 2 + 2 + h / 2]);
    labels.add(found.words, spots, { weight: 4, upright });
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

// Stairs and lifts: treads and a cabin in their outlines, and a badge that is recognised at any scale.
const badgeSize = (scale) => Math.round(clamp(0.75 * scale, 12, 20));

// The outline with treads across its longer side, or with the diagonals of a cabin.
function drawFlight(context, kind, points, scale) {
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

function drawBadge(context, kind, [x, y], size) {
  for (const [fill, half] of [["room", size / 2 + 1.5], ["muted", size / 2]]) {
    const path = new Path2D();
    path.roundRect(x - half, y - half, 2 * half, 2 * half, half / 2);
    paint(context, path, { fill });
  }
  const at = (points) => points.map(([right, down]) => [x + (right * size) / 2, y + (down * size) / 2]);
  if (kind === "stairs") paint(context, polyline(at(STEPS)), { line: "room", width: Math.max(1.5, size / 9), cap: "butt" });
  else for (const arrow of ARROWS) paint(context, polygon(at(arrow)), { fill: "room" });
}
