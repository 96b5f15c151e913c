// A picture of what does not move, larger than the canvas: while the view moves over it, nothing is drawn again.

const MARGIN = 140; // px beyond each edge of the canvas
const STRETCH = [0.6, 1.7]; // by how much the picture may be scaled while the view zooms

export class Still {
  #layer = document.createElement("canvas");
  #key = "";
  #view = null; // that of the picture
  fresh = true; // true while nothing is drawn

  // Returns the context and px([x, y] in m) in which to draw what is new. middle: px of the view's middle in the canvas;
  // settled: the view does not zoom.
  begin(surface, view, middle, key, settled) {
    const { width, height, ratio } = surface;
    const whole = `${key} ${width} ${height} ${ratio} ${middle}`;
    this.fresh = whole !== this.#key || !this.#usable(surface, view, middle, settled);
    if (this.fresh) {
      this.#key = whole;
      this.#view = { ...view };
      this.#layer.width = Math.round((width + 2 * MARGIN) * ratio);
      this.#layer.height = Math.round((height + 2 * MARGIN) * ratio);
    }
    const context = this.#layer.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { x, y, scale } = this.#view;
    const [left, top] = [MARGIN + middle[0], MARGIN + middle[1]];
    return { context, scale, size: [width + 2 * MARGIN, height + 2 * MARGIN], px: ([mx, my]) => [left + (mx - x) * scale, top - (my - y) * scale] };
  }

  // The view, moved by less than a pixel so that the picture lies on whole ones and stays sharp.
  sharp(view, ratio) {
    if (this.#view === null || view.scale !== this.#view.scale) return view;
    const whole = (at, origin) => origin + Math.round((at - origin) * view.scale * ratio) / (view.scale * ratio);
    return { ...view, x: whole(view.x, this.#view.x), y: whole(view.y, this.#view.y) };
  }

  draw(context, { width, height }, view, middle) {
    const [left, top, stretch] = this.#corner(view, middle);
    context.drawImage(this.#layer, left, top, (width + 2 * MARGIN) * stretch, (height + 2 * MARGIN) * stretch);
  }

  #corner(view, middle) {
    const { x, y, scale } = this.#view;
    const stretch = view.scale / scale;
    return [
      middle[0] + (x - view.x) * view.scale - stretch * (MARGIN + middle[0]),
      middle[1] - (y - view.y) * view.scale - stretch * (MARGIN + middle[1]),
      stretch,
    ];
  }

  #usable({ width, height }, view, middle, settled) {
    const [left, top, stretch] = this.#corner(view, middle);
    if (settled && stretch !== 1) return false;
    if (stretch < STRETCH[0] || stretch > STRETCH[1]) return false;
    const [right, bottom] = [left + (width + 2 * MARGIN) * stretch, top + (height + 2 * MARGIN) * stretch];
    return left <= 0 && top <= 0 && right >= width && bottom >= height;
  }
}
