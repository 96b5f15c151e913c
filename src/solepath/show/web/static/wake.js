// Keeps the screen on while somebody walks or watches; a browser forgets that whenever the page is hidden.

const reasons = new Set();
let lock = null;
let updates = Promise.resolve();

export function keepAwake(reason, needed) {
  if (needed) reasons.add(reason);
  else reasons.delete(reason);
  schedule();
}

// One after the other, so that no lock is requested twice or forgotten.
function schedule() {
  updates = updates.then(update).catch(() => {}); // refused, perhaps for a low battery
}

async function update() {
  if (document.hidden || !navigator.wakeLock) return;
  if (reasons.size === 0) {
    await lock?.release();
    lock = null;
  } else if (lock === null || lock.released) {
    lock = await navigator.wakeLock.request("screen");
  }
}

document.addEventListener("visibilitychange", schedule);
