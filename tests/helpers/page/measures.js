// Measures what a page shows: runs in it before any other script, and hands `measured` to tests (measures.py).
//
// Boxes are in CSS px of the whole page. Texts of canvases are recorded where they are drawn.

globalThis.measured = (() => {
  const LEAST_OVERLAP = 1; // px: neighbours may touch
  const CONTROLS = "a[href], button, input, select, textarea, summary, [tabindex]";

  // ---- canvases -----------------------------------------------------------------------------------------------------
  const written = new Map(); // canvas to its texts, boxes in its own pixels

  const corners = (m, x, y, width, height) => {
    const points = [[x, y], [x + width, y], [x, y + height], [x + width, y + height]];
    const xs = points.map(([a, b]) => m.a * a + m.c * b + m.e);
    const ys = points.map(([a, b]) => m.b * a + m.d * b + m.f);
    return box(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys));
  };
  const box = (left, top, right, bottom) => ({ left, top, right, bottom });

  let reads = false; // whether the ground of texts is read when they are drawn, which is slow
  const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  // The most frequent colour around a text, without its own.
  const groundOf = (canvas, { left, top, right, bottom }, own) => {
    const [x, y] = [Math.floor(left) - 2, Math.floor(top) - 2];
    const [width, height] = [Math.ceil(right) + 2 - x, Math.ceil(bottom) + 2 - y];
    Object.assign(copy.canvas, { width, height });
    copy.drawImage(canvas, x, y, width, height, 0, 0, width, height);
    const { data } = copy.getImageData(0, 0, width, height);
    const [below, counts] = [ground(canvas), new Map()];
    for (let i = 0; i < data.length; i += 4) {
      const colour = over({ rgb: [...data.slice(i, i + 3)], opacity: data[i + 3] / 255 }, below).map(Math.round);
      if (colour.every((value, k) => Math.abs(value - own[k]) < 8)) continue;
      counts.set(colour.join(), (counts.get(colour.join()) ?? 0) + 1);
    }
    const [found] = [...counts].sort((one, other) => other[1] - one[1]);
    return found === undefined ? own : found[0].split(",").map(Number);
  };
  const contrastOn = ({ canvas }, where, colour) => {
    if (!reads || !canvas.isConnected) return null;
    const below = groundOf(canvas, where, colour.rgb);
    return contrast(over(colour, below), below);
  };
  const over = ({ rgb, opacity }, below) => rgb.map((value, i) => opacity * value + (1 - opacity) * below[i]);

  const write = (filled) => (context, text, x, y) => {
    if (String(text).trim() === "" || context.globalAlpha < 0.02) return;
    const m = context.getTransform();
    const at = context.measureText(text);
    const [width, height] = [
      at.actualBoundingBoxLeft + at.actualBoundingBoxRight,
      at.actualBoundingBoxAscent + at.actualBoundingBoxDescent,
    ];
    const where = corners(m, x - at.actualBoundingBoxLeft, y - at.actualBoundingBoxAscent, width, height);
    const size = parseFloat(/([\d.]+)px/.exec(context.font)[1]) * Math.hypot(m.a, m.b);
    const texts = written.get(context.canvas) ?? [];
    const { rgb, opacity } = channels(context.fillStyle);
    const colour = { rgb, opacity: opacity * context.globalAlpha };
    const contrasts = filled ? contrastOn(context, where, colour) : null;
    const same = (one) => one.text === String(text) && Math.hypot(one.left - where.left, one.top - where.top) < 4;
    written.set(context.canvas, [...texts.filter((one) => !same(one)), { text: String(text), size, colour, contrasts, ...where }]);
  };
  const erase = (canvas, area) => {
    const texts = written.get(canvas) ?? [];
    written.set(canvas, texts.filter((one) => !overlaps(one, area)));
  };
  const before = (prototype, name, action) => {
    const own = prototype[name];
    prototype[name] = function (...given) {
      action(this, ...given);
      return own.apply(this, given);
    };
  };
  const after = (prototype, name, action) => {
    const own = prototype[name];
    prototype[name] = function (...given) {
      own.apply(this, given);
      action(this, ...given);
    };
  };
  for (const kind of [CanvasRenderingContext2D, OffscreenCanvasRenderingContext2D]) {
    before(kind.prototype, "fillText", write(true));
    before(kind.prototype, "strokeText", write(false));
    before(kind.prototype, "clearRect", (context, ...area) =>
      erase(context.canvas, corners(context.getTransform(), ...area)),
    );
    after(kind.prototype, "drawImage", (context, image, x, y, width, height, ...more) => {
      if (more.length > 0) return; // a part of an image
      const m = context.getTransform();
      const [across, down] = [(width ?? image.width) / image.width, (height ?? image.height) / image.height];
      const copies = (written.get(image) ?? []).map(({ text, size, colour, left, top, right, bottom }) => {
        const where = corners(m, x + left * across, y + top * down, (right - left) * across, (bottom - top) * down);
        const scale = down * Math.hypot(m.a, m.b);
        return { text, size: size * scale, colour, contrasts: contrastOn(context, where, colour), ...where };
      });
      written.set(context.canvas, [...(written.get(context.canvas) ?? []), ...copies]);
    });
  }
  for (const name of ["width", "height"]) {
    const own = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, name);
    Object.defineProperty(HTMLCanvasElement.prototype, name, {
      ...own,
      set(value) {
        written.delete(this);
        own.set.call(this, value);
      },
    });
  }

  const canvasTexts = () =>
    [...document.querySelectorAll("canvas")].filter(isShown).flatMap((canvas) => {
      const frame = canvas.getBoundingClientRect();
      const scale = canvas.clientWidth / canvas.width;
      return (written.get(canvas) ?? []).map((one) => ({
        text: one.text,
        size: one.size * scale,
        contrasts: one.contrasts,
        of: canvas,
        layer: layer(canvas),
        cut: one.left < -1 || one.top < -1 || one.right > canvas.width + 1 || one.bottom > canvas.height + 1,
        boxes: [
          box(
            frame.left + scrollX + one.left * scale,
            frame.top + scrollY + one.top * scale,
            frame.left + scrollX + one.right * scale,
            frame.top + scrollY + one.bottom * scale,
          ),
        ],
      }));
    });

  // ---- the document -------------------------------------------------------------------------------------------------
  const isShown = (element) => {
    if (!element.checkVisibility({ opacityProperty: true, visibilityProperty: true })) return false;
    for (let one = element; one !== null; one = one.parentElement) {
      const { overflow, clipPath } = getComputedStyle(one);
      const { width, height } = one.getBoundingClientRect();
      if ((overflow !== "visible" || clipPath !== "none") && (width <= 1 || height <= 1)) return false; // for readers
    }
    return true;
  };
  // what is fixed to the screen lies over the rest on purpose
  const layer = (element) => {
    for (let one = element; one !== null; one = one.parentElement) {
      if (["fixed", "sticky"].includes(getComputedStyle(one).position)) return one.id || one.tagName;
    }
    return "page";
  };
  const clipped = (rect, element) => {
    let { left, top, right, bottom } = rect;
    for (let one = element; one !== null && one !== document.body; one = one.parentElement) {
      const { overflowX, overflowY, position } = getComputedStyle(one);
      const frame = one.getBoundingClientRect();
      if (overflowX !== "visible") [left, right] = [Math.max(left, frame.left), Math.min(right, frame.right)];
      if (overflowY !== "visible") [top, bottom] = [Math.max(top, frame.top), Math.min(bottom, frame.bottom)];
      if (position === "fixed") break;
    }
    return box(left + scrollX, top + scrollY, right + scrollX, bottom + scrollY);
  };
  const hasSize = ({ left, top, right, bottom }) => right - left > 0.5 && bottom - top > 0.5;

  const documentTexts = () => {
    const found = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
      const element = node.parentElement;
      if (node.data.trim() === "" || element.closest("script, style, noscript, option") || !isShown(element)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      const size = parseFloat(getComputedStyle(element).fontSize) * (element.getScreenCTM?.().a ?? 1);
      // a line is higher than its letters
      const boxes = [...range.getClientRects()]
        .map(({ left, right, top, bottom }) => {
          const [middle, half] = [(top + bottom) / 2, Math.min(bottom - top, size) / 2];
          return clipped(box(left, middle - half, right, middle + half), element);
        })
        .filter(hasSize);
      if (boxes.length > 0) {
        found.push({ text: node.data.trim(), size, of: element, layer: layer(element), cut: false, boxes });
      }
    }
    for (const element of document.querySelectorAll("select, input:not([type=range])")) {
      if (!isShown(element)) continue;
      const size = parseFloat(getComputedStyle(element).fontSize);
      const boxes = [clipped(element.getBoundingClientRect(), element)];
      found.push({ text: element.value, size, of: element, layer: layer(element), cut: false, boxes });
    }
    return found;
  };

  const texts = () => [...documentTexts(), ...canvasTexts()];
  const overlaps = (a, b) =>
    Math.min(a.right, b.right) - Math.max(a.left, b.left) > LEAST_OVERLAP &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > LEAST_OVERLAP;
  const name = (element) => {
    const near = element.closest("[id]");
    const words = element.getAttribute("aria-label") ?? element.textContent.trim().slice(0, 20);
    return element.id ? `#${element.id}` : `${near ? `#${near.id} ` : ""}${element.localName} "${words}"`;
  };
  const place = ({ text, of }) => `"${text.slice(0, 40)}" in ${name(of)}`;

  // ---- what tests compare with nothing ------------------------------------------------------------------------------
  const small = (least) =>
    texts()
      .filter(({ size }) => size < least - 0.01)
      .map((one) => `${one.size.toFixed(1)} px: ${place(one)}`);

  const overlapping = () => {
    const all = texts();
    const pressed = [...document.querySelectorAll("button, input, select, summary")].filter(isShown);
    const boxed = pressed.map((of) => ({
      text: "",
      of,
      layer: layer(of),
      boxes: [clipped(of.getBoundingClientRect(), of)].filter(hasSize),
    }));
    const found = [];
    const meet = (a, b) => a.layer === b.layer && a.boxes.some((one) => b.boxes.some((other) => overlaps(one, other)));
    all.forEach((one, k) => {
      for (const other of all.slice(k + 1)) if (meet(one, other)) found.push(`${place(one)} and ${place(other)}`);
      for (const other of boxed) {
        const apart = !other.of.contains(one.of) && !one.of.contains(other.of);
        if (apart && meet(one, other)) found.push(`${place(one)} and ${name(other.of)}`);
      }
    });
    return found;
  };

  // Texts of canvases whose contrast was read and is too small; those of the document are axe's.
  const pale = (least) =>
    canvasTexts()
      .filter(({ contrasts }) => contrasts !== null && contrasts < least)
      .map((one) => `contrast ${one.contrasts.toFixed(1)}: ${place(one)}`);

  const cut = () => texts().filter(({ cut }) => cut).map(place);

  // Texts that end in an ellipsis, but for those of several lines, whose rest is shown on request.
  const shortened = () =>
    [...document.querySelectorAll("body *")]
      .filter((one) => one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).textOverflow === "ellipsis")
      .filter((one) => isShown(one) && one.clientWidth > 0)
      .map((of) => place({ text: of.textContent.trim(), of }));

  const wide = () => {
    const { scrollWidth } = document.scrollingElement;
    const found = texts().filter(({ boxes }) => boxes.some(({ left, right }) => right > innerWidth + 0.5 || left < -0.5));
    return [...(scrollWidth > innerWidth ? [`the page is ${scrollWidth} px wide`] : []), ...found.map(place)];
  };

  // ---- layout shifts ------------------------------------------------------------------------------------------------
  const shifts = [];
  new PerformanceObserver((list) => {
    for (const { value, sources, startTime, hadRecentInput } of list.getEntries()) {
      const moved = sources.map(({ node, previousRect: a, currentRect: b }) => {
        const element = node?.nodeType === Node.TEXT_NODE ? node.parentElement : node;
        return `${element ? name(element) : "removed"} ${[a.x, a.y, a.width, a.height]} to ${[b.x, b.y, b.width, b.height]}`;
      });
      if (!hadRecentInput) shifts.push(`${value.toFixed(4)} at ${(startTime / 1000).toFixed(1)} s: ${moved.join("; ")}`);
    }
  }).observe({ type: "layout-shift", buffered: true });

  // ---- the keyboard -------------------------------------------------------------------------------------------------
  const controls = () =>
    [...document.querySelectorAll(CONTROLS)].filter(
      (one) => one.tabIndex >= 0 && !one.disabled && isShown(one) && one.closest("[inert]") === null,
    );
  // elements by the order in which they were first asked for: controls come and go while a walk is shown
  const numbers = new Map();
  const number = (element) => numbers.get(element) ?? numbers.set(element, numbers.size).get(element);
  const luminance = (colour) => {
    const parts = colour.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
  };
  // red, green, blue 0 to 255, and opacity 0 to 1, of any colour of CSS
  const channels = (colour) => {
    const context = new OffscreenCanvas(1, 1).getContext("2d");
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
    return { rgb: [r, g, b], opacity: a / 255 };
  };
  const contrast = (a, b) => {
    const [high, low] = [luminance(a), luminance(b)].sort((one, other) => other - one);
    return (high + 0.05) / (low + 0.05);
  };
  const ground = (element) => {
    for (let one = element; one !== null; one = one.parentElement) {
      const { rgb, opacity } = channels(getComputedStyle(one).backgroundColor);
      if (opacity > 0.9) return rgb;
    }
    return [255, 255, 255];
  };
  // The element that has the focus: its name, its place, and the contrast of its ring against what is around it.
  const focus = () => {
    const element = document.activeElement;
    if (element === null || element === document.body || element === document.documentElement) return null;
    const { outlineStyle, outlineWidth, outlineColor } = getComputedStyle(element);
    const { left, top, right, bottom } = element.getBoundingClientRect();
    const { rgb, opacity } = channels(outlineColor);
    const isSeen = outlineStyle !== "none" && parseFloat(outlineWidth) >= 1 && opacity > 0.5;
    return {
      name: name(element),
      layer: layer(element),
      control: number(element),
      box: [left + scrollX, top + scrollY, right + scrollX, bottom + scrollY],
      ring: isSeen ? contrast(rgb, ground(element.parentElement)) : 0,
      shown: right > 0 && bottom > 0 && left < innerWidth && top < innerHeight,
    };
  };

  const read = () => {
    reads = true;
  };
  return { texts, small, overlapping, pale, cut, shortened, wide, shifts, controls, number, name, focus, read };
})();
