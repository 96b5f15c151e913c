// Puts values into words, and words into the elements of the page.

export const FEET = ["left", "right"];
export const PHASES = { LOADING: "loading", STATIONARY: "flat", PUSH_OFF: "push-off", SWING: "swing" };
export const SUPPORTS = { DOUBLE: "both feet", LEFT: "left foot", RIGHT: "right foot", FLIGHT: "in the air" };
export const LINKS = { ok: "connected", silent: "silent", lost: "lost", waiting: "waiting" };

const ACTIVITIES = { ELEVATOR_UP: "lift up", ELEVATOR_DOWN: "lift down", UNKNOWN: "not clear" };

// What has no word of its own here is shown as it comes.
export const wordOf = (words, key) => words[key] ?? String(key ?? "").toLowerCase().replaceAll("_", " ");
// Activity of the wearer in words; it is not known while no foot sends.
export const activityText = ({ now, last }) =>
  last === null ? capital(wordOf(ACTIVITIES, now)) : `Not known, last: ${wordOf(ACTIVITIES, last)}`;
// A sentence, with one full stop, of words that may end with one.
export const sentence = (words) => `${capital(words.replace(/[.\s]+$/, ""))}.`;
export const capital = (words) => words.charAt(0).toUpperCase() + words.slice(1);

export const fixed = (value, digits = 0) => {
  if (!Number.isFinite(value)) return "–";
  const shown = value.toFixed(digits);
  return Number(shown) === 0 ? shown.replace("-", "") : shown.replace("-", "−");
};
export const percent = (share, digits = 0) => (Number.isFinite(share) ? `${fixed(100 * share, digits)} %` : "–");
export const signed = (value, digits) => (Number(value.toFixed(digits)) > 0 ? "+" : "") + fixed(value, digits);
export const angle = (radians, digits = 0) => `${fixed(Number.isFinite(radians) ? (radians * 180) / Math.PI : NaN, digits)}°`;

// Shows 83.2 s as 1:23.
export function clock(seconds) {
  const whole = Math.max(0, Math.floor(seconds));
  const two = (value) => String(value).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return (hours ? `${hours}:${two(minutes)}` : String(minutes)) + `:${two(whole % 60)}`;
}

export const span = (seconds) => (seconds < 60 ? `${Math.max(0, Math.floor(seconds))} s` : `${clock(seconds)} min`);

export const element = (id) => document.getElementById(id);
// An element, or that with this id.
const of = (target) => (typeof target === "string" ? element(target) : target);

// Writes a text only when it is new, since the browser lays each written text out again.
export function write(target, words) {
  if (of(target).textContent !== words) of(target).textContent = words;
}

export function show(target, shown) {
  if (of(target).hidden === shown) of(target).hidden = !shown;
}

// Writes a text, and hides its element while there is none.
export function note(target, words) {
  write(target, words);
  show(target, words !== "");
}

// Sets data-..., for style.css and tests.
export function setData(target, data) {
  for (const [name, value] of Object.entries(data)) describe(target, `data-${name}`, value);
}

// Sets an attribute.
export function describe(target, name, value) {
  if (of(target).getAttribute(name) !== String(value)) of(target).setAttribute(name, value);
}

export const press = (target, pressed) => describe(target, "aria-pressed", pressed);

// Adds a new last child, of this class and with these words.
export function child(parent, name, kind = "", words = "") {
  const element = document.createElement(name);
  if (kind) element.className = kind;
  element.textContent = words;
  parent.append(element);
  return element;
}
