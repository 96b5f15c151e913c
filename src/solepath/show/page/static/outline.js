// The outline of a sole, as a ring of [x, y] in the foot frame (x to the toe, y to the left, m).

import { clamp, range } from "./canvas.js";

// Left shoe: x, and the y of its outer and inner edge there, as shares of the length. Drawn by eye.
const SOLE_OUTLINE = [
  [0, 0, 0],
  [0.012, 0.045, -0.045],
  [0.05, 0.09, -0.088],
  [0.12, 0.116, -0.108],
  [0.24, 0.116, -0.094],
  [0.38, 0.118, -0.066],
  [0.5, 0.128, -0.068],
  [0.62, 0.148, -0.102],
  [0.72, 0.156, -0.134],
  [0.8, 0.144, -0.147],
  [0.88, 0.11, -0.14],
  [0.94, 0.062, -0.122],
  [0.98, 0.008, -0.092],
  [1, -0.04, -0.045],
];
const STATION_COUNT = 44;
const MIN_CELLS = 16; // number of cells from which on they show the outline of a sole by themselves
const MIN_COVERAGE = 0.75; // share of the length that these cells must cover
// Outline of a shoe of `length` m without a known layout.
export function shoe(foot, length) {
  const side = foot === "left" ? 1 : -1;
  const ring = (edge) => SOLE_OUTLINE.map((row) => [row[0] * length, side * row[edge] * length]);
  return rounded([...ring(1), ...ring(2).reverse().slice(1, -1)]);
}

// Outline around the cells; if they are few or cover only a part of the length, the outline of a shoe that holds them.
export function around(cells, length, foot, spacing) {
  const xs = cells.map((cell) => cell[0]);
  const [back, front] = [Math.min(...xs), Math.max(...xs)];
  if (cells.length >= MIN_CELLS && front - back > MIN_COVERAGE * length) return hull(cells, back, front, spacing);
  const ring = shoe(foot, length);
  const wide = Math.max(...ring.map((point) => Math.abs(point[1])));
  const needed = Math.max(...cells.map((cell) => Math.abs(cell[1]))) + 0.008;
  return needed > wide ? ring.map(([x, y]) => [x, (y * needed) / wide]) : ring;
}

// Median of the cells' distances to their nearest neighbours.
export function spacing(cells) {
  const nearest = cells.map((one) =>
    Math.min(...cells.map((other) => (other === one ? Infinity : Math.hypot(one[0] - other[0], one[1] - other[1])))),
  );
  const middle = nearest.sort((a, b) => a - b)[Math.floor(nearest.length / 2)];
  return middle > 0 && middle < 1 ? middle : 0.02;
}

// Extent of the cells to both sides, station by station from heel to toe, smoothed and closed by round ends.
function hull(cells, back, front, spacing) {
  const margin = Math.min(0.012, Math.max(0.006, 0.75 * spacing));
  const [start, end] = [back - margin, front + margin];
  const stations = Array.from({ length: STATION_COUNT }, (_, i) => start + ((end - start) * i) / (STATION_COUNT - 1));
  const reach = stations.map((x) => {
    const off = Math.max(1.1 * spacing, Math.min(...cells.map((cell) => Math.abs(cell[0] - x))) + 1e-6);
    const ys = cells.filter((cell) => Math.abs(cell[0] - x) <= off).map((cell) => cell[1]);
    return [Math.max(...ys) + margin, Math.min(...ys) - margin];
  });
  const smooth = stations.map((x) => {
    let [sum, left, right] = [0, 0, 0];
    stations.forEach((other, i) => {
      const weight = Math.exp(-0.5 * ((x - other) / spacing) ** 2);
      sum += weight;
      left += weight * reach[i][0];
      right += weight * reach[i][1];
    });
    return [left / sum, right / sum];
  });
  const cap = Math.min(0.16 * (end - start), 3 * margin);
  const ring = (edge) =>
    stations.map((x, i) => {
      const middle = 0.5 * (smooth[i][0] + smooth[i][1]);
      const off = Math.min(1, (x - start) / cap, (end - x) / cap);
      return [x, middle + (smooth[i][edge] - middle) * Math.sqrt(Math.max(0, 1 - (1 - off) ** 2))];
    });
  return rounded([...ring(0), ...ring(1).reverse().slice(1, -1)]);
}

// Catmull-Rom spline through a closed ring.
function rounded(ring) {
  const fine = [];
  ring.forEach((b, i) => {
    const [a, c, d] = [-1, 1, 2].map((k) => ring[(i + k + ring.length) % ring.length]);
    for (let k = 0; k < 4; k++) {
      const u = k / 4;
      fine.push(
        [0, 1].map(
          (j) =>
            0.5 *
            (2 * b[j] +
              (c[j] - a[j]) * u +
              (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]) * u * u +
              (3 * b[j] - a[j] - 3 * c[j] + d[j]) * u ** 3),
        ),
      );
    }
  });
  return fine;
}
