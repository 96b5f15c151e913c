// What a person is guided through who measures a shoe or a walk: what to do now, and what came of it so far.

import { angle, capital, child, describe, element, fixed, setData, show, write } from "./words.js";

const BALL = "150,126"; // where the shoe bends, in the drawing: the forefoot stays on the ground

// The shoe whose postures are measured, from its right: its pitch, and the pitch to which the heel is to be raised.
export const posturePanel = {
  uses: ["posture", "scene"],

  draw({ posture }) {
    show("posture-card", posture !== null);
    if (posture === null) return;
    const { foot, task, target, pitch, lean, still } = posture;
    write("posture-task", task);
    describe("posture-shoe", "transform", turned(pitch));
    describe("posture-target", "visibility", target === null ? "hidden" : "visible");
    describe("posture-target", "transform", turned(target));
    write("posture-pitch", angle(pitch, 1));
    setData("posture-card", { still, foot });
    const leans = lean === null ? "" : `, leans ${angle(Math.abs(lean))} sideways`;
    write("posture-words", `${capital(foot)} foot: ${still ? "steady" : "unsteady"}${leans}`);
  },
};

const turned = (pitch) => `rotate(${(((pitch ?? 0) * 180) / Math.PI).toFixed(1)} ${BALL})`;

// The walk that calibrates toe-out: for each foot its strides, the metres along its long axis, and the angle with its
// error, or why none is learnt.
export const toeOutPanel = {
  uses: ["toe_out", "scene"],

  draw({ toe_out: walk }) {
    show("toe-out-card", walk !== null);
    if (walk === null) return;
    const { task, distance, feet } = walk;
    const walked = Math.max(0, ...feet.map(({ along }) => along));
    write("toe-out-task", task);
    write("toe-out-words", `${fixed(walked, 1)} m${distance === null ? "" : ` of ${fixed(distance, 1)} m`}`);
    show("toe-out-done", distance !== null);
    if (distance !== null) element("toe-out-done").value = Math.min(1, walked / distance);
    element("toe-out-feet").replaceChildren();
    for (const { foot, strides, along, angle: turn, sigma, learnt, why } of feet) {
      const item = child(element("toe-out-feet"), "li");
      setData(item, { foot, learnt });
      child(item, "span", "foot-name", `${capital(foot)} foot`);
      child(item, "span", "foot-angle", turn === null || sigma === null ? "–" : `${angle(turn, 1)} ± ${angle(sigma, 1)}`);
      child(item, "span", "foot-strides", `${strides} strides, ${fixed(along, 1)} m`);
      child(item, "span", "foot-note", learnt ? "enough to be learnt" : `not learnt: ${why}`);
    }
  },
};
