// Checks each part of a message (protocol/page.md), so that panels may rely on it that points consist of numbers.
// Limits were chosen by hand and not swept.

export const FEET = ["left", "right"];
const MAX_MAGNITUDE = 1e12; // limit of any number: nothing is farther away or later, and seconds can still be counted
const MAX_ITEMS = 500; // limit of cells, candidates and rows of the table: nobody has more, and they would take time

export const sound = (value) => Number.isFinite(value) && Math.abs(value) < MAX_MAGNITUDE;
export const number = (value) => (sound(value) ? value : null);
export const text = (value) => (typeof value === "string" ? value : "");
export const list = (value) => (Array.isArray(value) ? value : []);
export const record = (value) => (value !== null && typeof value === "object" && !Array.isArray(value) ? value : {});
export const numbers = (value, least) => Array.isArray(value) && value.length >= least && value.every(sound);

const support = (value) => text(value) || null;

const touchdown = (value) => {
  const { t, foot, mode, position } = record(value);
  return FEET.includes(foot) && numbers(position, 3) ? { t: number(t), foot, mode: text(mode), position } : null;
};

const body = (value) => {
  const { t, left, right } = record(value);
  const legs = [left, right].map((leg) => list(leg).filter((point) => numbers(point, 2)).slice(0, 4));
  return legs.every((leg) => leg.length === 4) && sound(t) ? { t, left: legs[0], right: legs[1] } : null;
};

const fused = (value) => {
  const { foot, chosen, length, distance, similarity, error_index: errorIndex, share } = record(value);
  if (!FEET.includes(foot) || !FEET.includes(chosen) || !numbers([length, distance], 2)) return null;
  return { foot, chosen, length, distance, similarity: number(similarity), errorIndex: number(errorIndex), share: number(share) };
};

const toeOutOfFoot = ({ foot, strides, along, angle, sigma, learnt, why }) => ({
  foot,
  strides: number(strides) ?? 0,
  along: number(along) ?? 0,
  angle: number(angle),
  sigma: number(sigma),
  learnt: learnt === true,
  why: text(why),
});

const toe_out = (value) => {
  const { task, distance, feet } = record(value);
  if (!Array.isArray(feet)) return null;
  const known = feet.map(record).filter(({ foot }) => FEET.includes(foot)).slice(0, FEET.length);
  return { task: text(task), distance: number(distance), feet: known.map(toeOutOfFoot) };
};

const posture = (value) => {
  const { foot, task, target, pitch, lean, still } = record(value);
  if (!FEET.includes(foot)) return null;
  return { foot, task: text(task), target: number(target), pitch: number(pitch), lean: number(lean), still: still === true };
};

const rowsOf = (value) => list(value).slice(0, MAX_ITEMS).filter((row) => typeof row?.name === "string");

const total = (value) => {
  const { cadence, speed, rows } = record(value);
  return { cadence: number(cadence), speed: number(speed), rows: rowsOf(rows) };
};

// {site: "" for both feet, brief: one sentence, what: all of it, act: results are wrong until somebody acts}
const findings = (value) =>
  list(value)
    .slice(0, MAX_ITEMS)
    .map(record)
    .filter(({ what }) => text(what) !== "")
    .map(({ site, brief, what, act }) => ({ site: text(site), brief: text(brief), what, act: act === true }));

// Members that a frame sends whole, with the function that checks each.
export const READERS = { wearer, place, activity, pace, scales, support, touchdown, body, fused, gait, total, findings, playback, posture, toe_out };

export function bytes(encoded) {
  if (typeof encoded !== "string") return null;
  try {
    return Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
  } catch {
    return null;
  }
}

export function layout(value) {
  const cells = list(value?.cells)
    .slice(0, MAX_ITEMS)
    .filter((cell) => numbers(cell, 2))
    .map(([x, y, area]) => [x, y, area > 0 ? area : 0]);
  if (cells.length === 0) return null;
  const areas = cells.every((cell) => cell[2] > 0);
  return {
    cells,
    length: value.length > 0 ? value.length : 0.27,
    // without areas newtons are not a pressure, and are shown as newtons
    unit: value.unit === "N" ? (areas ? "kPa" : "N") : "counts",
    word: value.unit === "N" ? (areas ? "kPa" : "N a cell") : "counts a cell",
    forces: value.unit === "N",
  };
}

function wearer(value) {
  if (!numbers(value?.position, 3)) return null;
  return { position: value.position, covariance: numbers(value.covariance, 6) ? value.covariance : null };
}

function place(value) {
  if (!numbers(value?.position, 2)) return null;
  const candidates = list(value.candidates)
    .slice(0, MAX_ITEMS)
    .filter((one) => numbers([one?.x, one?.y], 2))
    .map((one) => ({
      level: text(one.level),
      x: one.x,
      y: one.y,
      heading: number(one.heading),
      weight: number(one.weight) ?? 0,
    }));
  const decided = value.decided === true;
  const [level, room, door] = [text(value.level), text(value.room), text(value.door)]; // "" while none is known
  return { level, room, door, position: value.position, decided, spread: number(value.spread), candidates };
}

function activity(value) {
  if (typeof value?.now !== "string") return null;
  return { now: value.now, since: number(value.since), last: text(value.last) || null };
}

function pace(value) {
  return { cadence: number(value?.cadence), speed: number(value?.speed) };
}

function scales(value) {
  const known = Object.entries(record(value)).filter(([, scale]) => sound(scale?.top) && scale.top > 0);
  return Object.fromEntries(known.map(([unit, { top, beyond }]) => [unit, { top, beyond: beyond === true }]));
}

function gait(value) {
  if (value === null || typeof value !== "object") return null;
  return {
    running: value.running === true,
    cadence: number(value.cadence),
    coordination: number(value.coordination),
    strides: Object.fromEntries(FEET.map((foot) => [foot, number(value.strides?.[foot])])),
    enough: number(value.enough) ?? 0,
    rows: rowsOf(value.rows),
  };
}

function playback(value) {
  if (!numbers([value?.begin, value?.end, value?.t], 3)) return null;
  const { begin: start, end, t } = value;
  return { start, end, t, state: text(value.state), speed: number(value.speed) ?? 1, seeking: number(value.seeking) };
}

// Outlines of rooms, and their names in the same order.
function rooms(level, ring) {
  const named = list(level?.rooms).map((room, i) => [ring(room), text(list(level.room_names)[i])]);
  const known = named.filter(([room]) => room.length > 2);
  return { rooms: known.map(([room]) => room), names: known.map(([, name]) => name) };
}

export function plan(value) {
  if (value === null || typeof value !== "object") return null;
  const ring = (points) => list(points).filter((point) => numbers(point, 2));
  const lines = (some) => list(some).filter((line) => numbers(line, 4));
  const levels = list(value.levels).map((level) => ({
    id: text(level?.id),
    name: text(level?.name) || text(level?.id),
    elevation: number(level?.elevation),
    walls: lines(level?.walls),
    doors: lines(level?.doors),
    ...rooms(level, ring),
  }));
  const connectors = list(value.connectors).map((one) => ({
    kind: text(one?.kind),
    name: text(one?.name),
    stops: list(one?.stops).map((stop) => ({
      level: text(stop?.level),
      place: numbers(stop?.place, 2) ? stop.place : null,
      outline: ring(stop?.outline),
    })),
  }));
  return levels.length > 0 ? { name: text(value.name), levels, connectors } : null;
}
