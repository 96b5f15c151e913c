// Means of steady strides: five rows, and a folded table of all.

import { child, fixed, percent, setData, show, signed, write } from "./words.js";

const FULL_ASYMMETRY = 0.2; // asymmetry that fills half of its bar
const FULL_DIFFERENCE = 10; // difference that fills half of its bar, degrees
const UNITS = { deg: "°" };

export class Gait {
  uses = ["gait", "scene"];

  constructor() {
    for (const id of ["gait-rows", "gait-main", "gait-main-rows", "gait-waiting", "gait-kind", "gait-note", "gait-coordination"])
      this[id] = document.getElementById(id);
    this.rows = new Map();
    this.main = MAIN.map(() => new Row(false)); // there from the start, so that nothing moves when the figures come
    this["gait-main-rows"].replaceChildren(...this.main.map((row) => row.element));
  }

  draw({ gait }) {
    const rows = gait?.rows ?? [];
    const some = rows.length > 0;
    setData(this["gait-main"], { known: some });
    write(this["gait-waiting"], some ? "" : "After a few steady strides the figures come here.");
    write(this["gait-kind"], some ? (gait.running ? "running" : "walking") : "");
    write(this["gait-note"], some ? few(gait) : "");
    write(this["gait-coordination"], some ? coordinationText(gait) : "");
    MAIN.forEach((make, k) => this.main[k].show(make(rows)));
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

const find = (rows, name) => rows.find((row) => row.name === name);
const named = (name, label, unit) => (rows) => find(rows, name) ?? { name, label, unit };

// The time with both feet on the ground, from both of its parts; below zero it is the time with both in the air.
function doubleSupport(rows) {
  const parts = ["initial", "terminal"].map((part) => find(rows, `${part}_double_support`));
  const sums = Object.fromEntries(
    ["left", "right", "both"].map((key) => [key, parts.reduce((sum, part) => sum + (part?.[key] ?? NaN), 0)]),
  );
  const flies = [sums.left, sums.right, sums.both].some((sum) => sum < 0);
  const [left, right, both] = [sums.left, sums.right, sums.both].map((sum) => (flies ? -sum : sum));
  const asymmetry = !flies && left + right > 0 ? (2 * (right - left)) / (left + right) : NaN;
  const label = flies ? "both in the air" : "both on the ground";
  return { name: "double_support", label, unit: "%", digits: 1, left, right, both, asymmetry };
}

const stance = (rows) => ({ ...named("stance_time", "", "%")(rows), label: "foot on the ground" });
const MAIN = [
  named("stride_length", "stride length", "m"),
  named("speed", "speed", "m/s"),
  named("stride_time", "stride time", "s"),
  stance,
  doubleSupport,
];

function few({ strides, enough }) {
  const count = Object.values(strides).reduce((sum, one) => sum + (one ?? 0), 0);
  return count < enough ? `Of ${count} strides: figures settle with ${enough} and more (Galna et al. 2013).` : "";
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
    const known = turned || Number.isFinite(row.asymmetry);
    const lean = turned ? row.difference / FULL_DIFFERENCE : row.asymmetry / FULL_ASYMMETRY;
    const degrees = () => `${signed(row.difference, digits)}${UNITS[row.unit] ?? ""}`;
    const share = () => `${signed(100 * row.asymmetry, 1)} %`;
    write(this.share, turned ? degrees() : known ? share() : "–");
    show(this.track, known);
    if (!known) return;
    this.bar.dataset.to = lean < 0 ? "left" : "right";
    this.bar.style.width = `${50 * Math.min(1, Math.abs(lean))}%`;
  }
}

const cell = (name) => document.createElement(name);
