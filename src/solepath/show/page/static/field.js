// Pressure between the cells: a small picture, whose weights are computed once for a layout.

const [COLUMNS, ROWS] = [64, 160];
const MAX_NEAREST_CELLS = 6;
const WIDTH = 0.55; // standard deviation of the weight of a cell, as a share of the distance between cells
const REACH = 2.6; // distances from the nearest cell at which nothing is known

export class Field {
  // box: [least x, greatest x, least y, greatest y] of the picture, m, toes up and the wearer's left on the left
  constructor(cells, spacing, [back, front, right, left]) {
    this.picture = Object.assign(document.createElement("canvas"), { width: COLUMNS, height: ROWS });
    this.context = this.picture.getContext("2d");
    this.image = this.context.createImageData(COLUMNS, ROWS);
    this.near = Math.min(MAX_NEAREST_CELLS, cells.length);
    this.cells = new Uint16Array(COLUMNS * ROWS * this.near);
    this.weights = new Float32Array(COLUMNS * ROWS * this.near);
    this.values = new Float32Array(cells.length);
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
