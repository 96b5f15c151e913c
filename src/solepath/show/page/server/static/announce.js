// Announcements for a screen reader: activity, lost and restored links, the level, and the page's own connection.

import { nameOf } from "./saying.js";
import { capital, doing } from "./words.js";

const APART = 1500; // ms; what comes within this time is announced together

export class Announcer {
  #waiting = [];
  #timer = 0;
  #missed = new Set();
  #activity = null;
  #level = null;
  #decided = false;

  constructor() {
    this.element = document.getElementById("announcer");
  }

  say(words) {
    this.#waiting.push(words);
    if (this.#timer) return;
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.element.textContent = this.#waiting.splice(0).join(". ");
    }, APART);
  }

  // During a seek nothing on the way is announced.
  hear(state, changed) {
    const say = state.playback?.seeking != null ? () => {} : (words) => this.say(words);
    if (changed.has("activity") && state.activity) {
      const words = doing(state.activity);
      if (words !== this.#activity) say(words);
      this.#activity = words;
    }
    if (changed.has("links")) {
      for (const [site, { state: how }] of Object.entries(state.links)) {
        const missed = how === "lost" || how === "silent";
        if (missed && !this.#missed.has(site)) say(`Nothing heard of the ${site}`);
        if (how === "ok" && this.#missed.has(site)) say(`${capital(site)} heard again`);
        if (missed) this.#missed.add(site);
        if (how === "ok") this.#missed.delete(site);
      }
    }
    if (changed.has("place") && state.place) {
      const { decided } = state.place;
      if (decided && (state.place.level !== this.#level || !this.#decided))
        say(`On ${nameOf(state.plan, state.place.level)}`);
      [this.#level, this.#decided] = [state.place.level, decided];
    }
  }
}
