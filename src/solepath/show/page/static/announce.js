// Announcements for a screen reader: activity, the end of a walk, lost and restored links, what the checks found, the
// level, reported positions and what came of them, and the page's own connection.

import { findingText } from "./notice.js";
import { whereOf } from "./position.js";
import { summary } from "./situation.js";
import { isBroken } from "./trust.js";
import { activityText, capital, element } from "./words.js";

const JOIN_TIME = 1500; // ms; what comes within this time is announced together
const RECENT = 5; // s; an older line of the log is not announced: a seek went past it

export class Announcer {
  #waiting = [];
  #timer = 0;
  #broken = new Set();
  #activity = null;
  #place = null; // level of the decided place
  #said = new Set(); // what the checks found, and lines of the log on reported positions
  #finished = false;

  announce(words) {
    this.#waiting.push(words);
    this.#timer ||= setTimeout(() => {
      this.#timer = 0;
      element("announcer").textContent = this.#waiting.splice(0).join(". ");
    }, JOIN_TIME);
  }

  // During a seek nothing on the way is announced.
  update(state, changed) {
    const { activity, findings, finished, links, log, place, plan, strides, t } = state;
    const announce = (words) => state.playback?.seeking == null && this.announce(words);
    if (activity && activityText(activity) !== this.#activity) announce((this.#activity = activityText(activity)));
    for (const [site, link] of changed.has("links") ? Object.entries(links) : []) {
      const [before, broken] = [this.#broken.has(site), isBroken(link)];
      if (broken && !before) announce(`No data from the ${site}`);
      if (link.state === "ok" && before) announce(`${capital(site)} samples again`);
      if (broken) this.#broken.add(site);
      if (link.state === "ok") this.#broken.delete(site);
    }
    const found = findings.map(({ site, what }) => [findingText(site, what)]);
    const reports = log.filter(([at, kind]) => kind === "here" && at > t - RECENT).map(([at, , words]) => [capital(words), at]);
    for (const [words, at = ""] of [...found, ...reports]) {
      if (!this.#said.has(at + words)) announce(words);
      this.#said.add(at + words);
    }
    if (finished !== this.#finished && strides !== null) {
      this.#finished = finished;
      if (finished) announce(`Finished: ${summary(state)}`);
    }
    if (changed.has("place") && place) {
      if (place.decided && place.level !== this.#place) announce(`On ${whereOf(plan, place)}`);
      this.#place = place.decided ? place.level : null;
    }
  }
}
