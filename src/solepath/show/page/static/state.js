// The state that results from the messages of protocol/page.md. All input is checked here: panels may rely on it that
// points consist of numbers. Nothing here draws. Limits were chosen by hand and not swept.

const MAX_POINTS = 2000; // points of a track
const PHASE_HISTORY = 20; // s of phases
const MAX_LOG_LINES = 50; // sentences of the log
const MAX_REPORTS = 100; // marks of reported positions
const MAX_TRAIL_POINTS = 240; // points of a centre of pressure's path
export const FEET = ["left", "right"];

const MAX_MAGNITUDE = 1e12; // limit of any number: nothing is farther away or later, and seconds can still be counted
const MAX_ITEMS = 500; // limit of cells, candidates and rows of the table: nobody has more, and they would take time

const sound = (value) => Number.isFinite(value) && Math.abs(value) < MAX_MAGNITUDE;
const number = (value) => (sound(value) ? value : null);
const text = (value) => (typeof value === "string" ? value : "");
const list = (value) => (Array.isArray(value) ? value : []);
const record = (value) => (value !== null && typeof value === "object" && !Array.isArray(value) ? value : {});
const numbers = (value, least) => Array.isArray(value) && value.length >= least && value.every(sound);

export class State {
  constructor() {
    this.clear();
  }

  clear() {
    this.known = false; // a scene came
    this.generation = (this.generation ?? 0) + 1;
    this.title = this.recipe = this.source = "";
    this.control = false;
    this.plan = null;
    this.layouts = { left: null, right: null };
    this.t = 0;
    this.start = 0; // session time that is shown as 0:00, s
    this.anyData = false; // true once a sensor has sent anything
    this.feet = { left: null, right: null };
    this.trails = { left: [], right: [] };
    this.phases = { left: [], right: [] };
    this.tracks = { left: [], right: [], wearer: [] };
    this.thinned = 0; // how often a track lost points, after which it must be drawn again
    this.places = [];
    this.log = [];
    this.reports = []; // {level: null in the world frame, x, y, used: null while nothing came of it}
    this.wearer = null;
    this.place = null;
    this.activity = null;
    this.support = null;
    this.touchdown = null; // {t, foot, mode, position: world frame, m}
    this.body = null; // {t, left, right: hip, knee, ankle, end of the foot as [ahead, up], m}
    this.fused = null; // {foot, length, similarity, errorIndex, share, chosen, distance}: the last fused stride
    this.gait = null;
    this.links = {};
    this.playback = null;
    this.toe_out = null; // {task, distance: m or null, feet: [{foot, strides, along, angle, sigma, learnt, why}]}: a walk that calibrates
    this.posture = null; // {foot, task, target, pitch, lean: rad or null, still}: a shoe that is measured
    this.pace = null;
    this.scales = {};
  }

  // Returns the names of what changed; a message of an unknown type changes nothing.
  take(message) {
    const { type } = record(message);
    if (type === "scene") return this.#scene(message);
    if (type === "frame" && this.known) return this.#frame(message);
    return new Set();
  }

  #scene(message) {
    this.clear();
    this.known = true;
    for (const name of ["title", "recipe", "source"]) this[name] = text(message[name]);
    this.control = message.control === true;
    this.plan = plan(message.plan);
    for (const foot of FEET) this.layouts[foot] = layout(record(message.layouts)[foot]);
    const { tracks, places, phases, log, reports } = message; // the lists of the scene itself are whole
    this.#frame({ ...record(message.frame), tracks, places, phases, log, reports });
    return new Set(["scene", "feet", "phases", "tracks", "places", "log", "reports", "links", ...Object.keys(READERS)]);
  }

  #frame(message) {
    const changed = new Set();
    if (number(message.t) !== null) this.t = message.t;
    this.#setStart(message);
    for (const foot of FEET) {
      const news = record(message.feet)[foot];
      if (news !== undefined && news !== null) this.#foot(foot, record(news), changed);
      for (const [t, phase] of list(record(message.phases)[foot]).filter((one) => numbers([one?.[0]], 1))) {
        insert(this.phases[foot], [t, text(phase)]);
        changed.add("phases");
      }
      const recent = this.phases[foot].findIndex(([t]) => t > this.t - PHASE_HISTORY);
      if (recent > 1) this.phases[foot].splice(0, recent - 1); // the one before still lasts into the window
    }
    for (const [name, kept] of Object.entries(this.tracks)) {
      for (const point of list(record(message.tracks)[name])) {
        if (!numbers(point, 4)) continue;
        kept.push(point.slice(0, 4));
        if (kept.length > MAX_POINTS) this.#thin(kept);
        changed.add("tracks");
      }
    }
    for (const point of list(message.places)) {
      if (!Array.isArray(point) || !numbers(point.slice(2), 2) || number(point[0]) === null) continue;
      this.places.push([point[0], text(point[1]), point[2], point[3], number(point[4]) ?? 0]);
      if (this.places.length > MAX_POINTS) this.#thin(this.places);
      changed.add("places");
    }
    for (const [t, kind, words] of list(message.log).filter(Array.isArray)) {
      this.log.push([number(t) ?? this.t, text(kind), text(words)]);
      if (this.log.length > MAX_LOG_LINES) this.log.shift();
      changed.add("log");
    }
    for (const [, level, x, y, used] of list(message.reports).filter(Array.isArray)) {
      if (!numbers([x, y], 2)) continue;
      this.reports.push({ level: level === null ? null : text(level), x, y, used: used === true || used === false ? used : null });
      if (this.reports.length > MAX_REPORTS) this.reports.shift();
      changed.add("reports");
    }
    for (const [name, read] of Object.entries(READERS)) {
      if (!(name in message)) continue;
      this[name] = read(message[name]);
      changed.add(name);
    }
    for (const [site, link] of Object.entries(record(message.links))) {
      this.links[site] = { ...this.links[site], ...record(link) };
      changed.add("links");
    }
    return changed;
  }

  // A recording states its start. A live session starts at the first known time, on a clock with any origin.
  #setStart({ playback, tracks, phases, log, feet, links }) {
    if (number(playback?.begin) !== null) this.start = playback.begin;
    else if (this.playback === null && !this.anyData) {
      const firsts = [...Object.values(record(tracks)), ...Object.values(record(phases)), log].map((some) =>
        number(list(some)[0]?.[0]),
      );
      this.anyData = [feet, links].some((one) => Object.keys(record(one)).length > 0) || firsts.some((t) => t !== null);
      if (this.anyData) this.start = Math.min(...firsts.filter((t) => t !== null), this.t || Infinity);
      if (!Number.isFinite(this.start)) this.start = 0;
    }
  }

  #foot(foot, news, changed) {
    const old = this.feet[foot] ?? { strides: 0, distance: 0, cells: null };
    const one = { ...old, ...news };
    if ("cells" in news) one.cells = bytes(news.cells);
    if (!numbers(one.position, 3)) one.position = null;
    if (!numbers(one.centre, 2)) one.centre = null;
    one.phase = text(one.phase);
    one.peak = number(one.peak) ?? 0;
    one.force = number(one.force);
    this.feet[foot] = one;
    changed.add("feet");
    const trail = this.trails[foot];
    if (one.centre === null) return; // in the air the path of the last stance stays
    if (old.centre === null || old.centre === undefined) trail.length = 0;
    trail.push(one.centre);
    if (trail.length > MAX_TRAIL_POINTS) trail.shift();
  }

  #thin(points) {
    const last = points.length - 1;
    let kept = 0;
    for (let i = 0; i <= last; i++) if (i % 2 === 0 || i === last) points[kept++] = points[i];
    points.length = kept;
    this.thinned += 1;
  }
}

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

// Members that a frame sends whole, with the function that checks each.
const READERS = { wearer, place, activity, pace, scales, support, touchdown, body, fused, gait, playback, posture, toe_out };

// Sorted by time: a phase may become known after one that started later.
function insert(phases, one) {
  let at = phases.length;
  while (at > 0 && phases[at - 1][0] > one[0]) at -= 1;
  if (at > 0 && phases[at - 1][0] === one[0]) phases[at - 1] = one;
  else phases.splice(at, 0, one);
}

function bytes(encoded) {
  if (typeof encoded !== "string") return null;
  try {
    return Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
  } catch {
    return null;
  }
}

function layout(value) {
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
  const rows = list(value.rows)
    .slice(0, MAX_ITEMS)
    .filter((row) => typeof row?.name === "string");
  return {
    running: value.running === true,
    cadence: number(value.cadence),
    coordination: number(value.coordination),
    strides: Object.fromEntries(FEET.map((foot) => [foot, number(value.strides?.[foot])])),
    enough: number(value.enough) ?? 0,
    rows,
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
  const sound = named.filter(([room]) => room.length > 2);
  return { rooms: sound.map(([room]) => room), names: sound.map(([, name]) => name) };
}

function plan(value) {
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
