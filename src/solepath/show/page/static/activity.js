// What is looked at first: what the wearer does and where, and four figures; of the whole walk once it has ended.

import { isCompared, mostDifferent } from "./gait.js";
import { confidence, words } from "./situation.js";
import { distance, means, sidesKnown, sourceWords, unsound } from "./trust.js";
import { SUPPORTS, activityText, describe, element, fixed, setData, span, wordOf, write } from "./words.js";

const OF_NOW = ["walking", "lost", "playing"]; // situations in which the activity is the heading

export const activityPanel = {
  uses: ["activity", "support", "pace", "feet", "gait", "total", "spoilt", "findings", "place", "wearer", "links", "situation", "scene", "second"],

  draw(state) {
    const { activity, situation, support, strides } = state;
    const { headline, where, help } = words(state);
    const isNow = OF_NOW.includes(situation);
    const name = situation === "finished" ? "FINISHED" : isNow ? (activity?.now ?? "UNKNOWN") : "UNKNOWN";
    write("activity", headline);
    setData("activity", { activity: name, known: !(isNow && isSilent(state)) });
    describe("activity-icon", "href", `#icon-${element(`icon-${name}`) ? name : "UNKNOWN"}`);
    write("where", where);
    write("since", since(state, isNow));
    write("first", help);
    setData("support", { support: isNow ? (support ?? "") : "" });
    write("support-word", support ? wordOf(SUPPORTS, support) : "not known");
    if (strides !== null) figures(state);
    setData("figures", { known: help === "" });
  },
};

const isSilent = ({ activity }) => activity !== null && activity.last !== null;

// How long the wearer has done that, what the figures come from, and how sure the place is.
function since(state, isNow) {
  const { activity, program, situation, start, strides, t } = state;
  const source = strides > 0 && !isSilent(state) ? sourceWords(state) : "";
  if (situation === "finished") return [program.kept && "kept on this device", source].filter(Boolean).join(" · ");
  if (situation === "paused") return [activity && activityText(activity).toLowerCase(), source].filter(Boolean).join(" · ");
  if (!isNow || activity === null || strides === null || activity.since < start) return "";
  const dated = `for ${span(t - activity.since)}`;
  if (isSilent(state)) return `no data from any foot ${dated}`;
  return [dated, source || (strides > 0 && confidence(state))].filter(Boolean).join(" · ");
}

function figures(state) {
  const { finished, pace, strides } = state;
  const bad = unsound(state).length;
  const whole = means(state);
  const { cadence, speed } = (finished ? whole : pace) ?? {};
  const rests = !finished && pace?.cadence == null; // nothing is new
  const most = isCompared(state.gait) ? mostDifferent((finished ? whole.rows : state.gait.rows) ?? []) : undefined;
  const share = Math.abs(most?.share ?? NaN);
  const metres = distance(state);
  // Pressure cells alone show contacts, and neither strides nor a position.
  const hasTrack = strides > 0 || Object.values(state.feet).some((foot) => foot?.position);
  const texts = {
    speed: fixed(speed, 2),
    cadence: fixed(cadence),
    symmetry: !most ? "–" : most.even ? "even" : `${fixed(100 * share, share < 0.0995 ? 1 : 0)} %`,
    distance: strides > 0 ? fixed(metres, metres < 99.95 ? 1 : 0) : "–",
    strides: hasTrack ? String(strides ?? "–") : "–",
    "symmetry-words": most && rests ? " last walk" : "", // a space outside of it would move
    "symmetry-label": !most || most.even ? "left and right" : `${most.share < 0 ? "left" : "right"} ${most.more}`,
    "speed-label": `${finished ? "mean speed" : "speed now"}, m/s`,
    "cadence-label": `${finished ? "mean" : "cadence now,"} steps/min`,
  };
  for (const [id, words] of Object.entries(texts)) write(id, words);
  for (const name of ["speed", "cadence", "symmetry", "distance"]) {
    const sound = name === "symmetry" ? bad === 0 && sidesKnown(state) && !rests : bad < 2;
    setData(`figure-${name}`, { now: texts[name] !== "–", sound });
  }
}
