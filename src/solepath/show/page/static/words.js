// Puts values into words.

export const PHASES = { LOADING: "loading", STATIONARY: "flat", PUSH_OFF: "push-off", SWING: "swing" };
export const ACTIVITIES = {
  STANDING: "Standing",
  WALKING: "Walking",
  RUNNING: "Running",
  STAIRS_UP: "Stairs up",
  STAIRS_DOWN: "Stairs down",
  ELEVATOR_UP: "Lift up",
  ELEVATOR_DOWN: "Lift down",
  UNKNOWN: "Not clear",
};
export const SUPPORTS = { DOUBLE: "both feet", LEFT: "left foot", RIGHT: "right foot", FLIGHT: "in the air" };
export const MODES = {
  STRAIGHT: "straight on",
  LEFT_WIDE: "wide bend to the left",
  LEFT_TIGHT: "tight bend to the left",
  RIGHT_WIDE: "wide bend to the right",
  RIGHT_TIGHT: "tight bend to the right",
  STANDING: "standing",
};
export const LINKS = { ok: "connected", silent: "silent", lost: "lost", waiting: "waiting" };

// A word of a newer version is shown as it comes.
export const wordOf = (words, key) =>
  Object.hasOwn(words, key)
    ? words[key]
    : String(key ?? "")
        .toLowerCase()
        .replaceAll("_", " ");
// Activity of the wearer in words; it is not known while no foot sends.
export const activityText = ({ now, last }) =>
  last === null ? wordOf(ACTIVITIES, now) : `Not known, last: ${wordOf(ACTIVITIES, last).toLowerCase()}`;
export const capital = (words) => words.charAt(0).toUpperCase() + words.slice(1);

export const fixed = (value, digits = 0) => {
  if (!Number.isFinite(value)) return "–";
  const shown = value.toFixed(Math.min(6, Math.max(0, digits)));
  return Number(shown) === 0 ? shown.replace("-", "") : shown.replace("-", "−");
};
export const percent = (share, digits = 0) => (Number.isFinite(share) ? `${fixed(100 * share, digits)} %` : "–");
export const signed = (value, digits) => (Number(value.toFixed(digits)) > 0 ? "+" : "") + fixed(value, digits);

// Shows 83.2 s as 1:23.
export function clock(seconds) {
  const whole = Math.max(0, Math.floor(Number.isFinite(seconds) ? seconds : 0));
  const two = (value) => String(value).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return (hours ? `${hours}:${two(minutes)}` : String(minutes)) + `:${two(whole % 60)}`;
}

export function span(seconds) {
  if (!Number.isFinite(seconds)) return "";
  return seconds < 60 ? `${Math.max(0, Math.floor(seconds))} s` : `${clock(seconds)} min`;
}

// Writes a text only when it is new, since the browser lays each written text out again.
export function write(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

export function show(element, shown) {
  if (element.hidden === shown) element.hidden = !shown;
}

// Sets data-..., for style.css and tests.
export function setData(element, data) {
  for (const [name, value] of Object.entries(data)) {
    if (element.dataset[name] !== String(value)) element.dataset[name] = value;
  }
}

export function describe(element, name, words) {
  if (element.getAttribute(name) !== words) element.setAttribute(name, words);
}

// Adds a new last child.
export function child(parent, name, kind) {
  const element = document.createElement(name);
  if (kind) element.className = kind;
  parent.append(element);
  return element;
}
