// State of each sensor's link. A lost link, and what a person must mend, are also shown at the top of the page.

import { LINKS, capital, child, fixed, percent, wordOf, show, span, setData, write } from "./words.js";

export class Links {
  uses = ["links", "scene"];

  constructor() {
    this.list = document.getElementById("links");
    this.waiting = document.getElementById("links-waiting");
    this.banner = document.getElementById("link-banner");
    this.sites = new Map();
  }

  draw({ links }) {
    const names = Object.keys(links).sort();
    show(this.waiting, names.length === 0);
    if (names.join("\n") !== [...this.sites.keys()].join("\n")) {
      this.sites = new Map(names.map((name) => [name, new Link(name)]));
      this.list.replaceChildren(...[...this.sites.values()].map((link) => link.element));
    }
    for (const [name, link] of this.sites) link.show(links[name]);
    const broken = names.filter((name) => ["lost", "silent"].includes(links[name].state));
    const lost = broken.map((name) => {
      const { state, silent_for } = links[name];
      const since = Number.isFinite(silent_for) ? ` for ${span(silent_for)}` : "";
      return `${capital(name)} ${wordOf(LINKS, state)}: no data${since}.`;
    });
    const faulty = names.filter((name) => typeof links[name].trouble === "string" && links[name].trouble);
    const words = [...lost, ...faulty.map((name) => `${capital(name)}: ${links[name].trouble}.`)];
    show(this.banner, words.length > 0);
    write(this.banner, words.join(" "));
    return "done";
  }
}

class Link {
  constructor(name) {
    this.element = document.createElement("li");
    this.element.dataset.site = name;
    const head = child(this.element, "p", "link-name");
    child(head, "b").textContent = capital(name);
    this.state = child(head, "span", "link-state");
    this.device = child(head, "span", "link-device");
    const figures = child(this.element, "dl", "link-figures");
    this.figures = Object.fromEntries(
      ["rate", "loss", "lost", "battery", "signal", "gaps", "rejected"].map((title) => {
        const pair = child(figures, "div");
        child(pair, "dt").textContent = title;
        pair.dataset.figure = title;
        return [title, { pair, value: child(pair, "dd") }];
      }),
    );
    this.trouble = child(this.element, "p", "trouble");
  }

  show(link) {
    setData(this.element, { state: link.state ?? "waiting" });
    const silent = Number.isFinite(link.silent_for) && link.state !== "ok" ? `, ${span(link.silent_for)}` : "";
    write(this.state, wordOf(LINKS, link.state ?? "waiting") + silent);
    write(this.device, typeof link.name === "string" ? link.name : "");
    this.#figure("rate", `${fixed(link.rate)} Hz`, Number.isFinite(link.rate));
    this.#figure("loss", percent(link.loss, 1), Number.isFinite(link.loss)); // recent loss
    this.#figure("lost", fixed(link.lost), link.lost > 0);
    this.#figure("battery", percent(link.battery), Number.isFinite(link.battery));
    this.#figure("signal", `${fixed(link.signal)} dBm`, Number.isFinite(link.signal));
    this.#figure("gaps", fixed(link.gaps), link.gaps > 0);
    this.#figure("rejected", fixed(link.rejected), link.rejected > 0);
    write(this.trouble, typeof link.trouble === "string" ? link.trouble : "");
    show(this.trouble, this.trouble.textContent !== "");
  }

  #figure(title, words, known) {
    const { pair, value } = this.figures[title];
    show(pair, known);
    write(value, words);
  }
}
