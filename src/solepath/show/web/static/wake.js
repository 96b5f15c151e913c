// Keeps the screen on while somebody walks or watches; a browser forgets that whenever the page is hidden.

const reasons = new Set();
let lock = null;

export function keepAwake(reason, needed) {
  if (needed) reasons.add(reason);
  else reasons.delete(reason);
  update();
}

async function update() {
  if (document.hidden || !navigator.wakeLock) return;
  if (reasons.size === 0) {
    lock?.release();
    lock = null;
  } else if (lock === null || lock.released) {
    lock = await navigator.wakeLock.request("screen").catch(() => null); // refused, perhaps for a low battery
  }
}

document.addEventListener("visibilitychange", update);
