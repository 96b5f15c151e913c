// The state that results from the messages of protocol/page.md. Nothing here draws. Limits were chosen by hand and not swept.

import { FEET } from "./words.js";

const MAX_POINTS = 2000; // points of a track
const PHASE_HISTORY = 20; // s of phases
const MAX_ITEMS = { log: 50, reports: 100 };
const MAX_TRAIL_POINTS = 240; // points of a centre of pressure's path
const CELLS_TIME = 1; // s after the start within which cells of an insole have sent, if there are any

// Members that a frame sends whole, and those of which it sends what is new.
const OF_THE_WEARER = ["feet", "wearer", "place", "activity", "pace", "support", "touchdown", "body", "fused", "gait", "total"];
const VALUES = ["t", ...OF_THE_WEARER, "scales", "spoilt", "findings", "links", "playback", "posture"];
const LISTS = ["tracks", "places", "phases", "log", "reports"];

export class State {
  known = false; // a scene came
  generation = 0; // number of scenes that came
  situation = "computing"; // situation.js
  // What the program behind the page says of itself. The site also says: walk, {resumed} or null while none is measured;
  // sensors, [{name, connected}]; whether there is Bluetooth, and why there is none; what is computed; why a sensor was
  // refused; whether the walk that was measured last is stored; free, while it starts and nobody waits for it.
  program = { link: "connecting", free: false, walk: {}, sensors: null, bluetooth: true, why: "", task: "", refusal: "", kept: false };

  constructor() {
    for (const name of VALUES) this[name] = null;
    this.#empty();
    Object.assign(this, { t: 0, title: "", recipe: "", source: "", plan: null, links: {}, findings: [], spoilt: [] });
  }

  // Whether there are pressure cells: "cells", "none", or "unknown" while too little has come to say it.
  get soles() {
    const feet = Object.values(this.feet).filter(Boolean);
    if (FEET.some((foot) => this.layouts[foot] !== null) || feet.some(({ cells }) => cells !== null)) return "cells";
    const walked = Object.values(this.tracks).some((points) => points.length > 1);
    return walked || (feet.length > 0 && this.t - this.start > CELLS_TIME) ? "none" : "unknown";
  }

  // True when nothing more comes: the recording is at its end, or the session has ended.
  get finished() {
    return this.situation === "finished";
  }

  // Number of strides of each foot, or null before any foot has sent anything: that of the foot which has more.
  get strides() {
    const feet = Object.values(this.feet).filter(Boolean);
    return feet.length > 0 ? Math.max(...feet.map(({ strides }) => strides)) : null;
  }

  // The track that is shown where one is enough: [t, x, y, z] of the wearer, or of a foot if it has none.
  get track() {
    const { wearer, left, right } = this.tracks;
    return [wearer, left, right].find((points) => points.length > 1) ?? [];
  }

  // Returns the names of what changed; a message of an unknown type changes nothing.
  take(message) {
    if (message.type === "scene") return this.#scene(message).add("scene");
    return message.type === "frame" && this.known ? this.#frame(message) : new Set();
  }

  #scene({ title, recipe, source, control, plan, layouts, frame, ...lists }) {
    this.known = true;
    this.generation += 1;
    Object.assign(this, { title, recipe, source, control, layouts, plan: plan?.levels.length ? plan : null });
    for (const level of this.plan?.levels ?? []) level.name ||= level.id;
    this.#empty();
    return this.#frame({ ...frame, ...lists });
  }

  #empty() {
    this.start = null; // session time that is shown as 0:00, s; null before anything was received
    this.feet = {};
    this.trails = { left: [], right: [] };
    this.phases = { left: [], right: [] };
    this.tracks = { left: [], right: [], wearer: [] };
    this.thinned = 0; // how often a track lost points, after which it must be drawn again
    this.places = [];
    this.log = [];
    this.reports = [];
  }

  #frame(message) {
    const changed = new Set([...VALUES, ...LISTS].filter((name) => name in message));
    const { feet: before } = this;
    for (const name of VALUES) if (changed.has(name)) this[name] = message[name];
    if (changed.has("feet")) for (const foot of FEET) this.#foot(foot, before[foot]);
    for (const [foot, phases] of Object.entries(message.phases ?? {})) {
      const known = this.phases[foot];
      known.push(...phases);
      const recent = known.findIndex(([t]) => t > this.t - PHASE_HISTORY);
      if (recent > 1) known.splice(0, recent - 1); // the one before still lasts into the window
    }
    for (const [name, points] of Object.entries(message.tracks ?? {})) this.#extend(this.tracks[name], points);
    this.#extend(this.places, message.places ?? []);
    for (const [name, most] of Object.entries(MAX_ITEMS)) {
      if (changed.has(name)) this[name] = [...this[name], ...message[name]].slice(-most);
    }
    this.#setStart();
    return changed;
  }

  // A recording states its start. A live session starts at the first known time, on a clock with any origin.
  #setStart() {
    if (this.playback !== null) this.start = this.playback.begin;
    else if (this.start === null && this.t !== 0) {
      const firsts = [...Object.values(this.tracks), ...Object.values(this.phases), this.log].flatMap((some) => some.slice(0, 1));
      this.start = Math.min(this.t, ...firsts.map(([t]) => t));
    }
  }

  #foot(foot, before) {
    const one = this.feet[foot];
    if (one === null) return;
    if (one.cells !== null) one.cells = Uint8Array.from(atob(one.cells), (letter) => letter.charCodeAt(0));
    const trail = this.trails[foot];
    if (one.centre === null) return; // in the air the path of the last stance stays
    if (!before?.centre) trail.length = 0;
    trail.push(one.centre);
    if (trail.length > MAX_TRAIL_POINTS) trail.shift();
  }

  #extend(points, news) {
    for (const point of news) {
      points.push(point);
      if (points.length <= MAX_POINTS) continue;
      points.splice(0, points.length, ...points.filter((_, i) => i % 2 === 0));
      this.thinned += 1;
    }
  }
}
