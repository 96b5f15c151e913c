// The worker: Python, the walk that is measured, files, and messages for the page while it is seen.

import { Files } from "./files.js";
import { Problem, Python } from "./python.js";
import { Walk } from "./walk.js";

const FRAME_INTERVAL = 33; // ms
const MIN_FRAME_TIME = 0.03; // s between two frames
const HEARTBEAT_INTERVAL = 1000; // ms
const COVERED_INTERVAL = 3000; // ms between two signs of life under the cover
const BUDGET = 0.03; // s for which a recording is computed at once

let seen = true;
let covered = false;
let sentAt = 0; // ms, of the newest message for the page
let playedAt = performance.now();
let calls = Promise.resolve();
let draw = () => {};
let drawing = 0; // timer

const ready = (async () => {
  const python = await Python.load();
  const post = (message) => postMessage(message);
  const files = new Files(python, post);
  const walk = new Walk(python, files, post);
  await walk.resume();
  draw = () => guarded(() => frame(python));
  drawRegularly();
  const choices = { ...JSON.parse(python.choices()), recipe: files.used.recipe };
  postMessage({ ready: { filters: JSON.parse(python.sensor_filters()), choices } });
  await files.list();
  return { python, walk, files };
})();
ready.catch(failed);

onmessage = async ({ data }) => {
  const parts = await ready;
  if (data.sensors) guarded(() => receive(parts, data.sensors));
  else if (data.command) guarded(() => parts.python.command(data.command));
  else if ("seen" in data) {
    ({ seen, covered } = data);
    drawRegularly();
    if (!seen) calls = calls.then(() => parts.walk.save()).catch(failed);
  } else if (data.call) calls = calls.then(() => answer(parts, data)).catch(failed);
};

// Takes messages on sensors, passes on what the page has to do with them, and draws at once: to wake up costs as much.
function receive({ python, walk }, messages) {
  const orders = walk.receive(messages);
  if (orders.length > 0) postMessage({ orders });
  frame(python);
}

async function answer({ walk, files }, { call, values, id }) {
  try {
    const target = call in FILE_CALLS ? files : walk;
    const result = await target[call](...values);
    postMessage({ answer: { id, result } });
  } catch (error) {
    if (isOfPython(error)) throw error;
    if (!(error instanceof Problem)) console.warn(error);
    postMessage({ answer: { id, problem: error.message } });
  }
}

// After an error that Python did not expect what it holds is not to be trusted; a browser's own refusals end nothing.
const isOfPython = (error) => error.constructor.name === "PythonError" || error instanceof WebAssembly.RuntimeError;

const FILE_CALLS = { demo: 1, open: 1, choose: 1, report: 1, get: 1, remove: 1 };

// A page that nobody sees needs no pictures, and each look for changes wakes a phone's processor.
function drawRegularly() {
  clearInterval(drawing);
  if (seen) drawing = setInterval(() => draw(), FRAME_INTERVAL);
  else if (covered) drawing = setInterval(() => postMessage({ alive: true }), COVERED_INTERVAL);
}

function frame(python) {
  const now = performance.now();
  const passed = (now - playedAt) / 1000;
  if (passed < MIN_FRAME_TIME) return;
  playedAt = now;
  if (!seen) return;
  python.play(passed, BUDGET);
  const text = python.message();
  if (text !== undefined) postMessage({ text });
  else if (now - sentAt >= HEARTBEAT_INTERVAL) postMessage({ text: python.heartbeat() });
  else return;
  sentAt = now;
}

function guarded(what) {
  try {
    what();
  } catch (error) {
    failed(error);
  }
}

// An error that nobody expected: what Python holds is not to be trusted any more.
function failed(error) {
  postMessage({ failed: String(error?.stack ?? error) });
}
