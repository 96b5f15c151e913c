// The gait table: means of steady strides.

import { child, fixed, percent, show, signed, write } from "./words.js";

const FULL_ASYMMETRY = 0.2; // asymmetry that fills half of its bar
const FULL_DIFFERENCE = 10; // difference that fills half of its bar, degrees
const UNITS = { deg: "°" };

export class Gait {
  uses = ["gait", "scene"];

  constructor() {
    for (const id of ["gait-rows", "gait-scroll", "gait-waiting", "gait-kind", "gait-note"])
      this[id] = document.getElementById(id);
    this.rows = new Map();
  }

  draw({ gait }) {
    const rows = gait?.rows ?? [];
    const some = rows.length > 0;
    this["gait-waiting"].hidden = some;
    this["gait-scroll"].hidden = !some;
    write(this["gait-kind"], some ? (gait.running ? "running" : "walking") : "");
    const notes = some ? notesOn(gait) : "";
    show(this["gait-note"], notes !== "");
    write(this["gait-note"], notes);
    const all = some ? [{ name: "strides", label: "strides", digits: 0, ...gait.strides }, ...rows] : [];
    const names = all.map((row) => row.name);
    if (names.join() !== [...this.rows.keys()].join()) {
      this.rows = new Map(names.map((name) => [name, new Row()]));
      this["gait-rows"].replaceChildren(...[...this.rows.values()].map((row) => row.element));
    }
    for (const row of all) this.rows.get(row.name).show(row);
    return "done";
  }
}

function notesOn({ strides, enough, coordination }) {
  const count = Object.values(strides).reduce((sum, one) => sum + (one ?? 0), 0);
  const few = `Of ${count} strides: figures settle with ${enough} and more (Galna et al. 2013).`;
  const index = coordination === null ? "" : `Phase coordination index ${percent(coordination, 1)}.`;
  return [count < enough ? few : "", index].filter((words) => words !== "").join(" ");
}

class Row {
  constructor() {
    this.element = document.createElement("tr");
    const head = cell("th");
    head.scope = "row";
    this.name = child(head, "span");
    head.append("\u00a0");
    this.unit = child(head, "span", "unit");
    const [left, right, both, cv, lean] = Array.from({ length: 5 }, () => cell("td"));
    this.mean = child(both, "span", "mean");
    both.append(" ");
    this.sd = child(both, "span", "sd");
    const bar = child(lean, "span", "lean");
    bar.setAttribute("aria-hidden", "true");
    this.share = child(lean, "span", "share");
    this.bar = child(bar, "i");
    this.track = bar;
    Object.assign(this, { left, right, cv });
    this.element.append(head, left, right, both, cv, lean);
  }

  show(row) {
    const digits = Number.isInteger(row.digits) ? row.digits : 2;
    this.element.dataset.row = row.name;
    write(this.name, String(row.label ?? row.name));
    write(this.unit, String(UNITS[row.unit] ?? row.unit ?? ""));
    write(this.left, fixed(row.left, digits));
    write(this.right, fixed(row.right, digits));
    write(this.mean, fixed(row.both, digits));
    write(this.sd, Number.isFinite(row.sd) ? `± ${fixed(row.sd, digits)}` : "");
    write(this.cv, Number.isFinite(row.cv) ? fixed(100 * row.cv, 1) : "–");
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
