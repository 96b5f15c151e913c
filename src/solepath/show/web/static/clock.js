// The clock of walks, in the page and in the worker.

const TOLERANCE = 1000; // ms by which the date may run ahead of the steady clock: it is corrected now and then
let ahead = 0; // ms

// Seconds since 1970, never falling. The steady clock stands still while many devices sleep; the date shows how long.
export function now() {
  const steady = performance.timeOrigin + performance.now();
  const difference = Date.now() - steady;
  if (difference > ahead + TOLERANCE) ahead = difference;
  return (steady + ahead) / 1000;
}
