// What the page shows, as one of thirteen situations (docs/browser.md). TABLE says which of them follows from what
// happens. All that the page says of a situation is in SHOWN: words follow from it and from numbers.

import { WORDS } from "./connection.js";
import { linksText } from "./links.js";
import { axes } from "./marks.js";
import { likeliestOf, nameOf, whereOf } from "./position.js";
import { distance, isBroken, isWrong, trustOf } from "./trust.js";
import { activityText, capital, clock, fixed, span } from "./words.js";

const OF_A_WALK = ["connected", "walking", "lost", "resumed"];
const OF_A_RECORDING = ["playing", "paused", "finished"];

// What happens: the situation that follows, and those in which it changes nothing.
export const TABLE = {
  compute: ["computing", ["connecting", ...OF_A_WALK]],
  idle: ["choosing", ["refused"]],
  unable: ["no-bluetooth", []],
  choose: ["choosing", ["connecting", ...OF_A_WALK, ...OF_A_RECORDING]],
  refuse: ["refused", [...OF_A_WALK, ...OF_A_RECORDING]],
  connect: ["connecting", ["refused"]],
  link: ["connected", []],
  data: ["walking", []],
  lose: ["lost", []],
  resume: ["resumed", []],
  play: ["playing", []],
  pause: ["paused", []],
  end: ["finished", []],
  fail: ["failed", []],
};

export function next(situation, happened) {
  const [to, unchanged] = TABLE[happened];
  return unchanged.includes(situation) ? situation : to;
}

// What happens by the newest messages and by what the program says of itself; null while neither says anything.
export function happening({ known, links, playback, program, source, strides }) {
  const { bluetooth, free, link, sensors, task, walk } = program;
  if (link === "ended" && WORDS.finishes && known && source === "live" && strides !== null) return "end";
  if (link === "closed" || link === "ended") return "fail";
  if (free && !known) return bluetooth ? "idle" : "unable";
  if (link === "connecting" || !known) return null;
  if (task) return "compute";
  if (playback !== null) return { playing: "play", paused: "pause", ended: "end" }[playback.state];
  if (walk === null) return strides !== null ? "end" : bluetooth ? "idle" : "unable";
  const isConnected = (sensors ?? Object.values(links)).some(({ connected, name }) => connected ?? name !== "");
  if (walk.resumed && !isConnected) return sensors.length > 0 ? "connect" : "resume";
  if (strides !== null) return Object.values(links).some(isBroken) ? "lose" : "data";
  return isConnected ? "link" : sensors?.length === 0 ? "idle" : "connect";
}

// The words: of the line at the top (a banner is over it when all has failed), the heading, the line below it, and what a
// person may do, in place of the figures.
const PURPOSE = "solepath measures how you walk, and where, with sensors in your shoes.";
const FIRST = "Stand still for a moment, then walk. The figures come with the first strides.";

const SHOWN = {
  computing: ({ program: { task } }) => ({
    line: task ? "Computing" : "Starting",
    headline: "One moment",
    where: task ? "" : WORDS.starting,
    help: task ? `${task} is computed on this device. Nothing leaves it.` : WORDS.startHelp,
  }),
  "no-bluetooth": ({ program }) => ({ line: "No sensor can be reached", headline: "No Bluetooth", where: "in this browser", help: program.why }),
  choosing: () => ({ line: "No sensor is connected", headline: "Choose a sensor", where: "one for each shoe", help: PURPOSE }),
  refused: ({ program }) => ({ line: "No sensor is connected", headline: "Not connected", where: "nothing is measured", help: program.refusal }),
  connecting: ({ program }) => {
    const names = (program.sensors ?? []).map(({ name }) => name).join(", ");
    return {
      line: `Connecting to ${names || "the sensors"}`,
      headline: "Connecting",
      where: `to ${names || "the sensors"}`,
      help: "Keep the sensors near and switched on. The connection is tried until it succeeds.",
    };
  },
  connected: () => ({ line: "Connected, no data yet", headline: "Connected", where: "no data yet", help: "The first data come in a moment." }),
  walking: (state) => ({ line: linksText(state), headline: doing(state), where: place(state), help: hasFigures(state) ? "" : FIRST }),
  lost: (state) => ({ line: linksText(state), headline: isReady(state) ? "No data" : doing(state), where: place(state), help: "" }),
  resumed: () => ({
    line: "No sensor is connected",
    headline: "Walk goes on",
    where: "connect the sensors again",
    help: "This page was closed meanwhile. Connect each sensor again, worn as it was.",
  }),
  playing: (state) => ({ line: linksText(state), headline: doing(state), where: place(state), help: hasFigures(state) ? "" : "The figures come with the first strides." }),
  paused: (state) => ({ line: `Paused at ${clock(state.t - state.start)}`, headline: "Paused", where: place(state), help: "" }),
  finished: (state) => ({
    line: linksText(state),
    headline: "Finished",
    where: state.strides > 0 ? `after ${lasted(state)}` : summary(state),
    help: state.strides > 0 ? "" : "No stride was found.",
  }),
  failed: ({ strides }) => ({ line: "", headline: WORDS.failed, where: strides > 0 ? "what you see is the last of it" : "", help: "" }),
};

export const SITUATIONS = Object.keys(SHOWN);

// {line, headline, where, help}: words of the present situation.
export const words = (state) => SHOWN[state.situation](state);

// Cells alone give a cadence without strides.
const hasFigures = ({ strides, pace }) => strides > 0 || Number.isFinite(pace?.cadence);
const isReady = ({ activity, strides }) => activity === null || (strides === 0 && activity.last === null && activity.now === "UNKNOWN");
const doing = (state) => (isReady(state) ? "Ready" : activityText(state.activity));

function place(state) {
  const { activity, strides, place, plan, wearer } = state;
  if (plan !== null && place !== null) {
    if (!place.decided) return likeliestOf(plan, place);
    const inLift = activity?.now.startsWith("ELEVATOR");
    return capital(inLift ? [nameOf(plan, place.level), place.door].filter(Boolean).join(", ") : whereOf(plan, place));
  }
  if (!(strides > 0)) return "at the start";
  if (wearer === null) return "";
  return isWrong(state) ? "place not reliable" : `${fixed(Math.hypot(wearer.position[0], wearer.position[1]))} m from the start`;
}

// How far the place may be off, in words; "" where that is not known or of no use.
export function confidence(state) {
  const { place, plan, wearer } = state;
  if (trustOf(state) !== "") return "";
  const off = plan !== null && place !== null ? (place.decided ? place.spread : null) : wearer?.covariance && axes(wearer.covariance).long;
  return off ? `sure within ${fixed(off, off < 9.95 ? 1 : 0)} m` : "";
}

const lasted = ({ playback, t, start }) => span(playback === null ? t - start : playback.end - playback.begin);

// The whole walk in a sentence.
export function summary(state) {
  const { strides } = state;
  if (!(strides > 0)) return `No stride in ${lasted(state)}`;
  return `${fixed(distance(state))} m in ${lasted(state)}, ${strides} strides of each foot`;
}
