// The wearer's activity, and the figures that are looked at first.

import { ACTIVITIES, MODES, SUPPORTS, describe, activityText, fixed, wordOf, show, span, setData, write } from "./words.js";

export class ActivityPanel {
  uses = ["activity", "support", "touchdown", "fused", "pace", "feet", "scene", "second"];

  constructor() {
    for (const id of ["activity", "since", "support", "touchdown", "fused", "cadence", "speed", "strides", "distance"])
      this[id] = document.getElementById(id);
    this.icon = document.getElementById("activity-icon");
    this.supportWord = document.getElementById("support-word");
  }

  draw(state) {
    const { activity, support, touchdown, fused, pace, feet } = state;
    const name = activity?.now ?? "UNKNOWN";
    const silent = activity !== null && activity.last !== null;
    write(this.activity, activity ? activityText(activity) : "Waiting");
    setData(this.activity, { activity: name, known: !silent });
    const icon = `#icon-${Object.hasOwn(ACTIVITIES, name) ? name : "UNKNOWN"}`;
    describe(this.icon, "href", icon);
    const dated = activity?.since != null && activity.since >= state.start;
    const since = dated ? `for ${span(state.t - activity.since)}` : "";
    write(this.since, silent ? `no data from any foot ${since}` : since);
    setData(this.support, { support: support ?? "" });
    write(this.supportWord, support ? wordOf(SUPPORTS, support) : "");
    show(this.touchdown, touchdown !== null);
    write(this.touchdown, touchdown ? touchdownText(touchdown) : "");
    setData(this.touchdown, { mode: touchdown?.mode ?? "" });
    show(this.fused, fused !== null);
    write(this.fused, fused ? fusedText(fused) : "");
    write(this.cadence, fixed(pace?.cadence ?? NaN));
    write(this.speed, fixed(pace?.speed ?? NaN, 2));
    const sending = Object.values(feet).filter((foot) => foot !== null);
    write(this.strides, sending.length > 0 ? String(sending.reduce((sum, foot) => sum + (foot.strides || 0), 0)) : "–");
    // each foot goes about as far as the wearer
    const lengths = sending.map((foot) => foot.distance || 0);
    write(this.distance, sending.length > 0 ? fixed(lengths.reduce((a, b) => a + b, 0) / lengths.length, 1) : "–");
    return "done";
  }
}

function touchdownText({ foot, mode, position: [x, y] }) {
  return `${wordOf(MODES, mode)}; ${foot} foot came down at ${fixed(x, 2)}, ${fixed(y, 2)} m`;
}

function fusedText({ foot, chosen, length, distance, similarity, errorIndex, share }) {
  const figures = [
    ["similarity", similarity, 2, ""],
    ["error index", errorIndex, 3, " m/s"],
    ["own share", share, 2, ""],
  ].map(([name, value, digits, unit]) => `${name} ${fixed(value ?? NaN, digits)}${value === null ? "" : unit}`);
  return `Both feet: ${fixed(distance, 2)} m by the ${chosen} foot; last stride, ${foot}, ${fixed(length, 2)} m: ${figures.join(", ")}`;
}
