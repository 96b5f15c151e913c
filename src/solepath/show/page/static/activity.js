// What is looked at first: what the wearer does and where, and four figures; of the whole walk once it has ended.

import { whereOf } from "./position.js";
import { ACTIVITIES, SUPPORTS, describe, activityText, capital, fixed, wordOf, show, span, setData, write } from "./words.js";

const EVEN = 0.02; // asymmetry of the time on the ground below which the feet are alike, as far as is known (docs/page.md)
const FIGURES = ["speed", "cadence", "symmetry", "distance"];

export class ActivityPanel {
  uses = ["activity", "support", "pace", "feet", "gait", "total", "place", "wearer", "links", "playback", "scene", "second"];

  constructor() {
    for (const id of ["activity", "since", "support", "where", "first", "strides", "symmetry-words", "speed-label", "cadence-label", ...FIGURES])
      this[id] = document.getElementById(id);
    this.figures = Object.fromEntries(FIGURES.map((name) => [name, document.getElementById(`figure-${name}`)]));
    this.list = document.getElementById("figures");
    this.icon = document.getElementById("activity-icon");
    this.supportWord = document.getElementById("support-word");
  }

  draw(state) {
    const { activity, support, finished } = state;
    const name = finished ? "FINISHED" : (activity?.now ?? "UNKNOWN");
    const silent = !finished && activity !== null && activity.last !== null;
    write(this.activity, headline(state));
    setData(this.activity, { activity: name, known: !silent });
    describe(this.icon, "href", `#icon-${Object.hasOwn(ACTIVITIES, name) || finished ? name : "UNKNOWN"}`);
    const dated = !finished && state.strides !== null && activity?.since != null && activity.since >= state.start;
    const since = dated ? `for ${span(state.t - activity.since)}` : "";
    write(this.since, silent ? `no data from any foot ${since}` : since);
    write(this.where, where(state));
    write(this.first, first(state));
    setData(this.support, { support: finished ? "" : (support ?? "") });
    write(this.supportWord, support ? wordOf(SUPPORTS, support) : "not known");
    this.#figures(state);
    return "done";
  }

  #figures(state) {
    const { finished, pace, total } = state;
    const { cadence, speed } = (finished ? total : pace) ?? {};
    const stance = finished ? (total?.stance ?? null) : asymmetryOf(state.gait, "stance_time");
    const { strides } = state;
    setData(this.list, { known: strides > 0 });
    const even = stance !== null && Math.abs(stance) <= EVEN;
    const shares = `${fixed(100 * Math.abs(stance ?? NaN), even ? 1 : 0)} %`;
    this.#figure("speed", fixed(speed ?? NaN, 2));
    this.#figure("cadence", fixed(cadence ?? NaN));
    this.#figure("symmetry", stance === null ? "–" : even ? "even" : shares);
    write(this["symmetry-words"], stance === null ? "" : even ? `${shares} apart` : `${stance < 0 ? "left" : "right"} longer`);
    this.#figure("distance", strides > 0 ? fixed(state.distance, state.distance < 99.95 ? 1 : 0) : "–");
    write(this.strides, strides === null ? "–" : String(strides));
    for (const what of ["speed", "cadence"]) write(this[`${what}-label`], finished ? `mean ${what}` : what);
  }

  #figure(name, words) {
    write(this[name], words);
    setData(this.figures[name], { now: words !== "–" });
  }
}

function headline({ activity, finished, strides }) {
  if (finished && strides !== null) return "Finished";
  if (activity === null || strides === null) return "Waiting";
  if (strides === 0 && activity.last === null && activity.now === "UNKNOWN") return "Ready";
  return activityText(activity);
}

function where(state) {
  const { finished, strides, place, plan, wearer, links } = state;
  if (strides === null) return Object.keys(links).length > 0 ? "for the first data" : "for the sensors";
  if (finished) return summary(state);
  if (plan !== null && place !== null) {
    return place.decided ? capital(whereOf(plan, place)) : `${place.candidates.length} possible places`;
  }
  if (strides === 0) return "at the start";
  return wearer === null ? "" : `${fixed(Math.hypot(wearer.position[0], wearer.position[1]))} m from the start`;
}

// What is still missing, in place of the figures.
function first({ strides, finished, source, links }) {
  if (strides > 0) return "";
  if (finished) return "No stride was found.";
  if (strides === 0) return "Stand still for a moment, then walk. The figures come with the first strides.";
  if (source !== "live") return "It starts in a moment.";
  if (Object.keys(links).length > 0) return "The sensors are found. Their data come in a moment.";
  return "No sensor is connected yet. Switch them on, and keep them near.";
}

// The whole walk in a sentence.
export function summary(state) {
  const { strides, playback } = state;
  const seconds = playback === null ? state.t - state.start : playback.end - playback.start;
  if (!(strides > 0)) return `No stride in ${span(seconds)}`;
  return `${fixed(state.distance)} m in ${span(seconds)}, ${strides} strides`;
}

const asymmetryOf = (gait, name) => gait?.rows.find((row) => row.name === name && Number.isFinite(row.asymmetry))?.asymmetry ?? null;
