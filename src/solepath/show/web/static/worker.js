// The worker: Python, the walk that is measured, files, and messages for the page while it is seen.

import { Files } from "./files.js";
import { Problem, Python } from "./python.js";
import { Walk } from "./walk.js";

const FRAME_INTERVAL = 33; // ms from a look for changes to the next, if nothing arrives
const MIN_FRAME_TIME = 0.03; // s between two frames
const HEARTBEAT_INTERVAL = 1000; // ms
const COVERED_INTERVAL = 3000; // ms between two signs of life under the cover
const BUDGET = 0.03; // s for which a recording is computed at once

let seen = true;
let covered = false;
let sentAt = 0; // ms, of the newest message for the page
let playedAt = performance.now();
let calls = Promise.resolve();
let drawing = 0; // timer of the next look for changes, or of signs of life
let loaded = null; // {python, walk, files}

const ready = load();
ready.catch(failed);

async function load() {
  const python = await Python.load();
  const post = (message) => postMessage(message);
  const files = new Files(python, post);
  const walk = new Walk(python, files, post);
  await walk.resume();
  loaded = { python, walk, files };
  drawRegularly();
  const choices = { ...JSON.parse(python.choices()), recipe: files.used.recipe };
  postMessage({ ready: { choices } });
  await files.list();
}

onmessage = async ({ data }) => {
  await ready;
  if (data.sensors) guarded(() => receive(data.sensors));
  else if (data.command) guarded(() => loaded.python.command(data.command));
  else if ("seen" in data) {
    ({ seen, covered } = data);
    drawRegularly();
    if (!seen) calls = calls.then(() => loaded.walk.save()).catch(failed);
  } else if (data.call) calls = calls.then(() => answer(data)).catch(failed);
};

// Takes messages on sensors, passes on what the page has to do with them, and draws at once: to wake up costs as much.
function receive(messages) {
  const orders = loaded.walk.receive(messages);
  if (orders.length > 0) postMessage({ orders });
  draw();
}

async function answer({ call, values, id }) {
  try {
    const target = call in loaded.files ? loaded.files : loaded.walk;
    const result = await target[call](...values);
    if (seen) show(); // what it changed, before anybody acts on the answer
    postMessage({ answer: { id, result } });
  } catch (error) {
    // After an error that Python did not expect what it holds is not to be trusted; a browser's own refusals end nothing.
    if (error.constructor.name === "PythonError" || error instanceof WebAssembly.RuntimeError) throw error;
    if (!(error instanceof Problem)) console.warn(error);
    postMessage({ answer: { id, problem: error.message } });
  }
}

// A page that nobody sees needs no pictures, and each look for changes wakes a phone's processor.
function drawRegularly() {
  clearTimeout(drawing);
  if (seen) drawing = setTimeout(guarded, FRAME_INTERVAL, draw);
  else if (covered) drawing = setInterval(() => postMessage({ alive: true }), COVERED_INTERVAL);
}

// Draws, and again after a while, unless what arrives lets it draw before.
function draw() {
  const now = performance.now();
  const passed = (now - playedAt) / 1000;
  if (!seen || passed < MIN_FRAME_TIME) return;
  playedAt = now;
  loaded.python.play(passed, BUDGET);
  show();
  drawRegularly();
}

function show() {
  const { python } = loaded;
  const now = performance.now();
  const text = python.message() ?? (now - sentAt >= HEARTBEAT_INTERVAL ? python.heartbeat() : undefined);
  if (text === undefined) return;
  postMessage({ text });
  sentAt = now;
}

function guarded(act) {
  try {
    act();
  } catch (error) {
    failed(error);
  }
}

// An error that nobody expected: what Python holds is not to be trusted any more.
function failed(error) {
  postMessage({ failed: String(error?.stack ?? error) });
}
