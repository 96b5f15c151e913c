// The state that results from the messages of protocol/page.md. All input is
// checked (readers.js). Nothing here draws. Limits were chosen by hand and not swept.

import { FEET, READERS, bytes, layout, list, number, numbers, plan, record, text } from "./readers.js";

export { FEET };

const MAX_POINTS = 2000; // points of a track
const PHASE_HISTORY = 20; // s of phases
const MAX_LOG_LINES = 50; // sentences of the log
const MAX_REPORTS = 100; // marks of reported positions
const MAX_TRAIL_POINTS = 240; // points of a centre of pressure's path
const CELLS_TIME = 1; // s after the start within which cells of an insole have sent, if there are any

export class State {
  over = false; // the program behind the page has ended its session

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
    this.total = null; // {cadence, speed, rows}: means of all steady strides
    this.findings = []; // {site, brief, what, act}: what the checks found
    this.links = {};
    this.playback = null;
    this.toe_out = null; // {task, distance: m or null, feet: [{foot, strides, along, angle, sigma, learnt, why}]}: a walk that calibrates
    this.posture = null; // {foot, task, target, pitch, lean: rad or null, still}: a shoe that is measured
    this.pace = null;
    this.scales = {};
  }

  // Whether there are pressure cells: "cells", "none", or "unknown" while too little has come to say it.
  get soles() {
    const feet = FEET.map((foot) => this.feet[foot]).filter((foot) => foot !== null);
    if (FEET.some((foot) => this.layouts[foot] !== null) || feet.some((foot) => foot.cells !== null)) return "cells";
    const walked = Object.values(this.tracks).some((points) => points.length > 1);
    return walked || (feet.length > 0 && this.t - this.start > CELLS_TIME) ? "none" : "unknown";
  }

  // True when nothing more comes: the recording is at its end, or the session has ended.
  get finished() {
    return this.playback === null ? this.over : this.playback.state === "ended";
  }

  // Number of strides of each foot, or null before any foot has sent anything: that of the foot which has more.
  get strides() {
    const feet = FEET.map((foot) => this.feet[foot]).filter((foot) => foot !== null);
    return feet.length > 0 ? Math.max(...feet.map((foot) => foot.strides || 0)) : null;
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

// Sorted by time: a phase may become known after one that started later.
function insert(phases, one) {
  let at = phases.length;
  while (at > 0 && phases[at - 1][0] > one[0]) at -= 1;
  if (at > 0 && phases[at - 1][0] === one[0]) phases[at - 1] = one;
  else phases.splice(at, 0, one);
}
