// The legs as they are, or at the last touchdown, from the right: rods from hip to knee, ankle and the end of the foot;
// and in words the last touchdown and the last fused stride, with recipes that have them.

import { MODES, describe, fixed, setData, show, wordOf, write } from "./words.js";

const SCALE = 100; // units of the drawing per m
const OLD = 0.5; // age of legs that are not those of now, s
const FLOOR = 114; // where the lower foot stands, units of the drawing

export class BodyFigure {
  uses = ["body", "touchdown", "fused", "scene", "second"];

  constructor() {
    this.card = document.getElementById("legs-card");
    for (const id of ["touchdown", "fused"]) this[id] = document.getElementById(id);
    this.figure = document.getElementById("body-figure");
    this.words = document.getElementById("body-words");
    this.legs = { left: document.getElementById("body-left"), right: document.getElementById("body-right") };
    this.hips = document.getElementById("body-hips");
  }

  draw({ body, touchdown, fused, t }) {
    show(this.card, body !== null || touchdown !== null || fused !== null);
    show(this.touchdown, touchdown !== null);
    write(this.touchdown, touchdown ? touchdownText(touchdown) : "");
    setData(this.touchdown, { mode: touchdown?.mode ?? "" });
    show(this.fused, fused !== null);
    write(this.fused, fused ? fusedText(fused) : "");
    show(this.figure, body !== null);
    if (body === null) return "done";
    const lowest = Math.min(...[...body.left, ...body.right].map(([, up]) => up));
    const place = ([ahead, up]) => `${fixedPoint(SCALE * ahead)},${fixedPoint(FLOOR - SCALE * (up - lowest))}`;
    for (const foot of ["left", "right"]) describe(this.legs[foot], "points", body[foot].map(place).join(" "));
    describe(this.hips, "cy", fixedPoint(FLOOR + SCALE * lowest));
    const apart = Math.abs(body.left[3][0] - body.right[3][0]);
    const when = t - body.t > OLD ? " at the last touchdown" : "";
    write(this.words, `Legs${when}, from the right: feet ${fixed(100 * apart)} cm apart`);
    return "done";
  }
}

const fixedPoint = (value) => value.toFixed(1); // a number of SVG, with a plain minus

function touchdownText({ foot, mode, position: [x, y] }) {
  return `${wordOf(MODES, mode)}; ${foot} foot came down at ${fixed(x, 2)}, ${fixed(y, 2)} m`;
}

function fusedText({ foot, chosen, length, distance, similarity, errorIndex, share }) {
  const figures = [
    ["similarity", similarity, 2, ""],
    ["error index", errorIndex, 3, " m/s"],
    ["own share", share, 2, ""],
  ].map(([name, value, digits, unit]) => `${name} ${fixed(value ?? NaN, digits)}${value === null ? "" : unit}`);
  return `Both feet: ${fixed(distance, 2)} m by the ${chosen} foot; last stride, ${foot}, ${fixed(length, 2)} m: ${figures.join(", ")}`;
}
