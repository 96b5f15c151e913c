// How far the drawn track can be trusted: "none" if a check found that a foot's data are wrong, "old" if a foot that sent
// sends no more, else "".

import { FEET } from "./state.js";
import { capital } from "./words.js";

const isGone = (links, site) => ["lost", "silent"].includes(links[site]?.state);

export function trustOf({ findings, links }) {
  const sites = FEET.map((foot) => `${foot} foot`);
  if (findings.some(({ site, act }) => act && sites.includes(site) && !isGone(links, site))) return "none";
  return sites.some((site) => isGone(links, site)) ? "old" : "";
}

// In words; "" if there is nothing to say.
export function trustWords(state) {
  const trust = trustOf(state);
  if (trust === "none") return "Not to be trusted: the data of a sensor are wrong.";
  if (trust === "") return "";
  const left = FEET.filter((foot) => !isGone(state.links, `${foot} foot`) && state.feet[foot] !== null);
  return left.length === 1 ? `${capital(left[0])} foot only: the wearer may be outside the dashed area.` : "No data: the last known place.";
}
