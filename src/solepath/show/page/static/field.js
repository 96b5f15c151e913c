// A sole: its outline, as a ring of [x, y] in the foot frame (x to the toe, y to the left, m), and the pressure between its
// cells: a small picture, whose weights are computed once for a layout.

import { bounds } from "./canvas.js";

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
const MARGIN = 0.008; // m from the outermost cells to the outline
const [COLUMNS, ROWS] = [64, 160];
const MAX_NEAREST_CELLS = 6;
const WIDTH = 0.55; // standard deviation of the weight of a cell, as a share of the distance between cells
const REACH = 2.6; // distances from the nearest cell at which nothing is known
const LONE = 0.02; // m that stands for the distance to another cell where there is none

// Outline of a shoe of `length` m, so wide that it holds its cells.
export function outlineOf(foot, length, cells) {
  const side = foot === "left" ? 1 : -1;
  const edge = (k) => SOLE_OUTLINE.map((row) => [row[0] * length, side * row[k] * length]);
  const ring = cut(cut([...edge(1), ...edge(2).reverse().slice(1, -1)]));
  const [, , right, left] = bounds(ring);
  const wide = cells.map(([, y]) => (y < 0 ? (y - MARGIN) / right : (y + MARGIN) / left));
  return ring.map(([x, y]) => [x, y * Math.max(1, ...wide)]);
}

// A ring with its corners cut off (Chaikin).
const cut = (ring) =>
  ring.flatMap(([x, y], i) => {
    const [a, b] = ring[(i + 1) % ring.length];
    return [0.25, 0.75].map((share) => [x + share * (a - x), y + share * (b - y)]);
  });

export class Field {
  // box: [least x, greatest x, least y, greatest y] of the picture, m, toes up and the wearer's left on the left
  constructor(cells, [back, front, right, left]) {
    this.picture = Object.assign(document.createElement("canvas"), { width: COLUMNS, height: ROWS });
    this.context = this.picture.getContext("2d");
    this.image = this.context.createImageData(COLUMNS, ROWS);
    this.near = Math.min(MAX_NEAREST_CELLS, cells.length);
    this.cells = new Uint16Array(COLUMNS * ROWS * this.near);
    this.weights = new Float32Array(COLUMNS * ROWS * this.near);
    this.values = new Float32Array(cells.length);
    const spacing = usualDistance(cells);
    for (let pixel = 0; pixel < COLUMNS * ROWS; pixel++) {
      const x = front - ((front - back) * (Math.floor(pixel / COLUMNS) + 0.5)) / ROWS;
      const y = left - ((left - right) * ((pixel % COLUMNS) + 0.5)) / COLUMNS;
      const far = cells.map(([a, b]) => Math.hypot(a - x, b - y));
      const least = Math.min(...far);
      const close = [...far.keys()].filter((i) => far[i] < least + 2 * spacing); // those farther away weigh nothing
      const nearest = close.sort((a, b) => far[a] - far[b]).slice(0, this.near);
      const weights = nearest.map((i) => Math.exp((least ** 2 - far[i] ** 2) / (2 * (WIDTH * spacing) ** 2)));
      const sum = weights.reduce((a, b) => a + b, 0);
      this.cells.set(nearest, pixel * this.near);
      this.weights.set(weights.map((weight) => weight / sum), pixel * this.near);
      this.image.data[4 * pixel + 3] = 255 * (REACH - least / spacing); // opacity, clamped: far away nothing is known
    }
  }

  // values[i]: value of cell i, 0 to 1 of the scale; table: 256 colours of four bytes
  paint(values, table) {
    const { near, cells, weights, image } = this;
    for (let pixel = 0; pixel < COLUMNS * ROWS; pixel++) {
      let value = 0;
      const first = pixel * near;
      for (let k = first; k < first + near; k++) value += weights[k] * values[cells[k]];
      const colour = 4 * Math.min(255, Math.round(255 * value));
      for (let k = 0; k < 3; k++) image.data[4 * pixel + k] = table[colour + k];
    }
    this.context.putImageData(image, 0, 0);
    return this.picture;
  }
}

// Median of the cells' distances to their nearest neighbours, m.
function usualDistance(cells) {
  const apart = ([x, y], other) => Math.hypot(x - other[0], y - other[1]);
  const nearest = cells.map((one) => Math.min(...cells.map((other) => (other === one ? Infinity : apart(one, other)))));
  const middle = nearest.sort((a, b) => a - b)[Math.floor(nearest.length / 2)];
  return Number.isFinite(middle) ? middle : LONE;
}
