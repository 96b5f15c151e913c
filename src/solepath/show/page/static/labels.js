// Labels of a drawing: none lies over another, or over what is kept free. Where two want the same place, the one of more
// weight has it, and the other goes to its next spot or is left out.

import { FONT_FAMILY, TEXT_SIZE } from "./canvas.js";
import { colour } from "./theme.js";

const LINE_HEIGHT = Math.round(1.2 * TEXT_SIZE); // px
const GAP = 3; // px between two labels
const HALO = 2; // px of the ground around a text
const MAX_SPRITES = 500; // pictures of texts that are kept

const pen = document.createElement("canvas").getContext("2d");
const sprites = new Map();
const sizes = new Map();

const fontOf = (bold) => `${bold ? 600 : 400} ${TEXT_SIZE}px ${FONT_FAMILY}`;

// What a map has for this key, or else what make() returns, which it then has.
function kept(map, key, make) {
  if (!map.has(key)) {
    if (map.size > MAX_SPRITES) map.clear();
    map.set(key, make());
  }
  return map.get(key);
}

// Width and height of words, which may have several lines, px.
export function measured(words, bold = false) {
  return kept(sizes, `${bold} ${words}`, () => {
    pen.font = fontOf(bold);
    const lines = words.split("\n");
    return [Math.ceil(Math.max(...lines.map((line) => pen.measureText(line).width))), lines.length * LINE_HEIGHT];
  });
}

export class Labels {
  placed = []; // [words, x, y, width, height] each, px

  // ground: the colour behind the texts, by its name in style.css
  constructor(surface, ground) {
    this.surface = surface;
    this.ground = ground;
  }

  start() {
    Object.assign(this, { wanted: [], taken: [], avoided: [] });
  }

  // No label lies over this rectangle, px.
  keep(x, y, width, height) {
    this.taken.push([x, y, width, height]);
  }

  // No label lies over a square about this point.
  keepAround([x, y], reach) {
    this.keep(x - reach, y - reach, 2 * reach, 2 * reach);
  }

  // A label lies over this rectangle, px, only if it has no other spot and is not strict.
  avoid(x, y, width, height) {
    const isSeen = x + width > 0 && y + height > 0 && x < this.surface.width && y < this.surface.height;
    if (isSeen) this.avoided.push([x, y, width, height]);
  }

  // spots: [x, y, align] each, best first, px: y is the middle of the words, x their left, middle or right ("left",
  // "center", "right"). style: weight, colour (by name), bold, upright (read from below), strict, ground.
  add(words, spots, style = {}) {
    this.wanted.push({ words, spots, style });
  }

  // Places and draws the labels.
  finish() {
    const { context, ratio } = this.surface;
    this.placed = [];
    for (const { words, spots, style } of this.wanted.sort((a, b) => (b.style.weight ?? 0) - (a.style.weight ?? 0))) {
      const [along, across] = measured(words, style.bold);
      const [width, height] = style.upright ? [across, along] : [along, across];
      const boxes = spots.map((spot) => this.#box(spot, width, height)).filter((one) => this.#free(one));
      const clear = boxes.find((one) => !this.avoided.some((other) => overlap(one, other, 0)));
      const box = clear ?? (style.strict ? undefined : boxes[0]);
      if (box === undefined) continue;
      this.taken.push(box);
      this.placed.push([words, ...box]);
      const picture = sprite(words, { ground: this.ground, ...style }, ratio);
      context.drawImage(picture, box[0] - HALO, box[1] - HALO, width + 2 * HALO, height + 2 * HALO);
    }
  }

  // On whole device pixels, where texts are sharp.
  #box([x, y, align = "center"], width, height) {
    const left = align === "left" ? x : align === "right" ? x - width : x - width / 2;
    const sharp = (at) => Math.round(at * this.surface.ratio) / this.surface.ratio;
    return [sharp(left), sharp(y - height / 2), width, height];
  }

  #free(box) {
    const [x, y, width, height] = box;
    if (x < 0 || y < 0 || x + width > this.surface.width || y + height > this.surface.height) return false;
    return !this.taken.some((other) => overlap(box, other, GAP));
  }
}

const overlap = ([x, y, width, height], [a, b, w, h], gap) =>
  x < a + w + gap && a < x + width + gap && y < b + h && b < y + height;

// Words with a halo, drawn once: texts are slow to draw.
function sprite(words, { colour: name = "muted", ground, upright = false, bold = false }, ratio) {
  return kept(sprites, [bold, colour(name), colour(ground), upright, ratio, words].join(" "), () => {
    const [width, height] = measured(words, bold).map((side) => side + 2 * HALO);
    const [w, h] = upright ? [height, width] : [width, height];
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: Math.round(w * ratio), height: Math.round(h * ratio) });
    const context = picture.getContext("2d");
    context.scale(ratio, ratio);
    if (upright) context.transform(0, -1, 1, 0, 0, width); // a quarter turn to the left
    Object.assign(context, { font: fontOf(bold), textAlign: "center", lineWidth: 2 * HALO, lineJoin: "round" });
    Object.assign(context, { strokeStyle: colour(ground), fillStyle: colour(name) });
    words.split("\n").forEach((line, i) => {
      const y = HALO + i * LINE_HEIGHT + 0.95 * TEXT_SIZE; // of the base line
      context.strokeText(line, width / 2, y);
      context.fillText(line, width / 2, y);
    });
    return picture;
  });
}
