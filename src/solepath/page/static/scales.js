// Where the colours of pressure end. The highest of a moment is a fine thing to look at, but one edge of a shoe that
// presses on one cell for a hundredth of a second must not make all else pale: the scale ends where most moments stay
// below, and it says so.

const BINS = 20; // per decade
const LOWEST = 0.1; // kPa or counts
const USUAL = 0.85; // share of the moments that stay below
const MOMENTS = 90; // once so many were seen; before, half of them
const LEAST = { N: 100, counts: 1 };
const TOPS = [1, 2, 3, 4, 6, 8, 10]; // times powers of ten

export class Scales {
  #layouts = "";

  constructor() {
    this.#clear();
  }

  #clear() {
    this.tops = { ...LEAST };
    this.beyond = { N: false, counts: false }; // something was higher
    this.counts = { N: [], counts: [] };
  }

  // The same insoles after a seek keep their scale.
  wear(layouts) {
    if (layouts !== this.#layouts) this.#clear();
    this.#layouts = layouts;
  }

  // foot: {cells, peak}: one byte a cell, 255 for the peak
  hear(layout, { cells, peak }) {
    if (layout === null || !(peak > 0)) return;
    const { unit } = layout;
    let highest = 0;
    const count = Math.min(cells.length, layout.cells.length);
    for (let i = 0; i < count; i++) highest = Math.max(highest, pressure(layout, i, (cells[i] / 255) * peak));
    const bin = Math.floor(BINS * Math.log10(highest / LOWEST));
    if (!(bin > 0) || cells.every((cell) => cell < 4)) return; // nobody stands on it
    const bins = this.counts[unit];
    bins[bin] = (bins[bin] ?? 0) + 1;
    const moments = bins.reduce((sum, one) => sum + one, 0);
    if (moments < 10) return;
    let above = (moments < MOMENTS ? 0.5 : 1 - USUAL) * moments;
    let at = bins.length;
    while (above >= 0 && at > 0) above -= bins[--at] ?? 0;
    const top = Math.max(LEAST[unit], rounded(LOWEST * 10 ** ((at + 1) / BINS)));
    // it does not flicker
    if (top > this.tops[unit] || top < 0.4 * this.tops[unit] || moments === MOMENTS) this.tops[unit] = top;
    this.beyond[unit] = this.beyond[unit] || highest > this.tops[unit];
  }
}

// kPa where newtons and areas are known, else the value itself.
export function pressure(layout, i, value) {
  return layout.unit === "N" ? value / layout.cells[i][2] / 1000 : value;
}

function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return TOPS.find((step) => step * power >= value * 0.999) * power;
}
