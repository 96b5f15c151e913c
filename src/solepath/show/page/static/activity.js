// What is looked at first: what the wearer does and where, and four figures; of the whole walk once it has ended.

import { nameOf, whereOf } from "./position.js";
import { mostDifferent } from "./rows.js";
import { distance, isWrong, means, sidesKnown, sourceWords, unsound } from "./sound.js";
import { ACTIVITIES, SUPPORTS, describe, activityText, capital, fixed, wordOf, show, span, setData, write } from "./words.js";

const LIFTS = ["ELEVATOR_UP", "ELEVATOR_DOWN"];
const FIGURES = ["speed", "cadence", "symmetry", "distance"];

export class ActivityPanel {
  uses = ["activity", "support", "pace", "feet", "gait", "total", "findings", "place", "wearer", "links", "playback", "scene", "second"];

  constructor() {
    for (const id of ["activity", "since", "support", "where", "first", "strides", "symmetry-words", "speed-label", "cadence-label", "symmetry-label", ...FIGURES])
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
    const source = state.strides > 0 && !silent ? sourceWords(state) : "";
    write(this.since, silent ? `no data from any foot ${since}` : [since, source].filter(Boolean).join(" · "));
    write(this.where, where(state));
    write(this.first, first(state));
    setData(this.support, { support: finished ? "" : (support ?? "") });
    write(this.supportWord, support ? wordOf(SUPPORTS, support) : "not known");
    this.#figures(state);
    return "done";
  }

  #figures(state) {
    const { finished, pace, strides } = state;
    const bad = unsound(state);
    const whole = means(state);
    const { cadence, speed } = (finished ? whole : pace) ?? {};
    const rests = !finished && pace?.cadence == null; // nothing is new
    const most = mostDifferent((finished ? whole.rows : state.gait?.rows) ?? []);
    setData(this.list, { known: strides > 0 });
    this.#figure("speed", fixed(speed ?? NaN, 2), bad.size < 2);
    this.#figure("cadence", fixed(cadence ?? NaN), bad.size < 2);
    const size = most && `${fixed(100 * Math.abs(most.share), 1)} ${most.points ? "points" : "%"}`;
    this.#figure("symmetry", !most ? "–" : most.even ? "even" : `${fixed(100 * Math.abs(most.share), Math.abs(most.share) < 0.0995 ? 1 : 0)} %`, bad.size === 0 && sidesKnown(state) && !rests);
    write(this["symmetry-words"], !most ? "" : rests ? "last walk" : most.even ? "" : `${most.share < 0 ? "left" : "right"} ${most.more}`);
    const measure = most?.even ? `${most.name}: ${size}` : most?.name;
    write(this["symmetry-label"], measure ?? "left and right");
    const metres = distance(state);
    this.#figure("distance", strides > 0 ? fixed(metres, metres < 99.95 ? 1 : 0) : "–", bad.size < 2);
    write(this.strides, strides === null ? "–" : String(strides));
    write(this["speed-label"], `${finished ? "mean speed" : "speed now"}, m/s`);
    write(this["cadence-label"], `${finished ? "mean" : "cadence now,"} steps/min`);
  }

  #figure(name, words, sound) {
    write(this[name], words);
    setData(this.figures[name], { now: words !== "–", sound });
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
  if (finished) return strides > 0 ? `after ${lasted(state)}` : summary(state);
  if (plan !== null && place !== null) {
    if (LIFTS.includes(state.activity?.now) && place.decided) return capital([nameOf(plan, place.level), place.door].filter(Boolean).join(", "));
    return place.decided ? capital(whereOf(plan, place)) : `${place.candidates.length} possible places`;
  }
  if (strides === 0) return "at the start";
  if (wearer !== null && isWrong(state)) return "place not reliable";
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

const lasted = ({ playback, t, start }) => span(playback === null ? t - start : playback.end - playback.start);

// The whole walk in a sentence.
export function summary(state) {
  const { strides } = state;
  if (!(strides > 0)) return `No stride in ${lasted(state)}`;
  return `${fixed(distance(state))} m in ${lasted(state)}, ${strides} strides of each foot`;
}
