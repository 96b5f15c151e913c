// Ends of the colour scales of pressure: the session decides them, so that all watchers see the same ones.

const UNKNOWN = { top: Infinity, beyond: false };

// the unit of a scale: kPa where newtons and areas are known, else N or counts
export const scaleOf = (scales, { unit }) => scales[unit] ?? UNKNOWN;

export function pressure(layout, i, value) {
  return layout.unit === "kPa" ? value / layout.cells[i][2] / 1000 : value;
}
