// The shoe whose postures are measured, from its right: its pitch, and the pitch to which the heel is to be raised.

import { capital, describe, fixed, setData, show, write } from "./words.js";

const DEGREES = 180 / Math.PI;
const BALL = "150,126"; // where the shoe bends, in the drawing: the forefoot stays on the ground

export class PosturePanel {
  uses = ["posture", "scene"];

  constructor() {
    for (const name of ["card", "task", "shoe", "target", "pitch", "words"])
      this[name] = document.getElementById(`posture-${name}`);
  }

  draw({ posture }) {
    show(this.card, posture !== null);
    document.body.classList.toggle("measuring", posture !== null);
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
