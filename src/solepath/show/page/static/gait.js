// Means of steady strides: five rows, which of them differs most between left and right, and a folded table of all.

import { isWrong, unsound } from "./trust.js";
import { FEET, child, element, fixed, percent, setData, show, signed, write } from "./words.js";

const FULL_ASYMMETRY = 0.2; // asymmetry that fills half of its bar
const FULL_SHARE = 0.1; // the same for a difference in shares of a stride
const FULL_DIFFERENCE = 10; // difference that fills half of its bar, degrees
const UNITS = { deg: "°" };
const NONE = { left: NaN, right: NaN, both: NaN };
// Largest differences that count as none (docs/browser.md): shares of a value, and shares of a stride for those measured in them.
const EVEN = 0.02;
const EVEN_OF_A_STRIDE = 0.012;
const PARTS = ["initial_double_support", "terminal_double_support"];

const LEAST_STRIDES = 10; // of each foot, from which on the feet are compared: fewer differ by chance; chosen by hand
// Each row: its name and label; the unit while nothing is known; what is said of the foot that has more of it, where that
// can be said of a foot.
const MAIN = [
  { name: "stride_length", label: "stride length", unit: "m", more: "stride longer" },
  { name: "speed", label: "speed", unit: "m/s", more: "foot faster" },
  { name: "stride_time", label: "stride time", unit: "s", more: "stride slower" },
  { name: "stance_time", label: "foot on the ground", unit: "%", more: "foot longer down" },
  { name: "double_support", label: "both on the ground", unit: "%" },
];

export class Gait {
  uses = ["gait", "spoilt", "findings", "situation", "activity", "scene"];
  all = new Map();
  main = mainRows([]).map(() => new Row("gait-main-rows", false)); // there from the start, so that nothing moves later

  draw(state) {
    const { gait, finished } = state;
    const rows = gait?.rows ?? [];
    const some = rows.length > 0;
    setData("gait-main", { known: some });
    const bad = unsound(state);
    for (const table of ["gait-main", "gait-rows"])
      setData(table, { left: !bad.includes("left"), right: !bad.includes("right"), both: bad.length === 0 });
    write("gait-waiting", some ? "" : "After a few steady strides the figures come here.");
    write("gait-kind", some ? `${gait.running ? "running" : "walking"}, mean of ${counted(gait)}` : "");
    write("gait-note", some ? few(gait, finished) : "");
    write("gait-coordination", some && gait.coordination !== null ? `Phase coordination index ${percent(gait.coordination, 1)}.` : "");
    // What needs both feet is not known while the data of one of them are wrong.
    const unknown = isWrong(state) ? "double_support" : "";
    const compared = isCompared(gait);
    mainRows(rows).forEach((row, k) => this.main[k].show(row.name === unknown ? { ...row, ...NONE } : row, compared));
    const all = some ? [{ name: "strides", label: "strides", digits: 0, ...gait.strides }, ...rows] : [];
    if (all.map(({ name }) => name).join() !== [...this.all.keys()].join()) {
      element("gait-rows").replaceChildren();
      this.all = new Map(all.map(({ name }) => [name, new Row("gait-rows", true)]));
    }
    for (const row of all) this.all.get(row.name).show(row, compared);
  }
}

// True once there are strides enough of both feet to compare them.
export const isCompared = (gait) => gait !== null && FEET.every((foot) => gait.strides[foot] >= LEAST_STRIDES);

const countsOf = ({ strides }) => FEET.map((foot) => strides[foot]).filter(Number.isFinite);

// Strides are counted for each foot.
function counted(gait) {
  const [least, most] = countsOf(gait).sort((a, b) => a - b);
  if (most === undefined) return `${least} strides of one foot`;
  return `${least === most ? most : `${least} and ${most}`} strides`;
}

function few(gait, finished) {
  const counts = countsOf(gait);
  const least = Math.ceil(gait.enough / counts.length);
  if (counts.reduce((sum, one) => sum + one, 0) >= gait.enough) return "";
  const compared = isCompared(gait) ? "" : ` The feet are compared from ${LEAST_STRIDES} on.`;
  return finished ? `Few strides: means are good from ${least} strides of each foot on.` : `The figures settle with ${least} and more strides of each foot.${compared}`;
}

class Row {
  // list: the id of the rows; whole: with standard deviation and coefficient of variation
  constructor(list, whole) {
    this.element = child(element(list), "tr");
    const head = child(this.element, "th");
    head.scope = "row";
    this.name = child(head, "span");
    head.append("\u00a0");
    this.unit = child(head, "span", "unit");
    this.left = child(this.element, "td");
    this.right = child(this.element, "td");
    const both = child(this.element, "td");
    this.mean = child(both, "span", "mean");
    if (whole) {
      both.append(" ");
      this.sd = child(both, "span", "sd");
      this.cv = child(this.element, "td");
    }
    const lean = child(this.element, "td");
    this.track = child(lean, "span", "lean");
    this.track.setAttribute("aria-hidden", "true");
    this.bar = child(this.track, "i");
    this.share = child(lean, "span", "share");
  }

  // compared: its difference between the feet is shown
  show(row, compared) {
    const { name, label, digits = 2, left, right, both, sd, cv } = row;
    const unit = UNITS[row.unit] ?? row.unit ?? "";
    setData(this.element, { row: name });
    write(this.name, label);
    write(this.unit, unit);
    write(this.left, fixed(left, digits));
    write(this.right, fixed(right, digits));
    write(this.mean, fixed(both, digits));
    if (this.sd) write(this.sd, Number.isFinite(sd) ? `± ${fixed(sd, digits)}` : "");
    if (this.cv) write(this.cv, Number.isFinite(cv) ? fixed(100 * cv, 1) : "–");
    const turned = compared && Number.isFinite(row.difference); // an angle has a difference, since a share of an angle says nothing
    const { share, points } = difference(row);
    const known = turned || (compared && Number.isFinite(share));
    const words = turned ? `${signed(row.difference, digits)}${unit}` : known ? `${signed(100 * share, 1)} ${points ? "points" : "%"}` : "–";
    write(this.share, words);
    show(this.track, known);
    if (!known) return;
    const lean = turned ? row.difference / FULL_DIFFERENCE : share / (points ? FULL_SHARE : FULL_ASYMMETRY);
    setData(this.bar, { to: lean < 0 ? "left" : "right" });
    this.bar.style.width = `${50 * Math.min(1, Math.abs(lean))}%`;
  }
}

// The time with both feet on the ground, from both of its parts; below zero it is the time with both in the air.
function doubleSupport(rows) {
  const parts = PARTS.map((name) => rows.find((row) => row.name === name) ?? {});
  const sums = ["left", "right", "both"].map((key) => parts.reduce((sum, part) => sum + (part[key] ?? NaN), 0));
  const flies = sums.some((sum) => sum < 0);
  const [left, right, both] = sums.map((sum) => (flies ? -sum : sum));
  return { digits: 1, left, right, both, ...(flies ? { label: "both in the air" } : {}) };
}

// The five rows, from those of a message.
export const mainRows = (rows) =>
  MAIN.map((main) => {
    const { label, ...known } = rows.find((row) => row.name === main.name) ?? {};
    return { ...main, ...known, ...(main.name === "double_support" ? doubleSupport(rows) : {}) };
  });

// How far the right foot is from the left: a share of their mean, or of a stride for what is measured in such shares.
export function difference({ unit, left, right, asymmetry }) {
  const points = unit === "%";
  const share = !points ? (asymmetry ?? NaN) : Number.isFinite(left) && Number.isFinite(right) ? (right - left) / 100 : NaN;
  return { share, points, size: Math.abs(share) / (points ? EVEN_OF_A_STRIDE : EVEN) };
}

// The row that differs most, in multiples of what counts as none: {share, even, more}; undefined while none is known.
export function mostDifferent(rows) {
  return mainRows(rows)
    .map((row) => ({ ...row, ...difference(row) }))
    .filter(({ more, size }) => more && Number.isFinite(size))
    .map(({ more, share, size }) => ({ more, share, size, even: size <= 1 }))
    .sort((a, b) => b.size - a.size)[0];
}
