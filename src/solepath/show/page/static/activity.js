// What is looked at first: what the wearer does and where, and four figures; of the whole walk once it has ended.

import { mostDifferent } from "./gait.js";
import { nameOf, whereOf } from "./position.js";
import { distance, isWrong, means, sidesKnown, sourceWords, unsound } from "./trust.js";
import { SUPPORTS, activityText, capital, describe, element, fixed, setData, span, wordOf, write } from "./words.js";

export const activityPanel = {
  uses: ["activity", "support", "pace", "feet", "gait", "total", "spoilt", "findings", "place", "wearer", "links", "playback", "scene", "second"],

  draw(state) {
    const { activity, support, finished, strides, start, t } = state;
    const name = finished ? "FINISHED" : (activity?.now ?? "UNKNOWN");
    const silent = !finished && activity !== null && activity.last !== null;
    write("activity", headline(state));
    setData("activity", { activity: name, known: !silent });
    describe("activity-icon", "href", `#icon-${element(`icon-${name}`) ? name : "UNKNOWN"}`);
    const dated = !finished && strides !== null && activity !== null && activity.since >= start;
    const since = dated ? `for ${span(t - activity.since)}` : "";
    const source = strides > 0 && !silent ? sourceWords(state) : "";
    write("since", silent ? `no data from any foot ${since}` : [since, source].filter(Boolean).join(" · "));
    write("where", where(state));
    write("first", first(state));
    setData("support", { support: finished ? "" : (support ?? "") });
    write("support-word", support ? wordOf(SUPPORTS, support) : "not known");
    figures(state);
  },
};

function figures(state) {
  const { finished, pace, strides } = state;
  const bad = unsound(state).length;
  const whole = means(state);
  const { cadence, speed } = (finished ? whole : pace) ?? {};
  const rests = !finished && pace?.cadence == null; // nothing is new
  const most = mostDifferent((finished ? whole.rows : state.gait?.rows) ?? []);
  const share = Math.abs(most?.share ?? NaN);
  const side = most && ` ${most.share < 0 ? "left" : "right"} ${most.more}`; // a space outside of it would move
  const metres = distance(state);
  // Pressure cells alone show contacts, and neither strides nor a position.
  const hasTrack = strides > 0 || Object.values(state.feet).some((foot) => foot?.position);
  const texts = {
    speed: fixed(speed, 2),
    cadence: fixed(cadence),
    symmetry: !most ? "–" : most.even ? "even" : `${fixed(100 * share, share < 0.0995 ? 1 : 0)} %`,
    distance: strides > 0 ? fixed(metres, metres < 99.95 ? 1 : 0) : "–",
    strides: hasTrack ? String(strides ?? "–") : "–",
    "symmetry-words": most && rests ? " last walk" : !most || most.even ? "" : side,
    "symmetry-label": !most ? "left and right" : most.even ? `${most.name}: ${fixed(100 * share, 1)} ${most.points ? "points" : "%"}` : most.name,
    "speed-label": `${finished ? "mean speed" : "speed now"}, m/s`,
    "cadence-label": `${finished ? "mean" : "cadence now,"} steps/min`,
  };
  for (const [id, words] of Object.entries(texts)) write(id, words);
  setData("figures", { known: strides > 0 || texts.cadence !== "–" });
  for (const name of ["speed", "cadence", "symmetry", "distance"]) {
    const sound = name === "symmetry" ? bad === 0 && sidesKnown(state) && !rests : bad < 2;
    setData(`figure-${name}`, { now: texts[name] !== "–", sound });
  }
}

function headline({ activity, finished, strides }) {
  if (finished && strides !== null) return "Finished";
  if (activity === null || strides === null) return "Waiting";
  if (strides === 0 && activity.last === null && activity.now === "UNKNOWN") return "Ready";
  return activityText(activity);
}

function where(state) {
  const { activity, finished, strides, place, plan, wearer, links } = state;
  if (strides === null) return Object.keys(links).length > 0 ? "for the first data" : "for the sensors";
  if (finished) return strides > 0 ? `after ${lasted(state)}` : summary(state);
  if (plan !== null && place !== null) {
    if (!place.decided) return `${place.candidates.length} possible places`;
    const inLift = activity?.now.startsWith("ELEVATOR");
    return capital(inLift ? [nameOf(plan, place.level), place.door].filter(Boolean).join(", ") : whereOf(plan, place));
  }
  if (strides === 0) return "at the start";
  if (wearer === null) return "";
  return isWrong(state) ? "place not reliable" : `${fixed(Math.hypot(wearer.position[0], wearer.position[1]))} m from the start`;
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

const lasted = ({ playback, t, start }) => span(playback === null ? t - start : playback.end - playback.begin);

// The whole walk in a sentence.
export function summary(state) {
  const { strides } = state;
  if (!(strides > 0)) return `No stride in ${lasted(state)}`;
  return `${fixed(distance(state))} m in ${lasted(state)}, ${strides} strides of each foot`;
}
