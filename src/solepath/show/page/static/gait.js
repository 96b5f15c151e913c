// Means of steady strides: five rows, and a folded table of all.

import { MAIN, difference, doubleSupport } from "./rows.js";
import { isWrong, unsound } from "./sound.js";
import { child, fixed, percent, setData, show, signed, write } from "./words.js";

const FULL_ASYMMETRY = 0.2; // asymmetry that fills half of its bar
const FULL_SHARE = 0.1; // the same for a difference in shares of a stride
const FULL_DIFFERENCE = 10; // difference that fills half of its bar, degrees
const UNITS = { deg: "°" };
const NONE = { left: NaN, right: NaN, both: NaN };

export class Gait {
  uses = ["gait", "findings", "playback", "activity", "scene"];

  constructor() {
    for (const id of ["gait-rows", "gait-main", "gait-main-rows", "gait-waiting", "gait-kind", "gait-note", "gait-coordination"])
      this[id] = document.getElementById(id);
    this.rows = new Map();
    this.main = MAIN.map(() => new Row(false)); // there from the start, so that nothing moves when the figures come
    this["gait-main-rows"].replaceChildren(...this.main.map((row) => row.element));
  }

  draw(state) {
    const { gait, finished } = state;
    const rows = gait?.rows ?? [];
    const some = rows.length > 0;
    setData(this["gait-main"], { known: some });
    write(this["gait-waiting"], some ? "" : "After a few steady strides the figures come here.");
    write(this["gait-kind"], some ? `${gait.running ? "running" : "walking"}, mean of ${counted(gait)}` : "");
    const feet = unsound(state);
    for (const table of [this["gait-main"], this["gait-rows"]])
      setData(table, { left: !feet.has("left"), right: !feet.has("right"), both: feet.size === 0 });
    write(this["gait-note"], some ? few(gait, finished) : "");
    write(this["gait-coordination"], some ? coordinationText(gait) : "");
    // What needs both feet is not known while the data of one of them are wrong.
    const wrong = isWrong(state);
    MAIN.forEach((make, k) => this.main[k].show(wrong && make === doubleSupport ? { ...make(rows), ...NONE } : make(rows)));
    const all = some ? [{ name: "strides", label: "strides", digits: 0, ...gait.strides }, ...rows] : [];
    const names = all.map((row) => row.name);
    if (names.join() !== [...this.rows.keys()].join()) {
      this.rows = new Map(names.map((name) => [name, new Row(true)]));
      this["gait-rows"].replaceChildren(...[...this.rows.values()].map((row) => row.element));
    }
    for (const row of all) this.rows.get(row.name).show(row);
    return "done";
  }
}

// Strides are counted for each foot.
function counted({ strides }) {
  const counts = Object.values(strides).filter(Number.isFinite);
  const [least, most] = [Math.min(...counts), Math.max(...counts)];
  if (counts.length === 1) return `${most} strides of one foot`;
  return `${least === most ? most : `${least} and ${most}`} strides`;
}

function few({ strides, enough }, finished) {
  const counts = Object.values(strides).filter(Number.isFinite);
  const least = Math.ceil(enough / counts.length);
  if (counts.reduce((sum, one) => sum + one, 0) >= enough) return "";
  return finished ? `Few strides: means are good from ${least} strides of each foot on.` : `The figures settle with ${least} and more strides of each foot.`;
}

const coordinationText = ({ coordination }) =>
  coordination === null ? "" : `Phase coordination index ${percent(coordination, 1)}.`;

class Row {
  // whole: with standard deviation and coefficient of variation
  constructor(whole) {
    this.whole = whole;
    this.element = document.createElement("tr");
    const head = cell("th");
    head.scope = "row";
    this.name = child(head, "span");
    head.append("\u00a0");
    this.unit = child(head, "span", "unit");
    const [left, right, both, cv, lean] = Array.from({ length: 5 }, () => cell("td"));
    this.mean = child(both, "span", "mean");
    if (whole) {
      both.append(" ");
      this.sd = child(both, "span", "sd");
    }
    const bar = child(lean, "span", "lean");
    bar.setAttribute("aria-hidden", "true");
    this.share = child(lean, "span", "share");
    this.bar = child(bar, "i");
    this.track = bar;
    Object.assign(this, { left, right, cv });
    this.element.append(head, left, right, both, ...(whole ? [cv] : []), lean);
  }

  show(row) {
    const digits = Number.isInteger(row.digits) ? row.digits : 2;
    this.element.dataset.row = row.name;
    write(this.name, String(row.label ?? row.name));
    write(this.unit, String(UNITS[row.unit] ?? row.unit ?? ""));
    write(this.left, fixed(row.left, digits));
    write(this.right, fixed(row.right, digits));
    write(this.mean, fixed(row.both, digits));
    if (this.whole) write(this.sd, Number.isFinite(row.sd) ? `± ${fixed(row.sd, digits)}` : "");
    if (this.whole) write(this.cv, Number.isFinite(row.cv) ? fixed(100 * row.cv, 1) : "–");
    const turned = Number.isFinite(row.difference); // an angle has a difference, since a share of an angle says nothing
    const { share, points } = difference(row);
    const known = turned || Number.isFinite(share);
    const lean = turned ? row.difference / FULL_DIFFERENCE : share / (points ? FULL_SHARE : FULL_ASYMMETRY);
    const degrees = () => `${signed(row.difference, digits)}${UNITS[row.unit] ?? ""}`;
    const words = () => `${signed(100 * share, 1)} ${points ? "points" : "%"}`;
    write(this.share, turned ? degrees() : known ? words() : "–");
    show(this.track, known);
    if (!known) return;
    this.bar.dataset.to = lean < 0 ? "left" : "right";
    this.bar.style.width = `${50 * Math.min(1, Math.abs(lean))}%`;
  }
}

const cell = (name) => document.createElement(name);
