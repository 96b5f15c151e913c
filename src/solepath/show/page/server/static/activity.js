// The wearer's activity, and the few figures that everybody looks for first.

import { ACTIVITIES, SUPPORTS, describe, doing, fixed, say, span, tell, write } from "./words.js";

export class Doing {
  wants = ["activity", "support", "pace", "feet", "scene", "second"];

  constructor() {
    for (const id of ["activity", "since", "support", "cadence", "speed", "steps", "distance"])
      this[id] = document.getElementById(id);
    this.icon = document.getElementById("activity-icon");
    this.supportWord = document.getElementById("support-word");
  }

  draw(state) {
    const { activity, support, pace, feet } = state;
    const name = activity?.now ?? "UNKNOWN";
    const unheard = activity !== null && activity.last !== null;
    write(this.activity, activity ? doing(activity) : "Waiting");
    tell(this.activity, { activity: name, known: !unheard });
    const icon = `#icon-${Object.hasOwn(ACTIVITIES, name) ? name : "UNKNOWN"}`;
    describe(this.icon, "href", icon);
    const dated = activity?.since != null && activity.since >= state.begin;
    const since = dated ? `for ${span(state.t - activity.since)}` : "";
    write(this.since, unheard ? `no foot is heard ${since}` : since);
    tell(this.support, { support: support ?? "" });
    write(this.supportWord, support ? say(SUPPORTS, support) : "");
    write(this.cadence, fixed(pace?.cadence ?? NaN));
    write(this.speed, fixed(pace?.speed ?? NaN, 2));
    const heard = Object.values(feet).filter((foot) => foot !== null);
    write(this.steps, heard.length > 0 ? String(heard.reduce((sum, foot) => sum + (foot.steps || 0), 0)) : "–");
    // each foot goes about as far as the wearer
    const ways = heard.map((foot) => foot.distance || 0);
    write(this.distance, heard.length > 0 ? fixed(ways.reduce((a, b) => a + b, 0) / ways.length, 1) : "–");
    return "done";
  }
}
