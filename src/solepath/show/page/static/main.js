// Receives messages and draws pictures: changes are drawn some thirty times a second, and nothing else is drawn.
//
// A panel draws a part of the page: {uses: names of the changes that it draws, draw(state, now)}; it may be moving without
// a change, and have a least time between two pictures, ms: interval, or slow with reduced motion. A panel with a surface
// (canvas.js) that is out of sight is drawn seldom, for its text alternative alone.
//
// For tests: window.solepath = {frames, messages, state, track}: number of frames drawn, number of messages received, the
// state that results from them (state.js), and its drawing (track.js).

import { activityPanel } from "./activity.js";
import { Announcer } from "./announce.js";
import { bodyFigure } from "./body.js";
import { reducedMotion } from "./canvas.js";
import { Connection, WORDS } from "./connection.js";
import { Gait } from "./gait.js";
import { posturePanel } from "./guides.js";
import { Height } from "./height.js";
import { Here } from "./here.js";
import { Links } from "./links.js";
import { Looking } from "./looking.js";
import { Notice, logPanel } from "./notice.js";
import { Playback } from "./playback.js";
import { Ribbon } from "./ribbon.js";
import { happening, next } from "./situation.js";
import { Soles } from "./soles.js";
import { Space } from "./space.js";
import { State } from "./state.js";
import { startTheme } from "./theme.js";
import { Track } from "./track.js";
import { element, setData, show, wordOf, write } from "./words.js";

const LEAST_PAUSE = 24; // ms between two pictures, unless a person moves the view: with the frames of a screen they are 25 to 34
const ASIDE_INTERVAL = 1000; // ms between two pictures that are out of sight
const SOURCES = { live: "live sensors", demo: "an emulated walk", recording: "a recording" };

const state = new State();
let changed = new Set();
const late = new Set(); // panels that changed less than their interval after their last picture
let requestedAt = Infinity; // ms, of the next picture
let pausedUntil = 0; // ms
let timer = 0;

const redraw = () => mark("theme");
const send = (command) => connection.send(command);
const announce = (words) => announcer.announce(words);
const announcer = new Announcer();
const notice = new Notice();
const track = new Track(redraw);
const playback = new Playback(send, announce);
const looking = new Looking(track, redraw);
const here = new Here(track, send, announce, redraw, WORDS.watchOnly);
const whileGuiding = [notice, posturePanel, new Links(), logPanel]; // while a shoe is measured
const panels = [
  ...whileGuiding,
  new Soles(redraw),
  new Ribbon(redraw),
  track,
  new Height(redraw),
  new Space(redraw),
  activityPanel,
  bodyFigure,
  new Gait(),
  playback,
  here,
];
const drawnAt = new Map(); // ms, by panel
const seen = (window.solepath = { frames: 0, messages: 0, state, track });

function mark(...names) {
  for (const name of names) changed.add(name);
  if (!document.hidden) request(0);
}

// Requests a picture in `wait` ms, unless there is one before.
function request(wait) {
  const now = performance.now();
  const at = Math.max(now + wait, pausedUntil);
  if (at >= requestedAt) return;
  requestedAt = at;
  clearTimeout(timer);
  if (at <= now) requestAnimationFrame(draw);
  else timer = setTimeout(requestAnimationFrame, at - now, draw);
}

function draw(now) {
  requestedAt = Infinity;
  const news = changed;
  changed = new Set();
  let drew = false;
  let wait = Infinity; // ms until a panel is due
  for (const panel of !state.known ? [notice, activityPanel] : isGuided() ? whileGuiding : panels) {
    if (!panel.moving && !late.has(panel) && !panel.uses.some((name) => news.has(name))) continue;
    const left = drawnAt.get(panel) + intervalOf(panel) - now;
    if (left > 0 && !news.has("theme") && !news.has("scene")) {
      late.add(panel);
      wait = Math.min(wait, left);
      continue;
    }
    panel.draw(state, now);
    drawnAt.set(panel, now);
    late.delete(panel);
    if (panel.moving) wait = Math.min(wait, intervalOf(panel));
    drew = true;
  }
  if (!state.known) return;
  pausedUntil = track.view.follows || track.view.settled ? performance.now() + LEAST_PAUSE : 0;
  looking.draw(state);
  if (news.has("scene")) writeHeading();
  chooseRegions();
  if (drew) seen.frames += 1;
  if (wait < Infinity) request(wait);
}

function intervalOf(panel) {
  if (panel.surface?.seen === false) return ASIDE_INTERVAL;
  return (reducedMotion.matches && panel.slow) || panel.interval || 0;
}

const isGuided = () => state.posture !== null;

function writeHeading() {
  write("title", state.source === "demo" ? `${state.title} · ${SOURCES.demo}` : state.title);
  write("source", wordOf(SOURCES, state.source));
  write("recipe", state.recipe);
  const { classList } = document.body;
  classList.toggle("measuring", isGuided());
  classList.toggle("has-plan", state.plan !== null);
  classList.toggle("has-levels", (state.plan?.levels.length ?? 0) > 1);
  document.title = state.title ? `${state.title} – solepath` : "solepath";
}

// Which regions there are follows from the sensors; what was shown once stays, so that nothing moves.
function chooseRegions() {
  const { dataset } = document.body;
  dataset.known = "";
  if (state.soles !== "unknown" && dataset.soles !== "cells") setData(document.body, { soles: state.soles });
}

// What the program behind the page says of itself, and what happened besides. The page shows the situation that follows.
function tell(news, happened) {
  Object.assign(state.program, news);
  settle(happened);
  mark("situation");
}

function settle(happened) {
  const before = state.situation;
  for (const one of [happened, happening(state)]) if (one) state.situation = next(state.situation, one);
  if (state.situation === before) return;
  document.body.dataset.situation = state.situation;
  for (const one of document.querySelectorAll("[data-in]")) show(one, one.dataset.in.split(" ").includes(state.situation));
  mark("situation");
}

let broken = ""; // "closed" or "ended" until the connection is there again; "" before the first one and while it is
let countdown = 0;

// wait: s until the connection is tried again
function showConnection(link, wait) {
  clearInterval(countdown);
  const isBroken = link === "closed" || link === "ended";
  if (isBroken && link !== broken) announce(link === "ended" ? WORDS.whyEnded : WORDS.lost);
  if (link === "open" && broken) announce(WORDS.again);
  if (link !== "connecting") broken = isBroken ? link : "";
  const ended = broken === "ended";
  setData("connection", { state: link });
  setData("offline", { why: ended ? "ended" : "closed" });
  show("offline", broken !== ""); // while the first connection is tried, no alarm is needed
  document.body.classList.toggle("old", link !== "open" && state.known);
  tell({ link });
  const at = performance.now() + 1000 * wait;
  const writeWords = () => {
    const old = !state.known ? "" : ended ? "; what you see is the last of it" : "; what you see is old";
    const left = Math.ceil((at - performance.now()) / 1000);
    const next = link === "ended" ? "" : link === "connecting" || left < 1 ? " Trying now." : ` Trying again in ${left} s.`;
    write("offline-words", `${ended ? WORDS.whyEnded : WORDS.whyClosed}${old}.${next}`);
  };
  writeWords();
  if (isBroken) countdown = setInterval(writeWords, 1000);
}

const connection = new Connection((message) => {
  const news = state.take(message);
  seen.messages += 1;
  settle();
  if (news.size === 0) return;
  announcer.update(state, news);
  mark(...news);
}, showConnection, tell);

write("retry", WORDS.retry);
element("retry").addEventListener("click", () => connection.retry());
document.addEventListener("visibilitychange", () => {
  requestedAt = Infinity; // a frame that was requested before may never have come
  if (!document.hidden) mark("scene", "theme", "feet", "links", "gait", "activity", "situation");
});
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
  const { target, key } = event;
  if (target.matches("select, textarea, input:not([type=range])")) return;
  if (key === " " && target.closest("button, summary")) return; // on a button the space bar presses it
  if (playback.key(key, event.shiftKey) || looking.key(key) || here.key(key)) event.preventDefault();
});
setInterval(() => mark("second"), 1000);
startTheme(element("theme"), redraw);
