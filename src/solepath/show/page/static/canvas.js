// A canvas that always has as many pixels as the screen shows of it.

const MAX_PIXEL_RATIO = 2; // device pixels per CSS px; more cost time and show nothing

export class Surface {
  width = 0; // CSS px
  height = 0;
  ratio = 1;

  // resized() is called when the canvas has another size, and is blank.
  constructor(canvas, resized) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.resized = resized;
    new ResizeObserver(() => this.fit()).observe(canvas);
    this.#watchRatio();
    this.fit();
  }

  fit() {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = Math.min(MAX_PIXEL_RATIO, devicePixelRatio || 1);
    if (clientWidth === this.width && clientHeight === this.height && ratio === this.ratio) return;
    Object.assign(this, { width: clientWidth, height: clientHeight, ratio });
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    this.resized();
  }

  // Clear the canvas; sizes are in CSS px.
  start() {
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    return this.context;
  }

  // Zooming the page or moving it to another screen may change only the pixel ratio, not the size.
  #watchRatio() {
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener(
      "change",
      () => {
        this.fit();
        this.#watchRatio();
      },
      { once: true },
    );
  }
}

// A text alternative that changes at most once a second, so that a screen reader is not interrupted. The last text of a
// second is the one that is set.
export class Alternative {
  #waiting = null;
  #silent = false;

  constructor(canvas) {
    this.canvas = canvas;
  }

  setText(words) {
    this.#waiting = words;
    if (!this.#silent) this.#speak();
  }

  #speak() {
    const label = this.#waiting();
    this.#waiting = null;
    if (label !== this.canvas.getAttribute("aria-label")) this.canvas.setAttribute("aria-label", label);
    this.#silent = true;
    setTimeout(() => {
      this.#silent = false;
      if (this.#waiting !== null) this.#speak();
    }, 1000);
  }
}

// The least round number (1, 2 or 5 times a power of ten) that is not below `value`.
export function round(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-6)));
  return [1, 2, 5, 10].find((step) => step * power >= value * 0.999) * power;
}

export const TEXT_SIZE = 12; // px, least size of a text
export const FONT_FAMILY = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif';
export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
