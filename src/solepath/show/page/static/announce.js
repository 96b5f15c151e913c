// Announcements for a screen reader: activity, the end of a walk, lost and restored links, what the checks found, the
// level, reported positions and what came of them, and the page's own connection.

import { summary } from "./activity.js";
import { whereOf } from "./position.js";
import { capital, activityText } from "./words.js";

const JOIN_TIME = 1500; // ms; what comes within this time is announced together
const RECENT = 5; // s; an older line of the log is not announced: a seek went past it

export class Announcer {
  #waiting = [];
  #timer = 0;
  #broken = new Set();
  #activity = null;
  #level = null;
  #decided = false;
  #found = new Set(); // what the checks found so far
  #finished = false;
  #report = null; // newest line of the log on a reported position; "" for none, null before the first log

  constructor() {
    this.element = document.getElementById("announcer");
  }

  announce(words) {
    this.#waiting.push(words);
    if (this.#timer) return;
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.element.textContent = this.#waiting.splice(0).join(". ");
    }, JOIN_TIME);
  }

  // During a seek nothing on the way is announced.
  update(state, changed) {
    const announce = state.playback?.seeking != null ? () => {} : (words) => this.announce(words);
    if (changed.has("activity") && state.activity) {
      const words = activityText(state.activity);
      if (words !== this.#activity) announce(words);
      this.#activity = words;
    }
    if (changed.has("links")) {
      for (const [site, { state: how }] of Object.entries(state.links)) {
        const broken = how === "lost" || how === "silent";
        if (broken && !this.#broken.has(site)) announce(`No data from the ${site}`);
        if (how === "ok" && this.#broken.has(site)) announce(`${capital(site)} samples again`);
        if (broken) this.#broken.add(site);
        if (how === "ok") this.#broken.delete(site);
      }
    }
    if (changed.has("findings")) {
      for (const { site, what } of state.findings) {
        const words = capital(site ? `${site}: ${what}` : what);
        if (!this.#found.has(words)) announce(words);
        this.#found.add(words);
      }
    }
    if (state.finished !== this.#finished && state.strides !== null) {
      this.#finished = state.finished;
      if (this.#finished) announce(`Finished: ${summary(state)}`);
    }
    if (changed.has("log")) this.#reports(state, announce);
    if (changed.has("place") && state.place) {
      const { decided } = state.place;
      if (decided && (state.place.level !== this.#level || !this.#decided))
        announce(`On ${whereOf(state.plan, state.place)}`);
      [this.#level, this.#decided] = [state.place.level, decided];
    }
  }

  // A scene brings the whole log again: only the lines after the one that was the newest are new.
  #reports({ log, t: now }, announce) {
    const lines = log.filter(([, kind]) => kind === "here");
    const keys = lines.map((line) => line.join(" "));
    if (this.#report !== null) {
      const known = keys.lastIndexOf(this.#report);
      for (const [t, , words] of lines.slice(known + 1)) if (t > now - RECENT) announce(capital(words));
    }
    this.#report = keys.at(-1) ?? "";
  }
}
