// The legs as they are, or at the last touchdown, from the right: rods from hip to knee, ankle and the end of the foot;
// and in words the last touchdown and the last fused stride, with recipes that have them.

import { FEET, describe, fixed, note, show, wordOf, write } from "./words.js";

const SCALE = 100; // units of the drawing per m
const OLD = 0.5; // age of legs that are not those of now, s
const FLOOR = 114; // where the lower foot stands, units of the drawing

export const bodyFigure = {
  uses: ["body", "touchdown", "fused", "scene", "second"],

  draw({ body, touchdown, fused, t }) {
    show("legs-card", [body, touchdown, fused].some((one) => one !== null));
    note("touchdown", touchdown ? touchdownText(touchdown) : "");
    note("fused", fused ? fusedText(fused) : "");
    show("body-figure", body !== null);
    if (body === null) return;
    const lowest = Math.min(...[...body.left, ...body.right].map(([, up]) => up));
    const place = ([ahead, up]) => `${fixedPoint(SCALE * ahead)},${fixedPoint(FLOOR - SCALE * (up - lowest))}`;
    for (const foot of FEET) describe(`body-${foot}`, "points", body[foot].map(place).join(" "));
    describe("body-hips", "cy", fixedPoint(FLOOR + SCALE * lowest));
    const apart = Math.abs(body.left[3][0] - body.right[3][0]);
    const when = t - body.t > OLD ? " at the last touchdown" : "";
    write("body-words", `Legs${when}, from the right: feet ${fixed(100 * apart)} cm apart`);
  },
};

const fixedPoint = (value) => value.toFixed(1); // a number of SVG, with a plain minus

function touchdownText({ foot, mode, position: [x, y] }) {
  const [way, width] = mode.toLowerCase().split("_"); // as in LEFT_WIDE
  const words = width ? `${width} bend to the ${way}` : wordOf({ straight: "straight on" }, way);
  return `${words}; ${foot} foot came down at ${fixed(x, 2)}, ${fixed(y, 2)} m`;
}

function fusedText({ foot, chosen, length, distance, similarity, error_index: error, share }) {
  const figures = `similarity ${fixed(similarity, 2)}, error index ${fixed(error, 3)}${error === null ? "" : " m/s"}, own share ${fixed(share, 2)}`;
  return `Both feet: ${fixed(distance, 2)} m by the ${chosen} foot; last stride, ${foot}, ${fixed(length, 2)} m: ${figures}`;
}
