// The place of the server's WebSocket: here the library runs in a worker of the page itself.

import { bluetoothWords } from "./bluetooth.js";
import { computer } from "./computer.js";
import { store } from "./store.js";

// What the page says of the worker.
export const WORDS = {
  starting: "Python starts in this browser",
  startHelp: "The first start takes some seconds. From then on no network is needed.",
  failed: "Stopped",
  whyClosed: "The part of this page that computes has stopped",
  whyEnded: "The part of this page that computes has stopped",
  lost: "The part of this page that computes has stopped",
  again: "It computes again",
  retry: "Restart it",
  finishes: false,
  watchOnly: "", // without a walk there is nothing to report
};

export class Connection {
  // take(message), changed(link, s until the next try), tell(what the program says of itself, what happened)
  constructor(take, changed, tell) {
    const why = bluetoothWords();
    let walk = null;
    let isNew = false; // no closed tab left a walk that would go on
    const tellFree = () => {
      const { isAsked, state } = computer;
      tell({ free: isNew && state === "loading" && !isAsked }, isAsked && state === "loading" ? "compute" : undefined);
    };
    tell({ walk, sensors: [], bluetooth: why === "", why });
    store.get("walk").then((left) => {
      isNew = left === undefined;
      tellFree();
    }, () => {});
    computer.on("text", (text) => take(JSON.parse(text)));
    computer.on("asked", tellFree);
    computer.on("state", (state) => changed({ ready: "open", loading: "connecting", dead: "ended" }[state], 0));
    computer.on("walk", (value) => tell({ walk: (walk = value && { resumed: value.resumed }) }));
    computer.on("sensors", (sensors) => {
      const list = [...sensors.values()].map(({ name, connected }) => ({ name, connected }));
      if (walk !== null && list.some(({ connected }) => connected)) walk.resumed = false; // from now on they come and go
      tell({ sensors: list });
    });
    computer.on("happened", ({ what, ...news }) => tell(news, what));
    computer.start();
  }

  send(command) {
    computer.post({ command: JSON.stringify(command) });
  }

  // A walk continues from its last save.
  retry() {
    if (computer.state === "dead") computer.start();
  }
}
