// Which feet the track and the figures may come from.

import { FEET, capital } from "./words.js";

const siteOf = (foot) => `${foot} foot`;
const isFaulty = ({ spoilt }, foot) => spoilt.includes(foot);
export const isBroken = (link) => link?.state === "lost" || link?.state === "silent";
const OVER = ["finished", "computing"]; // situations in which nothing is expected of a foot
export const isGone = ({ links, situation }, foot) => !OVER.includes(situation) && isBroken(links[siteOf(foot)]);

// Feet whose data cannot be right, or which send nothing now.
export const unsound = (state) => FEET.filter((foot) => isFaulty(state, foot) || isGone(state, foot));

// True while a foot sends what cannot be right: then the place is not right either.
export const isWrong = (state) => FEET.some((foot) => isFaulty(state, foot) && !isGone(state, foot));

// False if what comes as one foot may be the other's.
export const sidesKnown = ({ findings }) => !findings.some(({ site, act }) => act && site === "");

// How far the drawn track can be trusted: "none" if a foot's data are wrong, "old" if a foot sends no more, else "".
export const trustOf = (state) => (isWrong(state) ? "none" : FEET.some((foot) => isGone(state, foot)) ? "old" : "");

// The same in words; "" if there is nothing to say.
export function trustWords(state) {
  const trust = trustOf(state);
  if (trust !== "old") return trust === "" ? "" : "Not to be trusted: the data of a sensor are wrong.";
  const left = FEET.filter((foot) => !isGone(state, foot) && state.feet[foot] !== null);
  return left.length === 1 ? `${capital(left[0])} foot only: the wearer may be outside the dashed area.` : "No data: the last known place.";
}

// Feet that the figures of the walk come from: those that are sound, or else all that sent.
function counted(state) {
  const known = FEET.filter((foot) => state.feet[foot] !== null);
  const sound = known.filter((foot) => !unsound(state).includes(foot));
  return sound.length > 0 ? sound : known;
}

// Distance walked, m: each foot goes about as far as the wearer.
export function distance(state) {
  const lengths = counted(state).map((foot) => state.feet[foot].distance);
  return lengths.reduce((a, b) => a + b, 0) / lengths.length;
}

// Mean speed and cadence of the whole walk: of both feet, or of the one that is sound.
export function means(state) {
  const { total } = state;
  const bad = unsound(state);
  if (total === null || bad.length !== 1) return total ?? {};
  const foot = FEET.find((one) => !bad.includes(one));
  const of = (name) => total.rows.find((row) => row.name === name)?.[foot] ?? NaN;
  return { speed: of("speed"), cadence: 120 / of("stride_time"), rows: total.rows };
}

// What the figures come from, where that is not both feet; "" where it is.
export function sourceWords(state) {
  const bad = unsound(state);
  if (bad.length === FEET.length) return "figures not reliable";
  return bad.length === 0 ? "" : `${FEET.find((foot) => !bad.includes(foot))} foot only`;
}
