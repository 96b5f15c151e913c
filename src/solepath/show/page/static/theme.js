// Dark or light, and the colours of style.css for what is drawn on canvases.

const STORAGE_KEY = "solepath-theme";

// Low to high: viridis (matplotlib, CC0). On a dark page it rises to bright yellow, on a light one it falls to dark
// violet, so that load stands out against the sole, and lightness alone shows the order. The low end departs from the sole
// at once: the load of standing is a quarter of the scale.
const VIRIDIS = ["#440154", "#472c7a", "#3b518b", "#2c718e", "#21908d", "#27ad81", "#5cc863", "#aadc32", "#fde725"];
const DARK = ["#1c2630", "#424896", "#3a6caa", "#2e8aa2", "#269e92", "#30b680", ...VIRIDIS.slice(6)];
const LIGHT = ["#edf1f4", "#b0deb6", "#68c886", ...VIRIDIS.slice(0, 6).reverse()];

// pressure: 256 colours of red, green, blue, opacity each; stops: those between which they lie
export const theme = { version: 0, dark: false, pressure: new Uint8ClampedArray(0), stops: [] };

const system = matchMedia("(prefers-color-scheme: dark)");
const colours = new Map(); // as they are now, by name
let chosen = null; // by a person: "dark" or "light"

// changed() is called whenever the colours change.
export function startTheme(button, changed) {
  const root = document.documentElement;
  const update = () => {
    theme.dark = chosen === null ? system.matches : chosen === "dark";
    if (chosen !== null) root.dataset.theme = chosen;
    root.dataset.shown = theme.dark ? "dark" : "light";
    button.setAttribute("aria-label", theme.dark ? "Switch to light colours" : "Switch to dark colours");
    theme.stops = theme.dark ? DARK : LIGHT;
    theme.pressure = ramp(theme.stops);
    theme.version += 1;
    colours.clear();
    changed();
  };
  for (const media of [system, matchMedia("(prefers-contrast: more)")]) media.addEventListener("change", update);
  button.addEventListener("click", () => {
    chosen = theme.dark ? "light" : "dark";
    storing(() => localStorage.setItem(STORAGE_KEY, chosen));
    update();
  });
  storing(() => (chosen = localStorage.getItem(STORAGE_KEY)));
  update();
}

function storing(act) {
  try {
    act();
  } catch {
    // storage may be forbidden: the choice lasts until the page is left
  }
}

// A colour of style.css by its name; any other colour is returned as it is. Only a computed colour resolves light-dark().
export function colour(name) {
  if (!/^[a-z-]+$/.test(name)) return name;
  if (!colours.has(name)) {
    const probe = document.createElement("i");
    probe.style.color = `var(--${name})`;
    document.body.append(probe);
    colours.set(name, getComputedStyle(probe).color);
    probe.remove();
  }
  return colours.get(name);
}

function ramp(stops) {
  const canvas = Object.assign(document.createElement("canvas"), { width: 256, height: 1 });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  const gradient = context.createLinearGradient(0.5, 0, 255.5, 0);
  stops.forEach((stop, i) => gradient.addColorStop(i / (stops.length - 1), stop));
  context.fillStyle = gradient;
  context.fillRect(0, 0, 256, 1);
  return context.getImageData(0, 0, 256, 1).data;
}
