// State of each sensor's link: one sentence, and what is known of each below it, which opens when something is wrong.

import { isBroken } from "./trust.js";
import { LINKS, capital, child, element, fixed, note, percent, sentence, setData, span, wordOf, write } from "./words.js";

const HIGH_LOSS = 0.05; // share of samples missing from which on a link is marked; accuracy is stated for up to so much
const LOW_BATTERY = 0.15; // charge from which down the battery may be why nothing comes
const RECORDED = { ok: "recorded", silent: "no data", lost: "lost", waiting: "no data yet" };

// Names and links of those that are so, in order.
const those = (links, is) => Object.keys(links).sort().filter((name) => is(links[name]));
const isFaulty = ({ trouble }) => trouble !== "";

// What is wrong with the links: a sentence each, for the person who can repair it.
export function problems({ links, finished, source }) {
  if (finished) return [];
  const lost = those(links, isBroken).map((name) => {
    const { silent_for, battery } = links[name];
    const since = silent_for === null ? "" : ` for ${span(silent_for)}`;
    const charged = battery > LOW_BATTERY ? " and switched on?" : ", switched on and charged?";
    return `${capital(name)}: no data${since}.${source === "live" ? ` Is the sensor near${charged}` : ""}`;
  });
  return [...lost, ...those(links, isFaulty).map((name) => sentence(`${name}: ${links[name].trouble}`))];
}

// One sentence on all links.
export function linksText({ links, source, finished }) {
  const names = Object.keys(links).sort();
  if (names.length === 0) return "No data from any sensor yet";
  const [broken, faulty, waiting] = [isBroken, isFaulty, ({ state }) => state === "waiting"].map((is) => those(links, is).join(" and "));
  if (broken && !finished) return `${capital(broken)}: no data`;
  if (faulty) return `${capital(faulty)}: attention is needed`;
  if (waiting) return `${capital(waiting)}: waiting for data`;
  const all = names.length === 1 ? capital(names[0]) : names.length === 2 ? "Both sensors" : `All ${names.length} sensors`;
  const some = `${all} ${source === "recording" || finished ? "recorded" : source === "demo" ? "emulated" : "connected"}`;
  const sum = (key) => names.reduce((total, name) => total + links[name][key], 0);
  const most = mostLost(links);
  if (!finished && most > 0) return `${some}, ${shareText(most)} missing`;
  if (finished && sum("missing") > 0) return `${some}, ${counted(sum("missing"), "sample")} missing`;
  if (finished && sum("absent") > 0) return `${some}, absent for ${fixed(sum("absent"), 1)} s`;
  if (sum("missing") + sum("absent") === 0) return `${some}, no data lost`;
  return `${some}, ${finished ? "with some data lost" : "no data lost now"}`;
}

const mostLost = (links) => Math.max(0, ...Object.values(links).map(({ recent_share }) => recent_share ?? 0));
const shareText = (share) => percent(share, share < 0.0995 ? 1 : 0);
const counted = (count, word) => `${fixed(count)} ${word}${count === 1 ? "" : "s"}`;

// True while more samples are missing than the stated limit.
export const losesMany = ({ links, finished }) => !finished && mostLost(links) > HIGH_LOSS;

// What is known of a link; false where there is nothing to say.
const FIGURES = {
  rate: ({ rate }) => rate !== null && `${fixed(rate)} samples a second`,
  recent: ({ recent_share }) => recent_share !== null && `${shareText(recent_share)} of samples missing`,
  missing: ({ missing: n, missing_share: share }) => n > 0 && `${counted(n, "sample")} missing since the start (${percent(share, 1)})`,
  gaps: ({ gaps }) => gaps > 0 && counted(gaps, "interruption"),
  absent: ({ absent }) => absent > 0 && `absent for ${fixed(absent, 1)} s`,
  rejected: ({ rejected }) => rejected > 0 && `${counted(rejected, "packet")} rejected`,
  delay: ({ delay }) =>
    Object.keys(delay).length > 0 &&
    `contacts late by ${Object.entries(delay)
      .map(([part, [median, most]]) => `${part} ${fixed(median)} ms (95 %: ${fixed(most)})`)
      .join(" + ")}`,
  battery: ({ battery }) => battery !== null && `battery ${percent(battery)}`,
  signal: ({ signal }) => signal !== null && `signal ${fixed(signal)} dBm`,
};

export class Links {
  uses = ["links", "findings", "playback", "situation", "scene"];
  #opened = false; // by itself
  #shown = new Map();

  draw(state) {
    const { links, source, findings } = state;
    const names = Object.keys(links).sort();
    if (names.join("\n") !== [...this.#shown.keys()].join("\n")) {
      element("links").replaceChildren();
      this.#shown = new Map(names.map((name) => [name, new Link(name)]));
    }
    for (const [name, link] of this.#shown) {
      const fault = isFaulty(links[name]) || findings.some(({ site, act }) => act && site === name);
      link.show(links[name], source === "live" ? LINKS : RECORDED, fault);
    }
    write("links-summary", linksText(state));
    const wrong = problems(state).length > 0;
    setData("links-summary", { wrong });
    if (wrong !== this.#opened) element("links-fold").open = this.#opened = wrong;
  }
}

class Link {
  constructor(name) {
    this.element = child(element("links"), "li");
    setData(this.element, { site: name });
    const head = child(this.element, "p", "link-name");
    child(head, "b", "", capital(name));
    this.state = child(head, "span", "link-state");
    this.device = child(head, "span", "link-device");
    const figures = child(this.element, "ul", "link-figures");
    this.figures = Object.values(FIGURES).map(() => child(figures, "li"));
    this.trouble = child(this.element, "p", "trouble");
  }

  show(link, words, fault) {
    setData(this.element, { state: link.state, fault });
    write(this.state, wordOf(words, link.state) + (link.silent_for === null ? "" : `, ${span(link.silent_for)}`));
    write(this.device, link.name);
    Object.values(FIGURES).forEach((text, i) => note(this.figures[i], text(link) || ""));
    note(this.trouble, link.trouble);
  }
}
