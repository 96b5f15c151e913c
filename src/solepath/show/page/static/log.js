// The log of events as sentences, the newest at the top.

import { capital, child, clock, element, setData, show } from "./words.js";

export const logPanel = {
  uses: ["log", "scene"],

  draw({ log, start }) {
    show("log-waiting", log.length === 0);
    element("log").replaceChildren();
    for (const [t, kind, words] of log.toReversed()) {
      const item = child(element("log"), "li");
      setData(item, { kind });
      child(item, "time", "", clock(t - start));
      child(item, "i"); // mark of a fault
      child(item, "span", "", capital(words));
    }
  },
};
