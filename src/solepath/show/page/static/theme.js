// Dark or light, and the colours of style.css for what is drawn on canvases.

const STORAGE_KEY = "solepath-theme";
const COLOUR_NAMES = [
  "ground",
  "card",
  "inset",
  "ink",
  "muted",
  "line",
  "strong-line",
  "grid",
  "left",
  "right",
  "left-soft",
  "right-soft",
  "both",
  "wearer",
  "candidate",
  "sole",
  "sole-line",
  "wall",
  "inner-wall",
  "tread",
  "room",
  "here",
  "outside",
  "bad",
];

// Low to high: viridis (matplotlib, CC0). On a dark page it rises to bright yellow, on a light one it falls to dark
// violet, so that load stands out against the sole, and lightness alone shows the order. The low end departs from the sole
// at once: the load of standing is a quarter of the scale.
const VIRIDIS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
const DARK = [[28, 38, 48], [66, 72, 150], [58, 108, 170], [46, 138, 162], [38, 158, 146], [48, 182, 128], ...VIRIDIS.slice(6)];
const LIGHT = [[237, 241, 244], [176, 222, 182], [104, 200, 134], ...VIRIDIS.slice(0, 6).reverse()];

export const theme = { version: 0, dark: false, colours: {}, pressure: new Uint8Array(0), stops: [] };

const system = matchMedia("(prefers-color-scheme: dark)");

// changed() is called whenever the colours change.
export function startTheme(button, changed) {
  const read = () => {
    const chosen = recall();
    if (chosen) document.documentElement.dataset.theme = chosen;
    theme.dark = chosen ? chosen === "dark" : system.matches;
    document.documentElement.dataset.shown = theme.dark ? "dark" : "light";
    button.setAttribute("aria-label", theme.dark ? "Switch to light colours" : "Switch to dark colours");
    for (const name of COLOUR_NAMES) theme.colours[name] = resolved(name);
    theme.stops = theme.dark ? DARK : LIGHT;
    theme.pressure = ramp(theme.stops);
    theme.version += 1;
    changed();
  };
  system.addEventListener("change", read);
  matchMedia("(prefers-contrast: more)").addEventListener("change", read);
  button.addEventListener("click", () => {
    remember(theme.dark ? "light" : "dark");
    read();
  });
  read();
}

let chosenHere = null; // where storage is forbidden

function recall() {
  try {
    const kept = localStorage.getItem(STORAGE_KEY);
    return kept === "dark" || kept === "light" ? kept : chosenHere;
  } catch {
    return chosenHere;
  }
}

function remember(which) {
  chosenHere = which;
  try {
    localStorage.setItem(STORAGE_KEY, which);
  } catch {
    // the choice lasts until the page is left
  }
}

// light-dark() is resolved in a computed colour only.
function resolved(name) {
  const probe = document.createElement("i");
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

function ramp(stops) {
  const table = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * (stops.length - 1);
    const k = Math.min(Math.floor(at), stops.length - 2);
    for (let c = 0; c < 3; c++) table[3 * i + c] = stops[k][c] + (at - k) * (stops[k + 1][c] - stops[k][c]);
  }
  return table;
}
