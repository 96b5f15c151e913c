// A cover for a phone in a pocket: the screen stays on but black, and a touch does nothing, until somebody holds its button.
// A page whose screen is off may be stopped by the system; one that is covered is seen by the system, and so goes on.

import { computer } from "./computer.js";
import { running } from "./live.js";
import { element } from "./words.js";

const HOLD_TIME = 1000; // ms for which the button is held: longer than what cloth touches by chance

let held = 0; // timer
let covered = false;

element("pocket").addEventListener("click", cover);
element("uncover").addEventListener("pointerdown", () => {
  clearTimeout(held);
  held = setTimeout(uncover, HOLD_TIME);
});
for (const name of ["pointerup", "pointercancel", "pointerleave"]) {
  element("uncover").addEventListener(name, () => clearTimeout(held));
}
element("uncover").addEventListener("click", (event) => event.detail === 0 && uncover()); // by a key or a screen reader
element("uncover").addEventListener("contextmenu", (event) => event.preventDefault());
computer.on("walk", (walk) => walk === null && uncover());
computer.on("state", (state) => state === "dead" && uncover()); // what has stopped is no longer covered

// The whole screen, where the browser allows that, has no bars to touch by chance.
function cover() {
  if (!running()) return;
  element("cover").showModal();
  document.documentElement.requestFullscreen?.().catch(() => {});
  covered = true;
  computer.setCovered(true);
}

function uncover() {
  clearTimeout(held);
  if (!covered) return;
  covered = false;
  element("cover").close();
  if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
  computer.setCovered(false);
  // who takes the phone out wants to see the place
  if (document.body.classList.contains("has-plan")) element("track-section").scrollIntoView();
}

// Also where a browser closes a cover in spite of `closedby` and of what "cancel" prevents: the page is seen again.
element("cover").addEventListener("close", uncover);
// A cancelled dialog, as by the gesture "back", stays: only the button opens it.
element("cover").addEventListener("cancel", (event) => event.preventDefault());
