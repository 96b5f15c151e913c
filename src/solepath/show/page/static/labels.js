// Labels of a drawing: none lies over another, or over what is kept free. Where two want the same place, the one of more
// weight has it, and the other goes to its next spot or is left out.

import { FONT_FAMILY, TEXT_SIZE } from "./canvas.js";
import { theme } from "./theme.js";

const LINE_HEIGHT = 1.2; // of a line, as a share of the size of its text
const GAP = 3; // px between two labels
const HALO = 2; // px of the ground around a text
const MAX_SPRITES = 500; // pictures of texts that are kept
const PUBLISHING_INTERVAL = 1000; // ms

const pen = document.createElement("canvas").getContext("2d");
const sizes = new Map(); // [width, height] by font and words
const sprites = new Map();

const fontOf = ({ size = TEXT_SIZE, bold = false }) => `${bold ? 600 : 400} ${size}px ${FONT_FAMILY}`;

// Width and height of words, which may have several lines, px.
export function measured(words, style = {}) {
  const key = `${fontOf(style)} ${words}`;
  if (sizes.size > MAX_SPRITES) sizes.clear();
  if (!sizes.has(key)) {
    pen.font = fontOf(style);
    const lines = words.split("\n");
    const width = Math.max(...lines.map((line) => pen.measureText(line).width));
    sizes.set(key, [Math.ceil(width), lines.length * Math.round((style.size ?? TEXT_SIZE) * LINE_HEIGHT)]);
  }
  return sizes.get(key);
}

export class Labels {
  #timer = null;
  #published = "";
  #placed = [];

  // ground: the colour behind the texts, by its name in style.css
  constructor(canvas, ground) {
    this.canvas = canvas;
    this.ground = ground;
  }

  start({ width, height, ratio }) {
    Object.assign(this, { width, height, ratio, wanted: [], taken: [], avoided: [] });
  }

  // No label lies over this rectangle, px.
  keep(x, y, width, height) {
    this.taken.push([x, y, width, height]);
  }

  // A label lies over this rectangle, px, only if it has no other spot and is not strict.
  avoid(x, y, width, height) {
    this.avoided.push([x, y, width, height]);
  }

  // spots: [x, y, align] each, best first, px: y is the middle of the words, x their left, middle or right ("left",
  // "center", "right"). style: weight, colour (by name), size (px), bold, upright (read from below), strict, ground.
  add(words, spots, style = {}) {
    this.wanted.push({ words, spots, style });
  }

  // Places and draws the labels.
  finish(context) {
    this.#placed = [];
    const wanted = this.wanted.sort((a, b) => (b.style.weight ?? 0) - (a.style.weight ?? 0));
    for (const { words, spots, style } of wanted) {
      const [along, across] = measured(words, style);
      const [width, height] = style.upright ? [across, along] : [along, across];
      const boxes = spots.map((spot) => this.#box(spot, width, height)).filter((one) => this.#free(one));
      if (boxes.length === 0) continue;
      const box = boxes.find((one) => !this.avoided.some((other) => overlap(one, other, 0))) ?? (style.strict ? null : boxes[0]);
      if (box === null) continue;
      this.taken.push(box);
      this.#placed.push([words, ...box]);
      const picture = sprite(words, style, style.ground ?? this.ground, this.ratio);
      context.drawImage(picture, box[0] - HALO, box[1] - HALO, width + 2 * HALO, height + 2 * HALO);
    }
    if (this.#timer === null) this.#publish();
  }

  // On whole device pixels, where texts are sharp.
  #box([x, y, align = "center"], width, height) {
    const left = align === "left" ? x : align === "right" ? x - width : x - width / 2;
    const sharp = (at) => Math.round(at * this.ratio) / this.ratio;
    return [sharp(left), sharp(y - height / 2), width, height];
  }

  #free([x, y, width, height]) {
    if (x < 0 || y < 0 || x + width > this.width || y + height > this.height) return false;
    return !this.taken.some((other) => overlap([x, y, width, height], other, GAP));
  }

  // For tests: canvas.dataset.labels is a list of [words, x, y, width, height] in CSS px of the canvas, as JSON.
  #publish() {
    const words = JSON.stringify(this.#placed);
    if (words !== this.#published) this.canvas.dataset.labels = this.#published = words;
    this.#timer = setTimeout(() => {
      this.#timer = null;
      if (JSON.stringify(this.#placed) !== this.#published) this.#publish();
    }, PUBLISHING_INTERVAL);
  }
}

const overlap = ([x, y, width, height], [a, b, w, h], gap) =>
  x < a + w + gap && a < x + width + gap && y < b + h && b < y + height;

// Words with a halo, drawn once: texts are slow to draw.
function sprite(words, style, ground, ratio) {
  const { colour = "muted", upright = false, size = TEXT_SIZE } = style;
  const key = [fontOf(style), theme.colours[colour], theme.colours[ground], upright, ratio, words].join(" ");
  const known = sprites.get(key);
  if (known) return known;
  if (sprites.size > MAX_SPRITES) sprites.clear();
  const [width, height] = measured(words, style);
  const picture = document.createElement("canvas");
  const [w, h] = (upright ? [height, width] : [width, height]).map((side) => (side + 2 * HALO) * ratio);
  Object.assign(picture, { width: Math.round(w), height: Math.round(h) });
  const context = picture.getContext("2d");
  context.scale(ratio, ratio);
  if (upright) {
    context.translate(0, width + 2 * HALO);
    context.rotate(-Math.PI / 2);
  }
  context.font = fontOf(style);
  context.textAlign = "center";
  context.lineWidth = 2 * HALO;
  context.lineJoin = "round";
  context.strokeStyle = theme.colours[ground];
  context.fillStyle = theme.colours[colour];
  words.split("\n").forEach((line, i) => {
    const y = HALO + i * Math.round(size * LINE_HEIGHT) + 0.95 * size; // of the base line
    context.strokeText(line, HALO + width / 2, y);
    context.fillText(line, HALO + width / 2, y);
  });
  sprites.set(key, picture);
  return picture;
}
