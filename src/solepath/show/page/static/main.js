// Receives messages and draws pictures: each change is drawn with the browser's next frame, and nothing else is drawn.
//
// For tests: window.solepath = {frames, messages, state, track}: number of frames drawn, number of messages received, the
// state that results from them (state.js), and its drawing (track.js).

import { ActivityPanel } from "./activity.js";
import { Announcer } from "./announce.js";
import { BodyFigure } from "./body.js";
import { keepClear } from "./clearance.js";
import { Connection, WORDS } from "./connection.js";
import { Gait } from "./gait.js";
import { Height } from "./height.js";
import { Here } from "./here.js";
import { Links } from "./links.js";
import { Log } from "./log.js";
import { Looking } from "./looking.js";
import { Notice } from "./notice.js";
import { Pace } from "./pace.js";
import { Playback } from "./playback.js";
import { PosturePanel, ToeOutPanel } from "./guides.js";
import { Ribbon } from "./ribbon.js";
import { Seeking } from "./seeking.js";
import { Soles } from "./soles.js";
import { Space } from "./space.js";
import { State } from "./state.js";
import { startTheme } from "./theme.js";
import { Track } from "./track.js";
import { capital, wordOf, write } from "./words.js";

const element = (id) => document.getElementById(id);
const state = new State();
const seen = { frames: 0, messages: 0, state };
window.solepath = seen;

const WHILE_GUIDING = [Notice, PosturePanel, ToeOutPanel, Links, Log]; // what is shown while a shoe or a walk is measured

let changed = new Set();
let frameRequested = false;
let ready = false;
const redraw = () => mark("theme");

const pace = new Pace();
const announcer = new Announcer();
const notice = new Notice();
const track = (seen.track = new Track(redraw));
const ribbon = new Ribbon(redraw);
const playback = new Playback((command) => connection.send(command));
const looking = new Looking(track, redraw);
const here = new Here(
  track,
  (command) => connection.send(command),
  (words) => announcer.announce(words),
  redraw,
  WORDS.watchOnly,
);
const panels = [
  notice,
  new Soles(redraw),
  ribbon,
  track,
  new Height(redraw),
  new Space(redraw),
  new ActivityPanel(),
  new BodyFigure(),
  new PosturePanel(),
  new ToeOutPanel(),
  new Gait(),
  new Links(),
  new Log(),
  playback,
  here,
  new Seeking((words) => announcer.announce(words)),
];

function mark(...names) {
  for (const name of names) changed.add(name);
  if (frameRequested || !ready || document.hidden) return;
  frameRequested = true;
  requestAnimationFrame(draw);
}

function draw(now) {
  frameRequested = false;
  const news = changed;
  changed = new Set();
  const t = pace.at(state, now);
  let drew = false;
  for (const panel of panels) {
    if (isGuided(state) && !WHILE_GUIDING.some((kind) => panel instanceof kind)) continue; // it is hidden
    const due = uses(panel, news) || (panel === ribbon && pace.moving) || (panel === track && track.moving);
    if (!due) continue;
    if (panel.draw(state, now, news, t) === "done") drew = true;
    else later(panel, news);
  }
  looking.draw(state);
  if (news.has("scene")) heading();
  arrange();
  if (drew) seen.frames += 1;
  if (pace.moving || track.moving || changed.size > 0) mark();
}

const isGuided = ({ posture, toe_out }) => posture !== null || toe_out !== null;

const uses = (panel, news) => panel.uses.some((name) => news.has(name));

// Marks the changes that a panel did not draw yet, for a later frame.
function later(panel, news) {
  for (const name of news) if (panel.uses.includes(name)) changed.add(name);
}

const SOURCES = { live: "live sensors", demo: "an emulated walk", recording: "a recording" };

function heading() {
  write(element("title"), state.source === "demo" ? `${state.title} · ${SOURCES.demo}` : state.title);
  write(element("source"), wordOf(SOURCES, state.source));
  write(element("recipe"), state.recipe);
  document.body.classList.toggle("measuring", isGuided(state));
  document.body.classList.toggle("has-plan", state.plan !== null);
  document.body.classList.toggle("has-levels", (state.plan?.levels.length ?? 0) > 1);
  document.title = state.title ? `${state.title} – solepath` : "solepath";
}

// Which regions there are follows from the sensors; what was shown once stays, so that nothing moves.
function arrange() {
  const { soles } = document.body.dataset;
  if (state.known) document.body.dataset.known = "";
  if (state.soles !== "unknown" && soles !== "cells" && soles !== state.soles) document.body.dataset.soles = state.soles;
}

const connection = new Connection(
  (message) => {
    const news = state.take(message);
    seen.messages += 1;
    if (news.size === 0 && message?.type !== "frame") return;
    pace.update(state, performance.now());
    announcer.update(state, news);
    mark(...news);
  },
  (() => {
    let timer = 0;
    let was = "";
    return (how, wait) => {
      clearInterval(timer);
      const at = performance.now() + 1000 * wait;
      const show = () => {
        element("connection").dataset.state = how;
        notice.connection = how === "open" ? "" : capital(WORDS[how]);
        if (how === "open" || how === "ended") state.over = how === "ended" && WORDS.finishes;
        mark("links", "activity");
        // while the first connection is tried, no alarm is needed
        element("offline").hidden = how === "open" || (how === "connecting" && was === "");
        const left = Math.ceil((at - performance.now()) / 1000);
        const next = how === "connecting" || left < 1 ? "Trying now" : `Trying again in ${left} s`;
        const ended = how === "ended" || (how === "connecting" && was === "ended");
        const why = ended
          ? `${WORDS.whyEnded}${state.known ? "; what you see is the last of it" : ""}.`
          : `${WORDS.whyClosed}${state.known ? "; what you see is old" : ""}.`;
        write(element("offline-words"), how === "ended" ? why : `${why} ${next}.`);
        element("offline").dataset.why = ended ? "ended" : "closed";
      };
      show();
      if (how === "closed" || how === "ended") {
        timer = setInterval(show, 1000);
        if (was !== how) {
          announcer.announce(how === "ended" ? WORDS.whyEnded : WORDS.lost);
        }
        was = how;
      }
      if (how === "open") {
        if (was === "closed" || was === "ended") announcer.announce(WORDS.again);
        was = "open";
      }
      document.body.classList.toggle("old", how !== "open" && state.known);
    };
  })(),
);

element("show-feet").addEventListener("click", ({ currentTarget: button }) => {
  track.feetShown = !track.feetShown;
  button.setAttribute("aria-pressed", String(track.feetShown));
  element("track-section").dataset.feet = track.feetShown ? "shown" : "";
  mark("scene");
});
write(element("retry"), WORDS.retry);
element("retry").addEventListener("click", () => connection.retry());
document.addEventListener("visibilitychange", () => {
  frameRequested = false; // a frame that was requested before may never have come
  if (!document.hidden) mark("scene", "theme", "feet", "links", "gait", "activity");
});
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
  const { target, key } = event;
  if (target.matches("select, textarea, input:not([type=range])")) return;
  if (key === " " && target.closest("button, summary")) return; // on a button the space bar presses it
  if (playback.key(key, event.shiftKey) || looking.key(key) || here.key(key)) event.preventDefault();
});
setInterval(() => mark("second"), 1000);
keepClear();
startTheme(element("theme"), () => mark("theme"));
ready = true;
mark("scene");
