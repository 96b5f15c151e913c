// The five rows of gait that are shown first, and which of them differs most between left and right.

// Largest differences that count as none (docs/page.md): shares of a value, and shares of a stride for those measured in them.
const EVEN = 0.02;
const EVEN_OF_A_STRIDE = 0.012;
const PARTS = ["initial_double_support", "terminal_double_support"];

// Each row: its name and label; the unit while nothing is known; what it is called beside “left and right”, and how the
// longer side is.
const MAIN = [
  { name: "stride_length", label: "stride length", unit: "m" },
  { name: "speed", label: "speed", unit: "m/s", more: "faster" },
  { name: "stride_time", label: "stride time", unit: "s" },
  { name: "stance_time", label: "foot on the ground", unit: "%", short: "ground time" },
  { name: "double_support", label: "both on the ground", unit: "%", short: "both down" },
];

// The time with both feet on the ground, from both of its parts; below zero it is the time with both in the air.
function doubleSupport(rows) {
  const parts = PARTS.map((name) => rows.find((row) => row.name === name) ?? {});
  const sums = ["left", "right", "both"].map((key) => parts.reduce((sum, part) => sum + (part[key] ?? NaN), 0));
  const flies = sums.some((sum) => sum < 0);
  const [left, right, both] = sums.map((sum) => (flies ? -sum : sum));
  return { digits: 1, left, right, both, ...(flies ? { label: "both in the air" } : {}) };
}

// The five rows, from those of a message.
export const mainRows = (rows) =>
  MAIN.map((main) => {
    const { label, ...known } = rows.find((row) => row.name === main.name) ?? {};
    return { ...main, ...known, ...(main.name === "double_support" ? doubleSupport(rows) : {}) };
  });

// How far the right foot is from the left: a share of their mean, or of a stride for what is measured in such shares.
export function difference({ unit, left, right, asymmetry }) {
  const points = unit === "%";
  const share = !points ? (asymmetry ?? NaN) : Number.isFinite(left) && Number.isFinite(right) ? (right - left) / 100 : NaN;
  return { share, points, size: Math.abs(share) / (points ? EVEN_OF_A_STRIDE : EVEN) };
}

// The row that differs most, in multiples of what counts as none: {name, share, points, even, more}; undefined while none
// is known.
export function mostDifferent(rows) {
  return mainRows(rows)
    .map((row) => ({ ...row, ...difference(row) }))
    .filter(({ size }) => Number.isFinite(size))
    .map(({ label, short = label, more = "longer", share, points, size }) => ({ name: short, share, points, size, even: size <= 1, more }))
    .sort((a, b) => b.size - a.size)[0];
}
