// The walk that is measured now: messages on its sensors go to the worker (protocol/host.md), in their order.

import { now } from "./clock.js";
import { computer } from "./computer.js";

// What comes within this time goes to the worker together, ms: a picture is drawn thirty times a second. Each time that the
// worker wakes up costs as much as some packets (tests/bench/web_live.py), so nobody pays for quick pictures while nobody looks.
const BATCH_TIME = 30;
const HIDDEN_BATCH_TIME = 100;
const TICK = 200; // ms between two messages that say nothing but the time

const HEX = Array.from({ length: 256 }, (_, byte) => byte.toString(16).padStart(2, "0"));
let walk = null; // {began, title, name, resumed, t}
let began = 0; // s since 1970
let batch = [];
let sentAt = 0;
let timer = 0;

computer.on("walk", (value) => {
  walk = value;
  if (walk !== null) began = Math.min(walk.began, now() - walk.t); // no packet comes before what the worker has
});
setInterval(() => running() && send({ type: "time", t: clock() }), TICK);

export const running = () => walk !== null;

// Time on the clock of the walk, s: 0 where it started, also after the page was opened again.
export const clock = () => now() - began;

// Starts a walk, unless one is running: a walk that a closed tab left goes on by itself.
export async function startWalk(title = `Walk of ${new Date().toLocaleString([], { dateStyle: "medium", timeStyle: "short" })}`) {
  if (running()) return;
  navigator.storage?.persist?.().catch(() => {}); // asks that nothing is deleted for lack of space
  await computer.call("start", title);
}

// Sends a message of an app to its host.
export function send(message) {
  batch.push(message);
  flush();
}

// Sends what a sensor notified: channel, and a DataView of the bytes.
export function notified(device, channel, view) {
  const value = [clock(), device, channel, hex(view)];
  const newest = batch.at(-1);
  if (newest?.type === "values") newest.values.push(value);
  else batch.push({ type: "values", values: [value] });
  flush();
}

// A DataView as text, and such a text as bytes.
export const hex = ({ buffer, byteOffset, byteLength }) =>
  Array.from(new Uint8Array(buffer, byteOffset, byteLength), (byte) => HEX[byte]).join("");
export const bytes = (text) => Uint8Array.from(text.match(/../g) ?? [], (two) => parseInt(two, 16));

function flush() {
  // not by the timer alone: in a page that is hidden it runs once a second
  const time = computer.seen ? BATCH_TIME : HIDDEN_BATCH_TIME;
  if (performance.now() - sentAt >= time) post();
  else timer ||= setTimeout(post, time);
}

function post() {
  clearTimeout(timer);
  timer = 0;
  sentAt = performance.now();
  if (batch.length > 0) computer.post({ sensors: batch });
  batch = [];
}
