// The part of the track on the plan that belongs to the present candidate. When another candidate becomes the
// likeliest, the track that was drawn before belongs to a rejected candidate.

const MIN_JUMP = 5; // m by which the place moves more than the wearer when another candidate becomes the likeliest
const DRIFT_SHARE = 0.2; // error of the track as a share of the distance between two places

export class Possibility {
  #key = "";
  #seen = 0;
  #since = 0;

  // Returns the index of the first place of the track that belongs to the present place.
  since({ places, tracks, generation, thinned }) {
    const key = `${generation} ${thinned}`;
    if (key !== this.#key) [this.#key, this.#seen, this.#since] = [key, 1, 0];
    for (; this.#seen < places.length; this.#seen++) {
      if (jumped(places[this.#seen - 1], places[this.#seen], tracks.wearer)) this.#since = this.#seen;
    }
    return this.#since;
  }
}

// The track turns and drifts against the plan, but its length is right.
function jumped([t1, , x1, y1], [t2, , x2, y2], track) {
  const far = Math.hypot(x2 - x1, y2 - y1);
  const [a, b] = [at(track, t1), at(track, t2)];
  const walked = a && b ? Math.hypot(b[1] - a[1], b[2] - a[2]) : 0;
  return Math.abs(far - walked) > MIN_JUMP + DRIFT_SHARE * walked;
}

// Last point that is not later than t, or else the first point.
function at(track, t) {
  let [low, high] = [0, track.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (track[middle][0] <= t) low = middle;
    else high = middle - 1;
  }
  return track[low];
}
