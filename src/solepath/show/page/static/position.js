// Position of the wearer in words.

import { axes } from "./marks.js";
import { trustWords } from "./trust.js";
import { fixed, percent } from "./words.js";

// The wearer is between the feet; a foot's line has a point a stride, and nothing measures the distance between the feet.
const EACH_FOOT = "Each foot’s own path: they differ by what the sensors cannot know, most at turns. The wearer is between them.";

const [SURE, PROBABLE] = [0.9, 0.5]; // least weights of a place that is called almost sure, and probable

export const nameOf = (plan, id) => plan?.levels.find((level) => level.id === id)?.name ?? id;

// A name that is a mere number is that of a door.
const atDoor = (door) => (/^\d/.test(door) ? `at door ${door}` : `at ${door}`);

// Level of the wearer, and the room and a door close by if they have names.
export function whereOf(plan, { level, room, door }) {
  return [nameOf(plan, level), room, door && atDoor(door)].filter(Boolean).join(", ");
}

// Note over a drawing of this level; "" when there is none: the words above the drawing name the wearer's room.
export function noteOnPlan(state, level) {
  const { place, places, plan } = state;
  if (!place) return places.length > 0 ? "The place was lost; the track by itself goes on." : "Where on the plan is not known yet.";
  if (place.decided) return place.level === level.id ? trustWords(state) : `The wearer is on ${whereOf(plan, place)}.`;
  const others = place.candidates.length - 1;
  const rest = others > 1 ? `${others} other places are` : "another place is";
  return `${likeliestOf(plan, place)}${others > 0 && !isSure(place) ? `; ${rest} possible` : ""}.`;
}

// The likeliest of several places by its weight, which says how the words begin.
export function likeliestOf(plan, place) {
  const { weight } = place.candidates[0];
  return `${isSure(place) ? "Almost surely" : weight >= PROBABLE ? "Probably" : "Perhaps"} ${whereOf(plan, place)}, ${percent(weight)}`;
}

const isSure = ({ candidates }) => candidates[0].weight >= SURE;

// Note on the track without a plan.
export function noteAlone(state, feetShown) {
  const { place, places, plan } = state;
  if (trustWords(state) || feetShown) return trustWords(state) || EACH_FOOT;
  return plan && !place && places.length === 0 ? "Where on the plan is not known yet; this is the track by itself." : "";
}

export function spokenOnPlan(state, level) {
  const { place, plan } = state;
  if (!place?.decided) return `Floor plan, ${level.name}. ${noteOnPlan(state, level)}`;
  const [x, y] = place.position.map((metres) => `${fixed(metres, 1)} m`);
  const within = place.spread === null ? "" : `, within about ${fixed(place.spread, 1)} m`;
  return `Floor plan, ${level.name}. The wearer is on ${whereOf(plan, place)} at ${x}, ${y}${within}`;
}

export function spokenTrack({ wearer }) {
  if (!wearer) return "Track: no stride yet";
  const [x, y] = wearer.position;
  const ahead = `${fixed(Math.abs(x), 1)} m ${x < 0 ? "behind" : "ahead of"} the start`;
  const aside = `${fixed(Math.abs(y), 1)} m to the ${y < 0 ? "right" : "left"}`;
  const within = wearer.covariance ? `, 95 % sure within ${fixed(axes(wearer.covariance).long, 1)} m` : "";
  return `Track: the wearer is ${ahead} and ${aside}${within}`;
}
