// The line at the top: what needs attention, in words, the worst first; else one sentence on the links. Its height never
// changes, so that nothing below it moves: all of it is in a list above the page. And the log of what happened.

import { losesMany, problems } from "./links.js";
import { words } from "./situation.js";
import { capital, child, clock, element, setData, show, write } from "./words.js";

const IDLE = ["computing", "no-bluetooth", "choosing", "refused", "connecting", "resumed", "failed"]; // nothing comes that could be wrong

export class Notice {
  uses = ["links", "findings", "playback", "situation", "scene"];
  #listed = "";

  draw(state) {
    const all = attention(state);
    const level = all.some(({ act }) => act) ? "bad" : all.length > 0 ? "note" : "quiet";
    setData("notice", { level, loss: losesMany(state) });
    write("notice-quiet", words(state).line);
    // Other words are a new element: in one, a browser would count a second line as a move of the first.
    const old = element("notice-words");
    const said = Object.assign(old.cloneNode(false), { textContent: all[0]?.brief ?? "" });
    if (said.textContent !== old.textContent) old.replaceWith(said);
    element("notice-all").style.visibility = all.length > 0 ? "" : "hidden";
    write("notice-all", all.length > 1 ? `${all.length} messages` : "Details");
    if (all.length === 0 && element("notice-list").matches(":popover-open")) element("notice-list").hidePopover();
    const key = JSON.stringify(all);
    if (key === this.#listed) return;
    this.#listed = key;
    element("findings").replaceChildren();
    for (const { brief, words, act } of all) {
      const item = child(element("findings"), "li");
      setData(item, { act });
      if (brief !== words) child(item, "b", "", brief);
      child(item, "p", "", words);
    }
  }
}

// {brief, words, act}: what the checks found, and what is wrong with the links; what must be acted on first. brief is one
// plain sentence for the line at the top.
function attention(state) {
  if (IDLE.includes(state.situation)) return [];
  const found = state.findings.map(({ site, brief, what, act }) => ({ brief: capital(brief), words: findingText(site, what), act }));
  // a link repeats a defect as its trouble
  const links = problems(state).filter((words) => !found.some((one) => words.startsWith(one.words)));
  return [...links.map((words) => ({ brief: words, words, act: true })), ...found].sort((a, b) => b.act - a.act);
}

export const findingText = (site, what) => capital(site ? `${site}: ${what}` : what);

// Sentences on events, the newest at the top.
export const logPanel = {
  uses: ["log", "scene"],

  draw({ log, start }) {
    show("log-waiting", log.length === 0);
    element("log").replaceChildren();
    for (const [t, kind, words] of log.toReversed()) {
      const item = child(element("log"), "li");
      setData(item, { kind });
      child(item, "time", "", clock(t - start));
      child(item, "i"); // mark of a fault
      child(item, "span", "", capital(words));
    }
  },
};
