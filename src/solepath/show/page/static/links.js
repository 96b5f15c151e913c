// State of each sensor's link: one sentence, and what is known of each below it, which opens when something is wrong.

import { LINKS, capital, child, fixed, percent, wordOf, show, span, setData, write } from "./words.js";

const HIGH_LOSS = 0.05; // share of samples missing from which on a link is marked; accuracy is stated for up to so much
const LOW_BATTERY = 0.15; // charge from which down the battery may be why nothing comes

const RECORDED = { ok: "recorded", silent: "no data", lost: "lost", waiting: "no data yet" };
const isBroken = ({ state }) => state === "lost" || state === "silent";
const troubleOf = ({ trouble }) => (typeof trouble === "string" ? trouble : "");

// What is wrong with the links: a sentence each, for the person who can repair it.
export function problems({ links, finished, source }) {
  if (finished) return [];
  const names = Object.keys(links).sort();
  const lost = names.filter((name) => isBroken(links[name])).map((name) => {
    const { silent_for, battery } = links[name];
    const since = Number.isFinite(silent_for) ? ` for ${span(silent_for)}` : "";
    const charged = Number.isFinite(battery) && battery > LOW_BATTERY;
    const todo = source !== "live" ? "" : charged ? " Is the sensor near and switched on?" : " Is the sensor near, switched on and charged?";
    return `${capital(name)}: no data${since}.${todo}`;
  });
  const faulty = names.filter((name) => troubleOf(links[name]) !== "");
  return [...lost, ...faulty.map((name) => `${capital(name)}: ${troubleOf(links[name])}.`)];
}

// One sentence on all links.
export function linksText({ links, source, finished }) {
  const names = Object.keys(links).sort();
  if (names.length === 0) return "No data from any sensor yet";
  const broken = names.filter((name) => isBroken(links[name]));
  if (broken.length > 0 && !finished) return `${capital(broken.join(" and "))}: no data`;
  const faulty = names.filter((name) => troubleOf(links[name]) !== "");
  if (faulty.length > 0) return `${capital(faulty.join(" and "))}: attention is needed`;
  const waiting = names.filter((name) => links[name].state === "waiting");
  if (waiting.length > 0) return `${capital(waiting.join(" and "))}: waiting for data`;
  const all = names.length === 1 ? capital(names[0]) : names.length === 2 ? "Both sensors" : `All ${names.length} sensors`;
  const verb = source === "recording" || finished ? "recorded" : source === "demo" ? "emulated" : "connected";
  const some = names.map((name) => links[name]);
  const most = mostLost(links);
  if (!finished && most > 0) return `${all} ${verb}, ${lossText(most)}`;
  const ever = some.reduce((sum, { missing, gaps }) => sum + (missing > 0) + (gaps > 0), 0);
  const samples = some.reduce((sum, { missing }) => sum + (missing > 0 ? missing : 0), 0);
  if (finished && samples > 0) return `${all} ${verb}, ${counted(samples, "sample")} missing`;
  return ever === 0 ? `${all} ${verb}, no data lost` : `${all} ${verb}${finished ? ", with some data lost" : ", no data lost now"}`;
}

const mostLost = (links) => Math.max(0, ...Object.values(links).map(({ recent_share }) => (Number.isFinite(recent_share) ? recent_share : 0)));
const lossText = (share) => `${percent(share, share < 0.0995 ? 1 : 0)} of samples missing`;
const counted = (count, word) => `${fixed(count)} ${word}${count === 1 ? "" : "s"}`;

// True while more samples are missing than the stated limit.
export const losesMany = ({ links, finished }) => !finished && mostLost(links) > HIGH_LOSS;

export class Links {
  uses = ["links", "findings", "playback", "scene"];
  #opened = false; // by itself

  constructor() {
    this.list = document.getElementById("links");
    this.fold = document.getElementById("links-fold");
    this.summary = document.getElementById("links-summary");
    this.sites = new Map();
  }

  draw(state) {
    const { links, source } = state;
    const names = Object.keys(links).sort();
    if (names.join("\n") !== [...this.sites.keys()].join("\n")) {
      this.sites = new Map(names.map((name) => [name, new Link(name)]));
      this.list.replaceChildren(...[...this.sites.values()].map((link) => link.element));
    }
    for (const [name, link] of this.sites) {
      link.show(links[name], source === "live" ? LINKS : RECORDED);
      setData(link.element, { fault: state.findings.some(({ site, act }) => act && site === name) || troubleOf(links[name]) !== "" });
    }
    write(this.summary, linksText(state));
    const wrong = problems(state).length > 0;
    setData(this.summary, { wrong });
    if (wrong !== this.#opened) this.fold.open = this.#opened = wrong;
    return "done";
  }
}

const FIGURES = ["rate", "recent", "missing", "gaps", "rejected", "battery", "signal"];

class Link {
  constructor(name) {
    this.element = document.createElement("li");
    this.element.dataset.site = name;
    const head = child(this.element, "p", "link-name");
    child(head, "b").textContent = capital(name);
    this.state = child(head, "span", "link-state");
    this.device = child(head, "span", "link-device");
    const figures = child(this.element, "ul", "link-figures");
    this.figures = Object.fromEntries(
      FIGURES.map((title) => {
        const item = child(figures, "li");
        item.dataset.figure = title;
        return [title, item];
      }),
    );
    this.trouble = child(this.element, "p", "trouble");
  }

  show(link, words) {
    setData(this.element, { state: link.state ?? "waiting" });
    const silent = Number.isFinite(link.silent_for) && link.state !== "ok" ? `, ${span(link.silent_for)}` : "";
    write(this.state, wordOf(words, link.state ?? "waiting") + silent);
    write(this.device, typeof link.name === "string" ? link.name : "");
    this.#figure("rate", `${fixed(link.rate)} samples a second`, Number.isFinite(link.rate));
    this.#figure("recent", lossText(link.recent_share), Number.isFinite(link.recent_share));
    const share = percent(link.missing_share, 1);
    this.#figure("missing", `${counted(link.missing, "sample")} missing since the start (${share})`, link.missing > 0);
    this.#figure("gaps", counted(link.gaps, "interruption"), link.gaps > 0);
    this.#figure("rejected", `${counted(link.rejected, "packet")} rejected`, link.rejected > 0);
    this.#figure("battery", `battery ${percent(link.battery)}`, Number.isFinite(link.battery));
    this.#figure("signal", `signal ${fixed(link.signal)} dBm`, Number.isFinite(link.signal));
    write(this.trouble, troubleOf(link));
    show(this.trouble, this.trouble.textContent !== "");
  }

  #figure(title, words, known) {
    show(this.figures[title], known);
    write(this.figures[title], words);
  }
}
