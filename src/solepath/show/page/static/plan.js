// One level of a floor plan: rooms, walls, doors, stairs and lifts, and what they are called.

import { measured } from "./labels.js";
import { outerWalls } from "./outer.js";
import { WEARER_RADIUS } from "./marks.js";
import { isConnector } from "./position.js";
import { nameIn, usualKind } from "./rooms.js";
import { drawBadge, drawFlight, drawSymbol, badgeSize } from "./symbols.js";
import { theme } from "./theme.js";

const OUTER = [0.1, 2.5, 4]; // width of an outer wall: m, and its limits, px
const INNER = [0.045, 1.2, 2];
const NAME_SIZE = 12; // px
const HERE = { bold: true, colour: "ink", ground: "here", weight: 6 }; // name of the wearer's room
const ASIDE = [0, -0.5, 0.5, -1, 1]; // where a name may be across its room: shares of the way from its middle to the walls
const LEAST_WAY = 90; // px between two places for a name along its room
const NARROW = 8; // px; where a name has no more space to each side it is left out rather than put on the track
const CLEAR = 22; // px from the middle of the wearer's mark within which nothing else is
const MAX_PLACES = 12; // places for a name along its room, to each side of its middle

// [least x, least y, greatest x, greatest y] of all levels, m; null for an empty plan.
export function extent(plan) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const hold = (x, y) => {
    [box[0], box[1]] = [Math.min(box[0], x), Math.min(box[1], y)];
    [box[2], box[3]] = [Math.max(box[2], x), Math.max(box[3], y)];
  };
  for (const level of plan.levels) {
    for (const [x1, y1, x2, y2] of level.walls) {
      hold(x1, y1);
      hold(x2, y2);
    }
    for (const room of level.rooms) for (const point of room) hold(...point);
  }
  for (const { stop } of stopsOf(plan)) for (const point of stop.outline) hold(...point);
  return box[0] === Infinity ? null : box;
}

const stopsOf = (plan) => plan.connectors.flatMap(({ kind, name, stops }) => stops.map((stop) => ({ kind, name, stop })));
const stopsOn = (plan, level) => stopsOf(plan).filter(({ stop }) => stop.level === level.id);

// Number of the stairs or the lift on this level whose badge the wearer's mark at `at`, m, covers, or -1.
export function coveredStop(plan, level, at, scale) {
  const reach = WEARER_RADIUS + badgeSize(scale) / 2 + 3;
  return stopsOn(plan, level).findIndex(({ stop }) => {
    const middle = middleOf(stop);
    return middle !== null && Math.hypot(middle[0] - at[0], middle[1] - at[1]) * scale < reach;
  });
}

// The badge and the name that the wearer's mark at [x, y], px, would cover: above it, or below it at the top.
export function nameCovered(context, labels, plan, level, covered, [x, y], scale) {
  const { kind, name } = stopsOn(plan, level)[covered];
  const badge = badgeSize(scale);
  const off = CLEAR + badge / 2;
  const at = [x, y > 2 * off ? y - off : y + off];
  drawBadge(context, at, badge);
  drawSymbol(context, kind, at, badge);
  labels.keep(at[0] - badge / 2, at[1] - badge / 2, badge, badge);
  const side = badge / 2 + 6;
  const spots = [[at[0] + side, at[1], "left"], [at[0] - side, at[1], "right"]];
  labels.add(name ? callOf(kind, name) : kind, spots, { size: NAME_SIZE, weight: 9, bold: true, colour: "ink", ground: "room" });
}

// What does not move. px: ([x, y]) => [px, px]; scale: px per m; size: of the picture, px; here: number of the wearer's room;
// covered: number of the stop that has its badge elsewhere
export function drawLevel(context, plan, level, { px, scale, size }, here, whole, covered = -1) {
  const { colours } = theme;
  const stops = stopsOn(plan, level);
  const outlines = stops.map(({ stop }) => stop.outline).filter((outline) => outline.length > 2);
  if (level.rooms.length > 0) {
    context.fillStyle = colours.outside;
    context.fillRect(0, 0, ...size);
  }
  fill(context, [...level.rooms, ...outlines], px, colours.room);
  if (here >= 0) fill(context, [level.rooms[here]], px, colours.here);
  for (const { kind, stop } of stops) {
    if (stop.outline.length > 2) drawFlight(context, kind, stop.outline, px, scale);
  }
  const outer = outerWalls(level, outlines, whole);
  const seen = level.walls.map((wall) => isSeen(wall, px, size));
  const [thick, thin] = [OUTER, INNER].map(([metres, least, most]) => Math.min(most, Math.max(least, metres * scale)));
  lines(context, level.walls.filter((_, i) => seen[i] && !outer[i]), px, colours["inner-wall"], thin, "round");
  lines(context, level.walls.filter((_, i) => seen[i] && outer[i]), px, colours.wall, thick, "round");
  // a door is a gap, also where the file draws the wall through it
  lines(context, level.doors.filter((door) => isSeen(door, px, size)), px, colours.room, thick + 0.5, "butt");
  stops.forEach(({ kind, stop }, i) => {
    const middle = i === covered ? null : middleOf(stop);
    if (middle) drawBadge(context, px(middle), badgeSize(scale));
    if (middle) drawSymbol(context, kind, px(middle), badgeSize(scale));
  });
}

// Names of rooms, stairs and lifts, where they fit.
export function nameLevel(labels, plan, level, px, scale, here, covered = -1) {
  const badge = badgeSize(scale);
  const onScreen = ([x, y]) => x > -60 && y > -60 && x < labels.width + 60 && y < labels.height + 60;
  for (const [i, { kind, name, stop }] of stopsOn(plan, level).entries()) {
    const middle = middleOf(stop);
    if (i === covered || middle === null || !onScreen(px(middle))) continue;
    const [x, y] = px(middle);
    labels.keep(x - badge / 2, y - badge / 2, badge, badge);
    if (!name || stop.outline.length < 3) continue;
    const ends = stop.outline.map(px);
    const [w, h] = [0, 1].map((k) => Math.max(...ends.map((p) => p[k])) - Math.min(...ends.map((p) => p[k])));
    const words = callOf(kind, name);
    const fits = nameIn(stop.outline, words, scale, { size: NAME_SIZE });
    if (!fits || (w < 3 * badge && h < 2.4 * badge)) continue;
    const spots = w > h ? [[x + badge / 2 + 5, y, "left"]] : [[x, y + badge / 2 + 9]];
    labels.add(words, spots, { size: NAME_SIZE, weight: 4, ground: "room" });
  }
  const kind = usualKind(level);
  level.rooms.forEach((room, i) => {
    const name = level.names[i];
    if (!name || !seesRing(room, px, labels)) return;
    const style = { size: NAME_SIZE, ground: "room", weight: 5, ...(i === here ? HERE : {}) };
    const found = nameIn(room, name, scale, style, kind);
    if (!found) return;
    labels.add(found.words, spotsOf(found, px(found.at), style).filter(onScreen), {
      ...style,
      upright: found.upright,
      strict: Math.min(...found.slack) < NARROW || i === here, // a note names the wearer's room
    });
  });
}

// Where a name may be: in the middle of its room, and else aside of it or farther along the room. The places do not move
// with the view, so that a name stays where it is as long as it is seen.
function spotsOf({ words, upright, slack }, [x, y], style) {
  const [wide, high] = measured(words, style);
  const lying = slack[0] >= slack[1];
  const way = Math.max(LEAST_WAY, (lying === upright ? high : wide) + 20);
  const [along, across] = lying ? slack : [slack[1], slack[0]];
  const count = Math.min(MAX_PLACES, Math.floor(along / way));
  const step = count > 0 ? way : along;
  const ways = Array.from({ length: 2 * Math.max(1, count) + 1 }, (_, i) => (i % 2 ? 1 : -1) * Math.ceil(i / 2) * step);
  return ways.flatMap((a) => ASIDE.map((share) => (lying ? [x + a, y + share * across] : [x + share * across, y + a])));
}

const callOf = (kind, name) => (isConnector(name) ? name : `${kind} ${name}`);

function seesRing(ring, px, { width, height }) {
  const points = ring.map(px);
  const [left, right, top, bottom] = [0, 1].flatMap((k) => [Math.min(...points.map((p) => p[k])), Math.max(...points.map((p) => p[k]))]);
  return right > 0 && left < width && bottom > 0 && top < height;
}

function middleOf({ place, outline }) {
  if (outline.length < 3) return place;
  return [0, 1].map((k) => {
    const values = outline.map((point) => point[k]);
    return (Math.min(...values) + Math.max(...values)) / 2;
  });
}

function isSeen([x1, y1, x2, y2], px, [width, height]) {
  const [[a, b], [c, d]] = [px([x1, y1]), px([x2, y2])];
  return Math.max(a, c) >= 0 && Math.min(a, c) <= width && Math.max(b, d) >= 0 && Math.min(b, d) <= height;
}

function fill(context, rings, px, colour) {
  const path = new Path2D();
  for (const points of rings) {
    points.forEach((point, i) => (i === 0 ? path.moveTo(...px(point)) : path.lineTo(...px(point))));
    path.closePath();
  }
  context.fillStyle = colour;
  context.fill(path);
}

function lines(context, some, px, colour, width, cap) {
  const path = new Path2D();
  for (const [x1, y1, x2, y2] of some) {
    path.moveTo(...px([x1, y1]));
    path.lineTo(...px([x2, y2]));
  }
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.lineCap = cap;
  context.stroke(path);
}
