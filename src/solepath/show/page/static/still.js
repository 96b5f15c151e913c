// A picture of what does not move, larger than the canvas: while the view moves over it, nothing is drawn again.

const MARGIN = 140; // px beyond each edge of the canvas
const STRETCH = [0.6, 1.7]; // by how much the picture may be scaled while the view zooms

export class Still {
  #layer = document.createElement("canvas");
  #key = "";
  #view = null; // that of the picture
  fresh = true; // true while nothing is drawn

  // Returns the context and px([x, y] in m) in which to draw what is new. view: {x, y, scale, middle: px of the view's
  // middle in the canvas}; settled: the view does not zoom.
  begin({ width, height, ratio }, view, key, settled) {
    this.size = [width + 2 * MARGIN, height + 2 * MARGIN];
    const whole = `${key} ${width} ${height} ${ratio} ${view.middle}`;
    this.fresh = whole !== this.#key || !this.#isUsable(width, height, view, settled);
    if (this.fresh) {
      this.#key = whole;
      this.#view = view;
      [this.#layer.width, this.#layer.height] = this.size.map((side) => Math.round(side * ratio));
    }
    const context = this.#layer.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { x, y, scale } = this.#view;
    const [left, top] = view.middle.map((at) => MARGIN + at);
    return { context, scale, size: this.size, px: ([mx, my]) => [left + (mx - x) * scale, top - (my - y) * scale] };
  }

  // The view, moved by less than a pixel so that the picture lies on whole ones and stays sharp.
  sharp(view, ratio) {
    if (this.#view === null || view.scale !== this.#view.scale) return view;
    const whole = (at, origin) => origin + Math.round((at - origin) * view.scale * ratio) / (view.scale * ratio);
    return { ...view, x: whole(view.x, this.#view.x), y: whole(view.y, this.#view.y) };
  }

  draw(context, view) {
    context.drawImage(this.#layer, ...this.#frame(view));
  }

  // Where the picture lies in the canvas: its left and its upper edge, its width and its height, px.
  #frame({ x, y, scale, middle }) {
    const stretch = scale / this.#view.scale;
    const left = middle[0] + (this.#view.x - x) * scale - stretch * (MARGIN + middle[0]);
    const top = middle[1] - (this.#view.y - y) * scale - stretch * (MARGIN + middle[1]);
    return [left, top, ...this.size.map((side) => side * stretch)];
  }

  #isUsable(width, height, view, settled) {
    const stretch = view.scale / this.#view.scale;
    if (settled ? stretch !== 1 : stretch < STRETCH[0] || stretch > STRETCH[1]) return false;
    const [left, top, w, h] = this.#frame(view);
    return left <= 0 && top <= 0 && left + w >= width && top + h >= height;
  }
}
