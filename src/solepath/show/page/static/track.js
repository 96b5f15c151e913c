// Draws the track from above, alone or on the floor plan. What does not move is kept as a picture, to which only new
// points are added while the view does not change.

import { Alternative, Surface, reducedMotion } from "./canvas.js";
import { Follower, Glide, heading } from "./following.js";
import { Labels } from "./labels.js";
import { Legend } from "./legend.js";
import { WEARER_RADIUS, axes, drawCandidates, drawCross, drawEllipse, drawFoot, drawGrid } from "./marks.js";
import { drawReport, drawRuler, drawSpread, drawStart, drawWearer, nameStart } from "./marks.js";
import { coveredStop, drawLevel, extent, nameCovered, nameLevel } from "./plan.js";
import { Possibility } from "./possibility.js";
import { noteAlone, noteOnPlan, spokenOnPlan, spokenTrack } from "./position.js";
import { roomAt } from "./rooms.js";
import { FEET } from "./state.js";
import { Still } from "./still.js";
import { theme } from "./theme.js";
import { View } from "./view.js";
import { trustOf } from "./trust.js";
import { DASH, avoidPlaces, boxOf, drawLine, drawPlaces } from "./walked.js";
import { show, setData, write } from "./words.js";

const [EDGE_MARGIN, BUTTON_MARGIN] = [20, 56]; // px around the fitted part, and at the buttons
const SLOW_INTERVAL = 200; // ms between pictures with reduced motion
const CALM_INTERVAL = 25; // ms between pictures while the wearer's mark moves, and the view with it
const LINE_WIDTHS = { left: 1.5, right: 1.5, wearer: 4 };

export class Track {
  uses = ["tracks", "places", "reports", "feet", "wearer", "place", "findings", "links", "scene", "theme"];
  pointing = false; // true while a person chooses a place on the drawing
  level = null; // chosen by hand; null follows the wearer
  byItself = null; // chosen by hand: true without the plan, false on it; null on it once there is a place
  feetShown = false; // chosen by hand: true draws each foot's own path as well
  whole = false; // chosen by hand: true shows the whole plan, false the part around the wearer
  following = false; // true while the view is that of the part around the wearer
  #moving = false;
  #follower = new Follower();

  constructor(redraw) {
    const canvas = document.getElementById("track");
    this.canvas = canvas;
    this.note = document.getElementById("track-note");
    this.still = new Still();
    this.labels = new Labels(canvas, "inset");
    this.glide = new Glide();
    this.view = new View(canvas, redraw);
    this.surface = new Surface(canvas, () => {
      this.#room();
      this.view.resized();
      redraw();
    });
    this.alternative = new Alternative(canvas);
    this.possibility = new Possibility();
    this.legend = new Legend(document.getElementById("track-section"));
    this.drawnAt = 0;
  }

  // What lies above the canvas, px. The fitted part excludes the note at the top, and the buttons: below, or at the right where there is more room.
  #room() {
    const noted = this.note.offsetHeight; // 0 while hidden
    const upright = getComputedStyle(document.getElementById("zoom")).flexDirection === "column";
    const both = EDGE_MARGIN + BUTTON_MARGIN;
    this.above = [...this.canvas.parentElement.children]
      .filter((one) => one !== this.canvas && one.offsetWidth > 0)
      .map((one) => [one.offsetLeft - this.canvas.offsetLeft, one.offsetTop - this.canvas.offsetTop, one.offsetWidth, one.offsetHeight]);
    this.margins = upright ? [both, 2 * EDGE_MARGIN + noted] : [2 * EDGE_MARGIN, both + noted];
    this.view.aside = upright ? (BUTTON_MARGIN - EDGE_MARGIN) / 2 : 0;
    this.view.above = (upright ? 0 : (BUTTON_MARGIN - EDGE_MARGIN) / 2) - noted / 2;
  }

  get moving() {
    return this.#moving || !this.view.settled;
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

  draw(state, now, changed) {
    if (reducedMotion.matches && now - this.drawnAt < SLOW_INTERVAL && !changed.has("theme")) return "later";
    const calm = this.view.scaled && (this.following || this.view.settled); // no person moves the view
    if (calm && now - this.drawnAt < CALM_INTERVAL && !changed.has("theme") && !changed.has("scene")) return "later";
    this.drawnAt = now;
    if (changed.has("scene") && state.generation !== this.generation) this.#scene(state);
    const onPlan = this.onPlan(state);
    const level = onPlan ? this.shown(state) : null;
    if (onPlan !== this.wasOnPlan && this.wasOnPlan !== undefined) this.view.all(true);
    if (onPlan !== this.wasOnPlan || level?.id !== this.wasLevel) this.glide.clear();
    [this.wasOnPlan, this.wasLevel] = [onPlan, level?.id];
    this.trust = trustOf(state);
    this.#words(state, onPlan, level); // written before the view is fitted beside them
    const wearer = this.#wearer(state, level, now);
    const middle = this.#look(state, level, wearer, now);
    const { width, height, ratio } = this.surface;
    const { x, y, scale } = this.still.sharp(this.view.at(now), ratio);
    const px = ([mx, my]) => [middle[0] + (mx - x) * scale, middle[1] - (my - y) * scale];

    this.shownPart = { x, y, scale, middle, level: level?.id ?? null };
    const here = onPlan && wearer ? roomAt(level, state.place.position) : -1;
    const covered = onPlan && wearer ? coveredStop(state.plan, level, wearer, scale) : -1;
    this.#still(state, level, this.shownPart, here, covered);
    const context = this.surface.start();
    this.#labels(px, onPlan);
    this.area = false;
    if (width > 0 && height > 0) this.still.draw(context, this.surface, this.shownPart, middle);
    if (onPlan) this.#place(context, state, level, px, scale, wearer);
    else this.#now(context, state, px, scale, wearer);
    for (const one of state.reports) {
      if (one.level === this.shownPart.level) drawReport(context, px([one.x, one.y]), one.used);
    }
    if (this.pointing) drawCross(context, middle);
    drawRuler(context, this.labels, this.surface, scale);
    if (onPlan) avoidPlaces(this.labels, state.places, level.id, px);
    if (onPlan) nameLevel(this.labels, state.plan, level, px, scale, here, covered);
    if (covered >= 0) nameCovered(context, this.labels, state.plan, level, covered, px(wearer), scale);
    this.labels.finish(context);

    const view = onPlan ? "plan" : "track";
    const points = onPlan ? state.places.length : Object.values(state.tracks).reduce((sum, one) => sum + one.length, 0);
    setData(this.canvas, { view, points, level: level?.id ?? "", since: onPlan ? this.possibility.since(state) : 0 });
    const possible = onPlan && state.place !== null && !state.place.decided;
    this.legend.draw({ view, feetShown: this.feetShown, area: this.area, possible, dashed: this.trust === "none" });
    return "done";
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

  #scene(state) {
    this.generation = state.generation;
    const drawn = JSON.stringify(state.plan);
    if (drawn === this.plan) return; // the same building after a seek: the view stays
    this.plan = drawn;
    this.#follower = new Follower();
    this.extent = state.plan && extent(state.plan);
    this.level = null;
    this.view.all();
  }

  // Where the wearer's mark is, m, or null: between the last place and the new one.
  #wearer({ place, wearer }, level, now) {
    const at = level === null ? wearer?.position : place?.decided && place.level === level.id ? place.position : null;
    this.#moving = false;
    if (!at) return this.glide.clear() ?? null;
    this.glide.aim(at, now);
    this.#moving = this.glide.moving(now);
    return this.glide.at(now);
  }

  // Moves the view; it does not follow while a person points at a place. Returns its middle, px.
  #look(state, level, wearer, now) {
    const { width, height } = this.surface;
    const target = level && this.#follower.target(state.place, level, wearer, now);
    this.following = Boolean(target && this.extent) && !this.whole && this.level === null && this.view.follows;
    if (!this.following) {
      const box = level && this.extent ? this.extent : boxOf(state, this.feetShown);
      this.view.fit(box, width - this.margins[0], height - this.margins[1], level ? 0 : 0.14);
    } else if (width > 0 && height > 0 && !(this.pointing && this.shownPart)) {
      this.view.follow(this.#follower.part(target, this.extent, this.surface));
    }
    return [width / 2 - this.view.aside, height / 2 - this.view.above];
  }

  // No label lies below the note and the buttons.
  #labels(px, onPlan) {
    const { labels } = this;
    labels.start(this.surface);
    labels.ground = onPlan ? "room" : "inset";
    for (const [x, y, width, height] of this.above ?? []) labels.keep(x, y - 4, width, height + 8);
    if (!onPlan) nameStart(labels, px([0, 0]));
  }

  #still(state, level, part, here, covered) {
    const { generation, thinned } = state;
    const since = level ? this.possibility.since(state) : 0;
    const key = [theme.version, generation, thinned, level?.id, since, here, covered, this.feetShown, this.trust].join(" ");
    const layer = this.still.begin(this.surface, part, part.middle, key, this.view.scaled);
    const { context, px, scale, size } = layer;
    if (this.still.fresh) this.drawn = { left: 0, right: 0, wearer: 0, places: 0 };
    if (level) {
      if (this.still.fresh) drawLevel(context, state.plan, level, layer, here, this.extent, covered);
      if (this.trust === "none") return; // a dashed line is drawn at once
      const done = state.places.slice(0, -1); // the last line ends at the wearer's mark
      drawPlaces(context, done, this.drawn.places, since, level.id, px, LINE_WIDTHS.wearer);
      this.drawn.places = done.length;
      return;
    }
    if (this.still.fresh) {
      drawGrid(context, { width: size[0], height: size[1] }, px([0, 0]), scale);
      drawStart(context, px([0, 0]));
    }
    for (const name of this.trust === "none" ? [] : this.#lines()) {
      const points = name === "wearer" ? state.tracks.wearer.slice(0, -1) : state.tracks[name];
      const from = Math.max(0, this.drawn[name] - 1);
      if (points.length > from + 1) drawLine(context, points.slice(from), px, LINE_WIDTHS[name], theme.colours[name]);
      this.drawn[name] = points.length;
    }
  }

  #lines() {
    return this.feetShown ? [...FEET, "wearer"] : ["wearer"];
  }

  #now(context, { feet, wearer, tracks }, px, scale, at) {
    if (this.trust === "none") {
      for (const name of this.#lines()) drawLine(context, tracks[name], px, LINE_WIDTHS[name], theme.colours[name], DASH);
    } else if (wearer?.covariance) {
      this.area = drawEllipse(context, px(wearer.position), axes(wearer.covariance), scale, this.trust === "old");
    }
    for (const foot of this.feetShown ? FEET : []) {
      const place = feet[foot]?.position;
      if (!place) continue;
      const last = tracks[foot].at(-1); // a track has the strides that ended; the present one has not
      if (last) drawLine(context, [last, [0, ...place]], px, LINE_WIDTHS[foot], theme.colours[foot]);
      const off = at ? Math.hypot(...[0, 1].map((k) => (place[k] - at[k]) * scale)) : Infinity;
      if (off > 2 * WEARER_RADIUS + 4) drawFoot(context, foot, px(place)); // else the wearer's dot is over it
    }
    if (!at) return;
    const last = tracks.wearer.at(-2);
    if (last && this.trust !== "none") drawLine(context, [last, [0, ...at]], px, LINE_WIDTHS.wearer, theme.colours.wearer);
    this.#mark(context, px(at), heading(tracks.wearer.slice(-6).map((point) => point.slice(1))));
  }

  #place(context, { place, places, tracks, generation, thinned }, level, px, scale, at) {
    if (!place) return;
    if (!place.decided) drawCandidates(context, this.labels, place.candidates, level.id, px);
    if (!at) return;
    const wrong = this.trust === "none";
    if (place.spread !== null && !wrong) this.area = drawSpread(context, px(at), place.spread * scale, this.trust === "old");
    const last = places.slice(-6).filter(([, of]) => of === level.id);
    const since = this.possibility.since({ places, tracks, generation, thinned });
    const newest = places.at(-1); // it may be older than the mark
    const end = newest && newest[2] === place.position[0] && newest[3] === place.position[1] ? places.length - 1 : places.length;
    const tail = [...places.slice(wrong ? 0 : Math.max(0, places.length - 2), end), [0, level.id, ...at]];
    const gone = Math.max(0, since - (end - tail.length + 1));
    drawPlaces(context, tail, 1, gone, level.id, px, LINE_WIDTHS.wearer, wrong ? DASH : []);
    this.#mark(context, px(at), last.length > 1 ? heading(last.map((point) => point.slice(2))) : null);
  }

  #mark(context, [x, y], direction) {
    drawWearer(context, [x, y], direction);
    const reach = 2 * WEARER_RADIUS;
    this.labels.keep(x - reach, y - reach, 2 * reach, 2 * reach);
  }

  #words(state, onPlan, level) {
    const words = onPlan ? noteOnPlan(state, level) : noteAlone(state, this.feetShown);
    if (words !== this.noted) {
      const before = this.note.offsetHeight;
      write(this.note, words);
      show(this.note, words !== "");
      if (this.note.offsetHeight !== before) {
        this.#room();
        this.view.resized();
      }
      this.noted = words;
    }
    this.alternative.setText(() => (onPlan ? spokenOnPlan(state, level) : spokenTrack(state)));
  }
}
