// The line at the top: what needs attention, in words, the worst first; else one sentence on the links. Its height never
// changes, so that nothing below it moves: all of it is in a list above the page.

import { linksText, losesMany, problems } from "./links.js";
import { capital, child, setData, write } from "./words.js";

export class Notice {
  uses = ["links", "findings", "playback", "scene"];
  connection = "connecting"; // words while the page has no connection, "" while it has

  constructor() {
    for (const id of ["notice", "notice-quiet", "notice-words", "notice-all", "notice-list", "findings"]) this[id] = document.getElementById(id);
    this.listed = "";
  }

  draw(state) {
    const all = attention(state);
    const level = all.some(({ act }) => act) ? "bad" : all.length > 0 ? "note" : "quiet";
    setData(this.notice, { level, loss: losesMany(state) });
    write(this["notice-quiet"], this.connection || (state.known ? linksText(state) : ""));
    this.#say(all.length > 0 ? all[0].brief : "");
    this["notice-all"].style.visibility = all.length > 0 ? "" : "hidden";
    write(this["notice-all"], all.length > 1 ? `${all.length} messages` : "Details");
    if (all.length === 0 && this["notice-list"].matches(":popover-open")) this["notice-list"].hidePopover();
    const key = all.map(({ words }) => words).join("\n");
    if (key === this.listed) return "done";
    this.listed = key;
    this.findings.replaceChildren();
    for (const { brief, words, act } of all) {
      const item = child(this.findings, "li");
      setData(item, { act });
      if (brief !== words) write(child(item, "b"), brief);
      child(item, "p").textContent = words;
    }
    return "done";
  }

  // Other words are a new element: in one, a browser would count a second line as a move of the first.
  #say(words) {
    const old = this["notice-words"];
    if (old.textContent === words) return;
    this["notice-words"] = old.cloneNode(false);
    this["notice-words"].textContent = words;
    old.replaceWith(this["notice-words"]);
  }
}

// {brief, words, act}: what the checks found, and what is wrong with the links; what must be acted on first. brief is one
// plain sentence for the line at the top.
export function attention(state) {
  const found = state.findings.map(({ site, brief, what, act }) => {
    const words = capital(site ? `${site}: ${what}` : what);
    return { brief: capital(brief) || words, words, act };
  });
  const texts = found.map(({ words }) => words);
  // a link repeats a defect as its trouble
  const links = problems(state).filter((words) => !texts.some((text) => words.startsWith(text))).map((words) => ({ brief: words, words, act: true }));
  return [...links, ...found].sort((a, b) => b.act - a.act);
}
