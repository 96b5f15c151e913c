// Draws the track from above, alone or on the floor plan. What does not move is kept as a picture, to which only new
// points are added while the view does not change.

import { Alternative, Surface, reducedMotion } from "./canvas.js";
import {
  axes,
  drawCandidates,
  drawCross,
  drawDot,
  drawEllipse,
  drawFoot,
  drawGrid,
  drawReport,
  drawRing,
  drawRuler,
  drawSpread,
  drawStart,
  stroke,
  sure,
} from "./marks.js";
import { drawLevel, extent } from "./plan.js";
import { Possibility } from "./possibility.js";
import { noteAlone, noteOnPlan, spokenOnPlan, spokenTrack } from "./position.js";
import { FEET } from "./state.js";
import { theme } from "./theme.js";
import { View } from "./view.js";
import { show, setData, write } from "./words.js";

const MIN_EXTENT = 3; // m, least width and height that are shown
const [EDGE_MARGIN, BUTTON_MARGIN] = [20, 56]; // px around the fitted part, and at the buttons
const MAX_PLACE_JUMP = 5; // m between two places; above it another candidate became the likeliest, without a walk there
const SLOW_INTERVAL = 200; // ms between pictures with reduced motion
const LINE_WIDTHS = { left: 1.25, right: 1.25, wearer: 3.25 };

export class Track {
  uses = ["tracks", "places", "reports", "feet", "wearer", "place", "scene", "theme"];
  pointing = false; // true while a person chooses a place on the drawing
  level = null; // chosen by hand; null follows the wearer
  byItself = null; // chosen by hand: true without the plan, false on it; null on it once there is a place

  constructor(redraw) {
    const canvas = document.getElementById("track");
    this.canvas = canvas;
    this.note = document.getElementById("track-note");
    this.layer = document.createElement("canvas");
    this.view = new View(canvas, redraw);
    this.surface = new Surface(canvas, () => {
      this.#room();
      this.view.resized();
      redraw();
    });
    this.alternative = new Alternative(canvas);
    this.section = document.getElementById("track-section");
    this.possibility = new Possibility();
    this.key = "";
    this.drawnAt = 0;
  }

  // The fitted part excludes the note at the top, and the buttons: below, or at the right where there is more room.
  #room() {
    const noted = this.note.offsetHeight; // 0 while hidden
    const upright = getComputedStyle(document.getElementById("zoom")).flexDirection === "column";
    const both = EDGE_MARGIN + BUTTON_MARGIN;
    this.margins = upright ? [both, 2 * EDGE_MARGIN + noted] : [2 * EDGE_MARGIN, both + noted];
    this.view.aside = upright ? (BUTTON_MARGIN - EDGE_MARGIN) / 2 : 0;
    this.view.above = (upright ? 0 : (BUTTON_MARGIN - EDGE_MARGIN) / 2) - noted / 2;
  }

  get moving() {
    return !this.view.settled;
  }

  draw(state, now, changed) {
    if (reducedMotion.matches && now - this.drawnAt < SLOW_INTERVAL && !changed.has("theme")) return "later";
    this.drawnAt = now;
    if (changed.has("scene") && state.generation !== this.generation) this.#scene(state);
    const onPlan = this.onPlan(state);
    if (onPlan !== this.wasOnPlan && this.wasOnPlan !== undefined) this.view.all();
    this.wasOnPlan = onPlan;
    const level = onPlan ? this.shown(state) : null;
    this.#words(state, onPlan, level); // written before the view is fitted beside them
    const { width, height } = this.surface;
    const box = onPlan && this.extent ? this.extent : this.#box(state);
    this.view.fit(box, width - this.margins[0], height - this.margins[1], onPlan ? 0 : 0.14);
    const { x, y, scale } = this.view.at(now);
    const middle = [width / 2 - this.view.aside, height / 2 - this.view.above];
    const px = ([mx, my]) => [middle[0] + (mx - x) * scale, middle[1] - (my - y) * scale];

    this.shownPart = { x, y, scale, middle, level: level?.id ?? null };
    this.#still(state, level, px, scale, `${x} ${y}`);
    const context = this.surface.start();
    if (this.layer.width > 0 && this.layer.height > 0) context.drawImage(this.layer, 0, 0, width, height);
    if (onPlan) this.#place(context, state, level, px, scale);
    else this.#now(context, state, px, scale);
    for (const one of state.reports) {
      if (one.level === this.shownPart.level) drawReport(context, px([one.x, one.y]), one.used);
    }
    if (this.pointing) drawCross(context, middle);
    drawRuler(context, this.surface, scale);

    const view = onPlan ? "plan" : "track";
    const points = onPlan ? state.places.length : Object.values(state.tracks).reduce((sum, one) => sum + one.length, 0);
    setData(this.canvas, { view, points, level: level?.id ?? "", since: onPlan ? this.possibility.since(state) : 0 });
    setData(this.section, { view });
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
    this.extent = state.plan && extent(state.plan);
    this.level = null;
    this.view.all();
  }

  #box({ tracks, feet, wearer }) {
    const box = [0, 0, 0, 0];
    const hold = (x, y) => {
      if (x < box[0]) box[0] = x;
      if (y < box[1]) box[1] = y;
      if (x > box[2]) box[2] = x;
      if (y > box[3]) box[3] = y;
    };
    for (const points of Object.values(tracks)) for (const point of points) hold(point[1], point[2]);
    for (const foot of FEET) if (feet[foot]?.position) hold(feet[foot].position[0], feet[foot].position[1]);
    if (wearer?.covariance) {
      // as much of the uncertainty as leaves the track large enough to see
      const most = 0.25 * Math.max(MIN_EXTENT, box[2] - box[0], box[3] - box[1]);
      const [x, y] = wearer.position;
      const [dx, dy] = [0, 3].map((k) => Math.min(most, sure(wearer.covariance[k])));
      hold(x - dx, y - dy);
      hold(x + dx, y + dy);
    }
    for (const k of [0, 1]) {
      const lacks = Math.max(0, MIN_EXTENT - (box[k + 2] - box[k])) / 2;
      box[k] -= lacks;
      box[k + 2] += lacks;
    }
    return box;
  }

  #still(state, level, px, scale, where) {
    const { width, height, ratio } = this.surface;
    const { generation, thinned } = state;
    const since = level ? this.possibility.since(state) : 0;
    const key = [where, scale, width, height, ratio, theme.version, generation, thinned, level?.id, since].join(" ");
    const context = this.layer.getContext("2d");
    if (key !== this.key) {
      this.key = key;
      [this.layer.width, this.layer.height] = [Math.round(width * ratio), Math.round(height * ratio)];
      this.drawn = { left: 0, right: 0, wearer: 0, places: 0 };
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const blank = Object.values(this.drawn).every((count) => count === 0);
    if (level) {
      if (blank) drawLevel(context, state.plan, level, px, scale);
      this.#walked(context, state.places, since, level.id, px);
      return;
    }
    if (blank) {
      drawGrid(context, this.surface, px([0, 0]), scale);
      drawStart(context, px([0, 0]));
    }
    for (const [name, points] of Object.entries(state.tracks)) {
      const from = Math.max(0, this.drawn[name] - 1);
      if (points.length > from + 1) line(context, points.slice(from), px, LINE_WIDTHS[name], theme.colours[name]);
      this.drawn[name] = points.length;
    }
  }

  // Only a line between two places on this level is solid. Before the index `since` the track of a rejected candidate
  // is dashed.
  #walked(context, places, since, level, px) {
    const paths = { here: new Path2D(), elsewhere: new Path2D(), before: new Path2D() };
    for (let i = Math.max(1, this.drawn.places); i < places.length; i++) {
      const [[, a, x1, y1], [, b, x2, y2]] = [places[i - 1], places[i]];
      const here = a === level && b === level;
      if (Math.hypot(x2 - x1, y2 - y1) > MAX_PLACE_JUMP || i === since || (i < since && !here)) continue;
      const path = paths[i < since ? "before" : here ? "here" : "elsewhere"];
      path.moveTo(...px([x1, y1]));
      path.lineTo(...px([x2, y2]));
    }
    context.setLineDash([2, 5]);
    stroke(context, paths.before, 1.5, theme.colours["sole-line"]);
    context.setLineDash([]);
    stroke(context, paths.elsewhere, 1.5, theme.colours["sole-line"]);
    stroke(context, paths.here, LINE_WIDTHS.wearer, theme.colours.wearer);
    this.drawn.places = places.length;
  }

  #now(context, { feet, wearer, tracks }, px, scale) {
    if (wearer?.covariance) drawEllipse(context, px(wearer.position), axes(wearer.covariance), scale);
    for (const foot of FEET) {
      const place = feet[foot]?.position;
      if (!place) continue;
      const last = tracks[foot].at(-1); // a track has the strides that ended; the present one has not
      if (last) line(context, [last, [0, ...place]], px, LINE_WIDTHS[foot], theme.colours[foot]);
      drawFoot(context, foot, px(place));
    }
    if (wearer) drawRing(context, px(wearer.position));
  }

  #place(context, { place }, level, px, scale) {
    if (!place) return;
    if (!place.decided) drawCandidates(context, place.candidates, level.id, px);
    else if (place.level === level.id) {
      if (place.spread !== null) drawSpread(context, px(place.position), place.spread * scale);
      drawDot(context, px(place.position));
    }
  }

  #words(state, onPlan, level) {
    const words = onPlan ? noteOnPlan(state, level) : noteAlone(state);
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

// Consecutive points on the same pixel are drawn as one.
function line(context, points, px, width, colour) {
  const path = new Path2D();
  let [lastX, lastY] = [Infinity, Infinity];
  points.forEach(([, mx, my], i) => {
    const [x, y] = px([mx, my]);
    if (i < points.length - 1 && Math.abs(x - lastX) < 0.8 && Math.abs(y - lastY) < 0.8) return;
    if (lastX === Infinity) path.moveTo(x, y);
    else path.lineTo(x, y);
    [lastX, lastY] = [x, y];
  });
  stroke(context, path, width, colour);
}
