// On the plan: from where on what was walked belongs to the place that the wearer is thought to be at now. When another
// possibility becomes the likeliest, what was drawn before is of one that was given up.

const JUMP = 5; // m by which a place went elsewhere than the wearer did
const DRIFT = 0.2; // of what was walked between two places: as much may the track be off

export class Possibility {
  #key = "";
  #seen = 0;
  #since = 0;

  // The index of the first place of it.
  since({ places, tracks, generation, thinned }) {
    const key = `${generation} ${thinned}`;
    if (key !== this.#key) [this.#key, this.#seen, this.#since] = [key, 1, 0];
    for (; this.#seen < places.length; this.#seen++) {
      if (jumped(places[this.#seen - 1], places[this.#seen], tracks.wearer)) this.#since = this.#seen;
    }
    return this.#since;
  }
}

// The track turns and drifts against the plan, but goes as far.
function jumped([t1, , x1, y1], [t2, , x2, y2], track) {
  const far = Math.hypot(x2 - x1, y2 - y1);
  const [a, b] = [at(track, t1), at(track, t2)];
  const walked = a && b ? Math.hypot(b[1] - a[1], b[2] - a[2]) : 0;
  return Math.abs(far - walked) > JUMP + DRIFT * walked;
}

// The last point until t, or the first one there is.
function at(track, t) {
  let [low, high] = [0, track.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (track[middle][0] <= t) low = middle;
    else high = middle - 1;
  }
  return track[low];
}
