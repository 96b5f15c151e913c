// Draws the track from above, alone or on the floor plan. What does not move is kept as a picture, to which only new
// points are added while the view does not change.

import { Surface } from "./canvas.js";
import { Follower, Glide, MAX_JUMP, heading } from "./following.js";
import { Labels } from "./labels.js";
import { WEARER_RADIUS, axes, drawArea, drawCandidates, drawCross, drawFoot, drawGrid } from "./marks.js";
import { drawReport, drawRuler, drawStart, drawWearer, nameStart } from "./marks.js";
import { drawLevel, drawStops, extent, nameRooms } from "./plan.js";
import { noteAlone, noteOnPlan, spokenOnPlan, spokenTrack } from "./position.js";
import { roomAt } from "./rooms.js";
import { Still } from "./still.js";
import { theme } from "./theme.js";
import { trustOf } from "./trust.js";
import { View } from "./view.js";
import { LINES, Possibility, avoidPlaces, boxOf, dashed, drawLine, drawPlaces } from "./walked.js";
import { FEET, element, note, setData } from "./words.js";

const [EDGE_MARGIN, BUTTON_MARGIN] = [20, 56]; // px around the fitted part, and at the buttons
const CALM_INTERVAL = 25; // ms between pictures while the wearer's mark moves, and the view with it
const GLIDE_TIMES = [150, 900]; // ms, least and longest time in which the mark goes to a new place
const SPARE = 0.14; // share of the picture that is left for new parts of the track

export class Track {
  uses = ["tracks", "places", "reports", "feet", "wearer", "place", "spoilt", "findings", "links", "situation", "scene", "theme"];
  slow = 200; // ms between pictures with reduced motion
  pointing = false; // true while a person chooses a place on the drawing
  level = null; // chosen by hand; null follows the wearer
  byItself = null; // chosen by hand: true without the plan, false on it; null on it once there is a place
  feetShown = false; // chosen by hand: true draws each foot's own path as well
  whole = false; // chosen by hand: true shows the whole plan, false the part around the wearer
  following = false; // true while the view is that of the part around the wearer
  #isGliding = false;
  #follower = new Follower();
  #glide = new Glide(GLIDE_TIMES, MAX_JUMP);
  #still = new Still();
  #possibility = new Possibility();
  drawn = {}; // number of points of each line that are in the still picture

  constructor(redraw) {
    this.canvas = element("track");
    this.note = element("track-note");
    this.view = new View(this.canvas, redraw);
    this.surface = new Surface("track", () => {
      this.#measure();
      this.view.resized();
      redraw();
    });
    this.labels = new Labels(this.surface, "inset");
  }

  // What lies above the canvas, px. The fitted part excludes the note at the top, and the buttons: below, or at the right
  // where there is more room.
  #measure() {
    const { canvas, view } = this;
    const noted = this.note.offsetHeight; // 0 while hidden
    const upright = getComputedStyle(element("zoom")).flexDirection === "column";
    this.above = [...canvas.parentElement.children]
      .filter((one) => one !== canvas && one.offsetWidth > 0)
      .map((one) => [one.offsetLeft - canvas.offsetLeft, one.offsetTop - canvas.offsetTop - 4, one.offsetWidth, one.offsetHeight + 8]);
    const [edges, both, off] = [2 * EDGE_MARGIN, EDGE_MARGIN + BUTTON_MARGIN, (BUTTON_MARGIN - EDGE_MARGIN) / 2];
    this.margins = upright ? [both, edges + noted] : [edges, both + noted];
    [view.aside, view.above] = upright ? [off, -noted / 2] : [0, off - noted / 2];
  }

  get moving() {
    return this.#isGliding || !this.view.settled;
  }

  // ms between two pictures
  get interval() {
    return this.view.scaled && (this.following || this.view.settled) ? CALM_INTERVAL : 0; // 0: a person moves the view
  }

  // Everything, on the plan as on the track alone.
  all() {
    this.whole = true;
    this.view.all();
  }

  follow() {
    this.whole = false;
    this.level = null;
    this.#follower.zoom = 1;
    this.view.all();
  }

  nearer(nearer) {
    if (!this.following) return this.view.zoom(nearer);
    this.#follower.nearer(nearer);
    this.view.all();
  }

  draw(state, now) {
    if (state.generation !== this.generation) this.#scene(state);
    const onPlan = this.onPlan(state);
    const level = onPlan ? this.shown(state) : null;
    if (onPlan !== this.wasOnPlan && this.wasOnPlan !== undefined) this.view.all(true);
    if (onPlan !== this.wasOnPlan || level?.id !== this.wasLevel) this.#glide.clear();
    [this.wasOnPlan, this.wasLevel] = [onPlan, level?.id];
    this.trust = trustOf(state);
    this.#words(state, level); // written before the view is fitted beside them
    const wearer = this.#wearer(state, level, now);
    const middle = this.#look(state, level, wearer, now);
    const { x, y, scale } = this.#still.sharp(this.view.at(now), this.surface.ratio);
    const px = ([mx, my]) => [middle[0] + (mx - x) * scale, middle[1] - (my - y) * scale];
    this.shownPart = { x, y, scale, middle, level: level?.id ?? null };
    const here = level && wearer ? roomAt(level, state.place.position) : -1;
    const since = level ? this.#possibility.since(state) : 0;
    this.#drawStill(state, level, here, since);

    const context = this.surface.start();
    const { labels } = this;
    labels.ground = level ? "room" : "inset";
    labels.start();
    for (const box of this.above ?? []) labels.keep(...box);
    if (this.surface.width > 0 && this.surface.height > 0) this.#still.draw(context, this.shownPart);
    if (level) drawStops(context, labels, state.plan, level, px, scale, wearer && px(wearer));
    else nameStart(labels, px([0, 0]));
    const isAreaShown = level
      ? this.#drawPlace(context, state, level, px, scale, wearer, since)
      : this.#drawNow(context, state, px, scale, wearer);
    for (const [, of, mx, my, used] of state.reports) {
      if (of === this.shownPart.level) drawReport(context, px([mx, my]), used);
    }
    if (this.pointing) drawCross(context, middle);
    drawRuler(context, labels, this.surface, scale);
    if (level) avoidPlaces(labels, state.places, level.id, px);
    if (level) nameRooms(labels, level, px, scale, here);
    labels.finish();

    const view = level ? "plan" : "track";
    const points = level ? state.places.length : Object.values(state.tracks).reduce((sum, one) => sum + one.length, 0);
    setData(this.canvas, { view, points, level: level?.id ?? "", since });
    const possible = level !== null && state.place !== null && !state.place.decided;
    setData("track-section", { view, feet: this.feetShown, area: isAreaShown, possible, dashed: this.trust === "none" });
  }

  // What is drawn at a point of the canvas, px, or at the cross: {at: [x, y] in m, level: null alone, scale: px per m}.
  placeAt(point) {
    const { x, y, scale, middle, level } = this.shownPart;
    const [px, py] = point ?? middle;
    return { at: [x + (px - middle[0]) / scale, y - (py - middle[1]) / scale], level, scale };
  }

  onPlan({ plan, place, places }) {
    return plan !== null && !(this.byItself ?? (place === null && places.length === 0));
  }

  // Level that is shown: the chosen one, or that of the wearer.
  shown({ plan, place, places }) {
    const id = this.level ?? place?.level ?? places.at(-1)?.[1];
    return plan.levels.find((level) => level.id === id) ?? plan.levels[0];
  }

  #scene({ generation, plan }) {
    this.generation = generation;
    const drawn = JSON.stringify(plan);
    if (drawn === this.plan) return; // the same building after a seek: the view stays
    this.plan = drawn;
    this.#follower = new Follower();
    this.extent = plan && extent(plan);
    this.level = null;
    this.view.all();
  }

  // Where the wearer's mark is, m, or null: between the last place and the new one.
  #wearer({ place, wearer }, level, now) {
    const at = level === null ? wearer?.position : place?.decided && place.level === level.id ? place.position : null;
    if (at) this.#glide.aim(at.slice(0, 2), now);
    else this.#glide.clear();
    this.#isGliding = this.#glide.moving(now);
    return at ? this.#glide.at(now) : null;
  }

  // Moves the view; it does not follow while a person points at a place. Returns its middle, px.
  #look(state, level, wearer, now) {
    const { width, height } = this.surface;
    const target = level && this.#follower.target(state.place, level, wearer, now);
    this.following = Boolean(target && this.extent) && !this.whole && this.level === null && this.view.follows;
    if (!this.following) {
      const box = level && this.extent ? this.extent : boxOf(state, this.#lines());
      this.view.fit(box, width - this.margins[0], height - this.margins[1], level ? 0 : SPARE);
    } else if (width > 0 && height > 0 && !(this.pointing && this.shownPart)) {
      this.view.follow(this.#follower.part(target, this.extent, this.surface));
    }
    return [width / 2 - this.view.aside, height / 2 - this.view.above];
  }

  #lines() {
    return this.feetShown ? [...FEET, "wearer"] : ["wearer"];
  }

  #drawStill(state, level, here, since) {
    const { generation, thinned } = state;
    const key = [theme.version, generation, thinned, level?.id, since, here, this.feetShown, this.trust].join(" ");
    const layer = this.#still.begin(this.surface, this.shownPart, key);
    const { context, px, scale, size } = layer;
    if (this.#still.fresh) {
      this.drawn = { left: 0, right: 0, wearer: 0, places: 0 };
      if (level) drawLevel(context, state.plan, level, layer, here, this.extent);
      else {
        drawGrid(context, size, px([0, 0]), scale);
        drawStart(context, px([0, 0]));
      }
    }
    if (this.trust === "none") return; // a dashed line is drawn at once
    if (level) {
      const done = state.places.slice(0, -1); // the last line ends at the wearer's mark
      drawPlaces(context, done, this.drawn.places, since, level.id, px, LINES.wearer);
      this.drawn.places = done.length;
      return;
    }
    for (const name of this.#lines()) {
      const points = name === "wearer" ? state.tracks.wearer.slice(0, -1) : state.tracks[name];
      const from = Math.max(0, this.drawn[name] - 1);
      if (points.length > from + 1) drawLine(context, points.slice(from), px, LINES[name]);
      this.drawn[name] = points.length;
    }
  }

  // Draws what moves on the track alone; the wearer's mark is at `at`, m. Returns whether it drew an area.
  #drawNow(context, { feet, wearer, tracks }, px, scale, at) {
    const wrong = this.trust === "none";
    for (const name of wrong ? this.#lines() : []) drawLine(context, tracks[name], px, dashed(LINES[name]));
    let isAreaShown = false;
    if (wearer?.covariance && !wrong) {
      const { long, wide, angle } = axes(wearer.covariance);
      const area = { long: long * scale, wide: wide * scale, angle };
      isAreaShown = drawArea(context, px(at), area, this.trust === "old"); // they move together
    }
    for (const foot of this.feetShown ? FEET : []) {
      const place = feet[foot]?.position;
      if (!place) continue;
      const last = tracks[foot].at(-1); // a track has the strides that ended; the present one has not
      if (last) drawLine(context, [last, [0, ...place]], px, LINES[foot]);
      const off = at ? Math.hypot(...[0, 1].map((k) => (place[k] - at[k]) * scale)) : Infinity;
      if (off > 2 * WEARER_RADIUS + 4) drawFoot(context, foot, px(place)); // else the wearer's dot is over it
    }
    const last = tracks.wearer.at(-2);
    if (at && last && !wrong) drawLine(context, [last, [0, ...at]], px, LINES.wearer);
    if (at) this.#drawMark(context, px(at), tracks.wearer.map((point) => point.slice(1)));
    return isAreaShown;
  }

  // The same on the plan.
  #drawPlace(context, { place, places }, level, px, scale, at, since) {
    if (place && !place.decided) drawCandidates(context, this.labels, place.candidates, level.id, px);
    if (!at) return false;
    const wrong = this.trust === "none";
    const radius = place.spread * scale;
    const area = { long: radius, wide: radius, angle: 0 };
    const isAreaShown = place.spread !== null && !wrong && drawArea(context, px(at), area, this.trust === "old");
    const newest = places.at(-1); // it may be older than the mark
    const end = newest && newest[2] === place.position[0] && newest[3] === place.position[1] ? places.length - 1 : places.length;
    const from = wrong ? 0 : Math.max(0, places.length - 2);
    const tail = [...places.slice(from, end), [0, level.id, ...at]];
    drawPlaces(context, tail, 1, Math.max(0, since - from), level.id, px, wrong ? dashed(LINES.wearer) : LINES.wearer);
    this.#drawMark(context, px(at), places.slice(-6).filter(([, of]) => of === level.id).map((point) => point.slice(2)));
    return isAreaShown;
  }

  // The wearer's mark, which points where the last points [x, y] lead.
  #drawMark(context, mark, points) {
    drawWearer(context, mark, points.length > 1 ? heading(points) : null);
    this.labels.keepAround(mark, 2 * WEARER_RADIUS);
  }

  #words(state, level) {
    const words = level ? noteOnPlan(state, level) : noteAlone(state, this.feetShown);
    if (words !== this.noted) {
      const before = this.note.offsetHeight;
      note(this.note, words);
      this.noted = words;
      if (this.note.offsetHeight !== before) {
        this.#measure();
        this.view.resized();
      }
    }
    this.surface.setText(() => (level ? spokenOnPlan(state, level) : spokenTrack(state)));
  }
}
