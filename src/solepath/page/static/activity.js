// What the wearer does, and the few figures that everybody asks for first.

import { ACTIVITIES, SUPPORTS, describe, fixed, say, span, tell, write } from "./words.js";

export class Doing {
  constructor() {
    for (const id of ["activity", "since", "support", "cadence", "speed", "steps", "distance"])
      this[id] = document.getElementById(id);
    this.icon = document.getElementById("activity-icon");
    this.supportWord = document.getElementById("support-word");
  }

  wants(changed) {
    return ["activity", "support", "gait", "feet", "scene", "second"].some((name) => changed.has(name));
  }

  draw(state) {
    const { activity, support, gait, feet } = state;
    const name = activity?.now ?? "UNKNOWN";
    write(this.activity, activity ? say(ACTIVITIES, name) : "Waiting");
    tell(this.activity, { activity: name });
    const icon = `#icon-${Object.hasOwn(ACTIVITIES, name) ? name : "UNKNOWN"}`;
    describe(this.icon, "href", icon);
    write(
      this.since,
      activity?.since != null && activity.since >= state.begin ? `for ${span(state.t - activity.since)}` : "",
    );
    tell(this.support, { support: support ?? "" });
    write(this.supportWord, support ? say(SUPPORTS, support) : "");
    write(this.cadence, fixed(gait?.cadence ?? NaN));
    write(this.speed, fixed(gait?.rows.find((row) => row.name === "speed")?.both ?? NaN, 2));
    const heard = Object.values(feet).filter((foot) => foot !== null);
    write(this.steps, heard.length > 0 ? String(heard.reduce((sum, foot) => sum + (foot.steps || 0), 0)) : "–");
    // either foot goes about as far as the wearer
    const ways = heard.map((foot) => foot.distance || 0);
    write(this.distance, heard.length > 0 ? fixed(ways.reduce((a, b) => a + b, 0) / ways.length, 1) : "–");
    return "done";
  }
}
