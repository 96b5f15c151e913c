// Heights of the track in those of the plan, so that all drawings have one zero.

// points [t, x, y, z] with the height that the places [t, level, x, y, z] give; before the first place and between two of
// them it changes as along the track.
export function onPlanHeights(points, places) {
  if (places.length === 0) return points;
  let [k, seen] = [0, 0];
  let offset = null;
  return points.map(([t, x, y, z]) => {
    while (k < places.length && (offset === null || places[k][0] <= t)) {
      while (seen + 1 < points.length && points[seen + 1][0] <= places[k][0]) seen += 1;
      offset = places[k][4] - points[seen][3];
      k += 1;
    }
    return [t, x, y, z + offset];
  });
}
