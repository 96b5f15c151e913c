// The log of events as sentences, the newest at the top.

import { capital, child, clock } from "./words.js";

export class Log {
  uses = ["log", "scene"];

  constructor() {
    this.list = document.getElementById("log");
    this.waiting = document.getElementById("log-waiting");
  }

  draw({ log, start }) {
    this.waiting.hidden = log.length > 0;
    this.list.replaceChildren(
      ...log
        .map(([t, kind, words]) => {
          const item = document.createElement("li");
          item.dataset.kind = kind;
          child(item, "time").textContent = clock(t - start);
          child(item, "i"); // mark of a fault
          child(item, "span").textContent = capital(words);
          return item;
        })
        .reverse(),
    );
    return "done";
  }
}
