// A picture of what does not move, larger than the canvas: while the view moves over it, nothing is drawn again.

const MARGIN = 140; // px beyond each edge of the canvas

export class Still {
  #layer = document.createElement("canvas");
  #key = "";
  #view = null; // that of the picture
  fresh = true; // true while nothing is drawn

  // Returns the context and px([x, y] in m) in which to draw what is new. view: {x, y, scale, middle: px of the view's
  // middle in the canvas}
  begin({ width, height, ratio }, view, key) {
    this.size = [width + 2 * MARGIN, height + 2 * MARGIN];
    const whole = `${key} ${width} ${height} ${ratio} ${view.middle} ${view.scale}`;
    this.fresh = whole !== this.#key || this.#corner(view).some((at) => at > 0 || at < -2 * MARGIN);
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
    context.drawImage(this.#layer, ...this.#corner(view), ...this.size);
  }

  // The upper left corner of the picture in the canvas, px.
  #corner({ x, y, scale }) {
    return [(this.#view.x - x) * scale - MARGIN, (y - this.#view.y) * scale - MARGIN];
  }
}
