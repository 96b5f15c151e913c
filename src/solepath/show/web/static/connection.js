// The place of the server's WebSocket: here the library runs in a worker of the page itself.

import { computer } from "./computer.js";

// What the page says of the worker.
export const WORDS = {
  open: "ready",
  connecting: "loading",
  closed: "stopped",
  ended: "stopped",
  whyClosed: "The part of this page that computes has stopped",
  whyEnded: "The part of this page that computes has stopped",
  lost: "The part of this page that computes has stopped",
  again: "It computes again",
  retry: "Restart it",
  finishes: false,
  watchOnly: "", // without a walk there is nothing to report
};

export class Connection {
  // take(message), changed(state, s until the next try)
  constructor(take, changed) {
    computer.on("text", (text) => take(JSON.parse(text)));
    computer.on("state", (state) => changed({ ready: "open", loading: "connecting", dead: "ended" }[state], 0));
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
