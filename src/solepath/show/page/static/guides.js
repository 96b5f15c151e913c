// What a person is guided through who measures a shoe: what to do now, and what came of it so far.

import { angle, capital, describe, setData, show, write } from "./words.js";

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
