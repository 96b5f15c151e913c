// What a person is guided through who measures a shoe or a walk: what to do now, and what came of it so far.

import { capital, child, describe, fixed, setData, show, write } from "./words.js";

const DEGREES = 180 / Math.PI;
const BALL = "150,126"; // where the shoe bends, in the drawing: the forefoot stays on the ground

// The shoe whose postures are measured, from its right: its pitch, and the pitch to which the heel is to be raised.
export class PosturePanel {
  uses = ["posture", "scene"];

  constructor() {
    for (const name of ["card", "task", "shoe", "target", "pitch", "words"])
      this[name] = document.getElementById(`posture-${name}`);
  }

  draw({ posture }) {
    show(this.card, posture !== null);
    if (posture === null) return "done";
    const { foot, task, target, pitch, lean, still } = posture;
    write(this.task, task);
    describe(this.shoe, "transform", turned(pitch ?? 0));
    describe(this.target, "visibility", target === null ? "hidden" : "visible");
    describe(this.target, "transform", turned(target ?? 0));
    write(this.pitch, `${fixed((pitch ?? NaN) * DEGREES, 1)}°`);
    setData(this.card, { still, foot });
    const leans = lean === null ? "" : `, leans ${fixed(Math.abs(lean) * DEGREES)}° sideways`;
    write(this.words, `${capital(foot)} foot: ${still ? "steady" : "unsteady"}${leans}`);
    return "done";
  }
}

const turned = (pitch) => `rotate(${(pitch * DEGREES).toFixed(1)} ${BALL})`;

// The walk that calibrates toe-out: for each foot its strides, the metres along its long axis, and the angle with its
// error, or why none is learnt.
export class ToeOutPanel {
  uses = ["toe_out", "scene"];

  constructor() {
    for (const name of ["card", "task", "words", "feet", "done"]) this[name] = document.getElementById(`toe-out-${name}`);
  }

  draw({ toe_out: walk }) {
    show(this.card, walk !== null);
    if (walk === null) return "done";
    const { task, distance, feet } = walk;
    const walked = Math.max(0, ...feet.map(({ along }) => along));
    write(this.task, task);
    write(this.words, `${fixed(walked, 1)} m${distance === null ? "" : ` of ${fixed(distance, 1)} m`}`);
    show(this.done, distance !== null);
    if (distance !== null) this.done.value = Math.min(1, walked / distance);
    while (this.feet.children.length > feet.length) this.feet.lastChild.remove();
    while (this.feet.children.length < feet.length) newFoot(this.feet);
    feet.forEach((foot, k) => drawFoot(this.feet.children[k], foot));
    return "done";
  }
}

function newFoot(list) {
  const item = child(list, "li");
  for (const kind of ["name", "angle", "strides", "note"]) child(item, "span", `foot-${kind}`);
}

function drawFoot(item, { foot, strides, along, angle, sigma, learnt, why }) {
  setData(item, { foot, learnt });
  const known = angle === null || sigma === null ? "–" : `${fixed(angle * DEGREES, 1)}° ± ${fixed(sigma * DEGREES, 1)}°`;
  const note = learnt ? "enough to be learnt" : `not learnt: ${why}`;
  const words = [`${capital(foot)} foot`, known, `${strides} strides, ${fixed(along, 1)} m`, note];
  words.forEach((text, k) => write(item.children[k], text));
}
