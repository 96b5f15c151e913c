// The gait table: means of steady strides.

import { fixed, percent, signed, write } from "./words.js";

const WIDEST = 0.2; // asymmetry that fills half of its bar
const UNITS = { deg: "°" };

export class Gait {
  constructor() {
    for (const id of ["gait-rows", "gait-scroll", "gait-waiting", "gait-kind", "gait-note"])
      this[id] = document.getElementById(id);
    this.rows = new Map();
  }

  wants(changed) {
    return changed.has("gait") || changed.has("scene");
  }

  draw({ gait }) {
    const rows = gait?.rows ?? [];
    const some = rows.length > 0;
    this["gait-waiting"].hidden = some;
    this["gait-scroll"].hidden = !some;
    write(this["gait-kind"], some ? (gait.running ? "running" : "walking") : "");
    const coordinated = some && gait.coordination !== null;
    this["gait-note"].hidden = !coordinated;
    if (coordinated) write(this["gait-note"], `Phase coordination index ${percent(gait.coordination, 1)}`);
    const names = rows.map((row) => row.name);
    if (names.join() !== [...this.rows.keys()].join()) {
      this.rows = new Map(names.map((name) => [name, new Row()]));
      this["gait-rows"].replaceChildren(...[...this.rows.values()].map((row) => row.element));
    }
    for (const row of rows) this.rows.get(row.name).show(row);
    return "done";
  }
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
    const known = Number.isFinite(row.asymmetry);
    write(this.share, known ? signed(100 * row.asymmetry, 1) : "–");
    this.track.hidden = !known;
    if (!known) return;
    this.bar.dataset.to = row.asymmetry < 0 ? "left" : "right";
    this.bar.style.width = `${50 * Math.min(1, Math.abs(row.asymmetry) / WIDEST)}%`;
  }
}

const cell = (name) => document.createElement(name);

function child(parent, name, kind) {
  const element = document.createElement(name);
  if (kind) element.className = kind;
  parent.append(element);
  return element;
}
