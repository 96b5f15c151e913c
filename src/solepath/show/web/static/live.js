// Where the packets of sensors come in: bluetooth.js calls packet() for each value that a device sent.

import { computer } from "./computer.js";

const BATCH_TIME = 8; // ms; what comes within this time goes to the worker together

const now = () => (performance.timeOrigin + performance.now()) / 1000;
let walk = null; // {began, title, name, recorded}
let batch = [];
let sentAt = 0;
let timer = 0;

computer.on("walk", (value) => (walk = value));

export const running = () => walk !== null;

// Time on the clock of the walk, s: 0 where it started, also after the page was opened again.
export const clock = () => now() - walk.began;

// Starts a walk, unless one is running: a walk that a closed tab left goes on by itself.
export async function startWalk(title = `Walk of ${new Date().toLocaleString([], { dateStyle: "medium", timeStyle: "short" })}`) {
  if (!running()) await computer.call("start", title);
}

// site as in protocol/recording.md; data: Uint8Array, which nobody changes afterwards; device: its id. The time of
// arrival is now, unless t says otherwise, s on the clock of the walk.
export function packet(site, channel, data, device = "", t = clock()) {
  batch.push([t, site, channel, data, device]);
  // not by the timer alone: in a page that is hidden it runs once a second
  if (performance.now() - sentAt >= BATCH_TIME) send();
  else timer ||= setTimeout(send, BATCH_TIME);
}

function send() {
  clearTimeout(timer);
  timer = 0;
  sentAt = performance.now();
  computer.post({ packets: batch });
  batch = [];
}
