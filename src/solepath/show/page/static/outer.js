// Which walls of a level are outer ones: those beside the ground that is reached from outside without a wall or a door
// in between, on a small picture of the level.

const SIDE = 256; // px of the picture
const BORDER = 6; // px around the level
const LINE = 1.6; // px, width of a wall in the picture
const OFF = 2.5; // px from a wall to the ground beside it
const SAMPLES = [0.25, 0.5, 0.75]; // along a wall; most of them must be beside the outside

const known = new WeakMap();

// A list with true for each outer wall. outlines: those of the level's stairs and lifts; extent: of the plan.
export function outerWalls(level, outlines, extent) {
  if (!known.has(level)) known.set(level, found(level, outlines, extent));
  return known.get(level);
}

function found({ walls, doors, rooms }, outlines, [x0, y0, x1, y1]) {
  const scale = (SIDE - 2 * BORDER) / Math.max(1, x1 - x0, y1 - y0);
  const px = ([x, y]) => [BORDER + (x - x0) * scale, BORDER + (y - y0) * scale];
  const outside = flooded(picture([...rooms, ...outlines].map((ring) => ring.map(px)), [...walls, ...doors], px));
  return walls.map(([ax, ay, bx, by]) => {
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const off = [(-(by - ay) / length) * OFF, ((bx - ax) / length) * OFF];
    const beside = SAMPLES.filter((share) => {
      const [x, y] = px([ax + share * (bx - ax), ay + share * (by - ay)]);
      return outside(x + off[0], y + off[1]) || outside(x - off[0], y - off[1]);
    });
    return 2 * beside.length > SAMPLES.length;
  });
}

// Opacity of each px of the level, where rooms, walls and doors are opaque.
function picture(rings, lines, px) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = SIDE;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.lineWidth = LINE;
  for (const ring of rings) {
    context.beginPath();
    for (const point of ring) context.lineTo(...point);
    context.closePath();
    context.fill();
    context.stroke();
  }
  context.beginPath();
  for (const [ax, ay, bx, by] of lines) {
    context.moveTo(...px([ax, ay]));
    context.lineTo(...px([bx, by]));
  }
  context.stroke();
  return context.getImageData(0, 0, SIDE, SIDE).data;
}

function flooded(data) {
  const reached = new Uint8Array(SIDE * SIDE);
  const open = [0];
  while (open.length > 0) {
    const at = open.pop();
    if (reached[at] || data[4 * at + 3] > 60) continue;
    reached[at] = 1;
    const x = at % SIDE;
    if (x > 0) open.push(at - 1);
    if (x < SIDE - 1) open.push(at + 1);
    if (at >= SIDE) open.push(at - SIDE);
    if (at < SIDE * (SIDE - 1)) open.push(at + SIDE);
  }
  return (x, y) => reached[Math.round(y) * SIDE + Math.round(x)] === 1;
}
