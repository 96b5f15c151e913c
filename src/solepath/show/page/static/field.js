// Pressure between the cells: a small picture, whose weights are computed once for a layout.

export const COLUMNS = 64;
export const ROWS = 160;
const MAX_NEAREST_CELLS = 6;

export class Field {
  // box: [least x, greatest x, least y, greatest y] of the picture, m, toes up and the wearer's left on the left
  constructor(cells, spacing, box) {
    this.picture = document.createElement("canvas");
    Object.assign(this.picture, { width: COLUMNS, height: ROWS });
    this.context = this.picture.getContext("2d");
    this.image = this.context.createImageData(COLUMNS, ROWS);
    this.near = Math.min(MAX_NEAREST_CELLS, cells.length);
    this.cells = new Uint16Array(COLUMNS * ROWS * this.near);
    this.weights = new Float32Array(COLUMNS * ROWS * this.near);
    this.cover = new Uint8Array(COLUMNS * ROWS); // opacity: far from all cells nothing is known
    this.values = new Float32Array(cells.length);
    const [back, front, right, left] = box;
    const sigma = 0.55 * spacing;
    for (let row = 0; row < ROWS; row++) {
      const x = front - ((front - back) * (row + 0.5)) / ROWS;
      for (let column = 0; column < COLUMNS; column++) {
        const y = left - ((left - right) * (column + 0.5)) / COLUMNS;
        this.#weigh(row * COLUMNS + column, x, y, cells, sigma, spacing);
      }
    }
  }

  #weigh(pixel, x, y, cells, sigma, spacing) {
    const found = []; // the nearest cells, nearest first
    for (let i = 0; i < cells.length; i++) {
      const squared = (cells[i][0] - x) ** 2 + (cells[i][1] - y) ** 2;
      if (found.length === this.near && squared >= found[this.near - 1][0]) continue;
      let at = found.length;
      while (at > 0 && found[at - 1][0] > squared) at -= 1;
      found.splice(at, 0, [squared, i]);
      if (found.length > this.near) found.pop();
    }
    const least = found[0][0];
    const raw = found.map(([squared]) => Math.exp((least - squared) / (2 * sigma * sigma)));
    const sum = raw.reduce((a, b) => a + b, 0);
    found.forEach(([, i], k) => {
      this.cells[pixel * this.near + k] = i;
      this.weights[pixel * this.near + k] = raw[k] / sum;
    });
    this.cover[pixel] = 255 * Math.min(1, Math.max(0, 2.6 - Math.sqrt(least) / spacing));
  }

  // values[i]: value of cell i, 0 to 1 of the scale; table: 256 colours
  paint(values, table) {
    const { near, cells, weights, cover } = this;
    const { data } = this.image;
    for (let pixel = 0; pixel < cover.length; pixel++) {
      let value = 0;
      const first = pixel * near;
      for (let k = first; k < first + near; k++) value += weights[k] * values[cells[k]];
      const colour = 3 * Math.min(255, Math.round(255 * value));
      const at = 4 * pixel;
      data[at] = table[colour];
      data[at + 1] = table[colour + 1];
      data[at + 2] = table[colour + 2];
      data[at + 3] = cover[pixel];
    }
    this.context.putImageData(this.image, 0, 0);
    return this.picture;
  }
}
