// What happened, in sentences, the newest at the top.

import { clock } from "./words.js";

export class Log {
  constructor() {
    this.list = document.getElementById("log");
    this.waiting = document.getElementById("log-waiting");
    this.scroll = document.getElementById("log-scroll");
  }

  wants(changed) {
    return changed.has("log") || changed.has("scene");
  }

  draw({ log, begin }) {
    this.waiting.hidden = log.length > 0;
    this.scroll.hidden = log.length === 0;
    this.list.replaceChildren(
      ...log
        .map(([t, kind, words]) => {
          const item = document.createElement("li");
          item.dataset.kind = kind;
          const time = document.createElement("time");
          time.textContent = clock(t - begin);
          const sentence = document.createElement("span");
          sentence.textContent = words;
          item.append(time, sentence);
          return item;
        })
        .reverse(),
    );
    return "done";
  }
}
