// The legs as they are, or at the last touchdown, from the right: rods from hip to knee, ankle and the end of the foot.

import { describe, fixed, show, write } from "./words.js";

const SCALE = 100; // units of the drawing per m
const OLD = 0.5; // age of legs that are not those of now, s
const FLOOR = 114; // where the lower foot stands, units of the drawing

export class BodyFigure {
  uses = ["body", "scene", "second"];

  constructor() {
    this.figure = document.getElementById("body-figure");
    this.words = document.getElementById("body-words");
    this.legs = { left: document.getElementById("body-left"), right: document.getElementById("body-right") };
    this.hips = document.getElementById("body-hips");
  }

  draw({ body, t }) {
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
