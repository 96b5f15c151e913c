// Which feet the figures may come from.

import { FEET } from "./readers.js";

const isOf = (foot) => ({ site, act }) => act && site === `${foot} foot`;

// Feet whose figures cannot be right until somebody acts, or which send nothing now.
export function unsound({ findings, links, finished }) {
  const stopped = (foot) => !finished && ["lost", "silent"].includes(links[`${foot} foot`]?.state);
  return new Set(FEET.filter((foot) => findings.some(isOf(foot)) || stopped(foot)));
}

// True while a foot sends what cannot be right: then the place is not right either.
export const isWrong = ({ findings, links }) => FEET.some((foot) => findings.some(isOf(foot)) && links[`${foot} foot`]?.state === "ok");

// False if what comes as one foot may be the other's.
export const sidesKnown = ({ findings }) => !findings.some(({ site, act }) => act && site === "");

// Distance walked, m: each foot goes about as far as the wearer. Of both feet, or of the one that is sound.
export function distance(state) {
  const bad = unsound(state);
  const known = FEET.filter((foot) => state.feet[foot] !== null);
  const sound = known.filter((foot) => !bad.has(foot));
  const lengths = (sound.length > 0 ? sound : known).map((foot) => state.feet[foot].distance || 0);
  return lengths.reduce((a, b) => a + b, 0) / lengths.length;
}

// Mean speed and cadence of the whole walk: of both feet, or of the one that is sound.
export function means(state) {
  const { total } = state;
  const bad = unsound(state);
  if (total === null || bad.size !== 1) return total ?? {};
  const foot = FEET.find((one) => !bad.has(one));
  const of = (name) => total.rows.find((row) => row.name === name)?.[foot] ?? NaN;
  return { speed: of("speed"), cadence: 120 / of("stride_time"), rows: total.rows };
}

// What the figures come from, where that is not both feet; "" where it is.
export function sourceWords(state) {
  const bad = unsound(state);
  if (bad.size === 0) return "";
  if (bad.size === FEET.length) return "figures not reliable";
  return `${FEET.find((foot) => !bad.has(foot))} foot only`;
}
