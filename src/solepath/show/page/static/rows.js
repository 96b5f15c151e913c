// The five rows of gait that are shown first, and which of them differs most between left and right.

// Largest differences that count as none (docs/page.md): shares of a value, and shares of a stride for those measured in them.
const EVEN = 0.02;
const EVEN_OF_A_STRIDE = 0.012;

const find = (rows, name) => rows.find((row) => row.name === name);
const named = (name, label, unit) => (rows) => find(rows, name) ?? { name, label, unit };

// The time with both feet on the ground, from both of its parts; below zero it is the time with both in the air.
export function doubleSupport(rows) {
  const parts = ["initial", "terminal"].map((part) => find(rows, `${part}_double_support`));
  const sums = Object.fromEntries(
    ["left", "right", "both"].map((key) => [key, parts.reduce((sum, part) => sum + (part?.[key] ?? NaN), 0)]),
  );
  const flies = [sums.left, sums.right, sums.both].some((sum) => sum < 0);
  const [left, right, both] = [sums.left, sums.right, sums.both].map((sum) => (flies ? -sum : sum));
  const label = flies ? "both in the air" : "both on the ground";
  return { name: "double_support", label, unit: "%", digits: 1, left, right, both };
}

const stance = (rows) => ({ ...named("stance_time", "", "%")(rows), label: "foot on the ground" });

// Functions that make each row from those of a message.
export const MAIN = [
  named("stride_length", "stride length", "m"),
  named("speed", "speed", "m/s"),
  named("stride_time", "stride time", "s"),
  stance,
  doubleSupport,
];

// How far the right foot is from the left: a share of their mean, or of a stride for what is measured in such shares.
export function difference({ unit, left, right, asymmetry }) {
  const points = unit === "%";
  const share = points ? (Number.isFinite(left) && Number.isFinite(right) ? (right - left) / 100 : NaN) : (asymmetry ?? NaN);
  return { share, points, size: Math.abs(share) / (points ? EVEN_OF_A_STRIDE : EVEN) };
}

const SHORT = { stance_time: "ground time", double_support: "both down" };
const MORE = { speed: "faster" };

// The row that differs most, in multiples of what counts as none: {name, share, points, even, more}; null while none is known.
export function mostDifferent(rows) {
  const all = MAIN.map((make) => make(rows))
    .map((row) => ({ ...difference(row), name: SHORT[row.name] ?? row.label, more: MORE[row.name] ?? "longer" }))
    .filter(({ size }) => Number.isFinite(size));
  const most = all.reduce((a, b) => (a === null || b.size > a.size ? b : a), null);
  return most && { ...most, even: most.size <= 1 };
}
