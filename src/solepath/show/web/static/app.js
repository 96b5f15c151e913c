// The site's own controls: demonstration, files, walks on this device, report; what the page cannot do, in words.

import { bluetoothWords } from "./abilities.js";
import { addSensor, sensors } from "./bluetooth.js";
import { computer } from "./computer.js";
import { running } from "./live.js"; // loaded first: it hears of a walk that goes on before anybody connects a sensor
import { offer } from "./sharing.js";
import "./pocket.js";
import { keepAwake } from "./wake.js";
import { child, show, write } from "./words.js";

const element = (id) => document.getElementById(id);
const words = (text) => write(element("site-words"), text);
function addWords(text) {
  const before = element("site-words").textContent;
  if (!before.includes(text)) words(`${before} ${text}`.trim());
}
let shown = ""; // name of what is played
let walks = []; // {name, size} of the recordings on this device
let measured; // name of the one that is written now

const CONTROLS = "button, #choose-recipe";
async function act(what) {
  words("");
  for (const button of element("site").querySelectorAll(CONTROLS)) button.disabled = true;
  try {
    await what();
  } catch (error) {
    words(error.message);
  } finally {
    for (const button of element("site").querySelectorAll(CONTROLS)) button.disabled = false;
  }
}

const on = (id, what) => element(id).addEventListener("click", () => act(what));

on("connect", () => addSensor(element("worn").value || null, element("choose-kind").value || null));
on("demo", async () => {
  await computer.call("demo", "A demonstration: an emulated walk");
  played("demonstration");
});
element("open").addEventListener("click", () => element("file").click());
element("file").addEventListener("change", () =>
  act(async () => {
    const sentences = [];
    for (const file of element("file").files) {
      const { kind, notes } = await computer.call("open", file);
      if (kind === "recording") played(file.name);
      else {
        sentences.push(`${file.name}: this ${kind === "plan" ? "floor plan" : "calibration"} is used ${since()}.`);
      }
      sentences.push(...notes);
    }
    element("file").value = "";
    words(sentences.join(" "));
  }),
);
on("end", async () => {
  const name = await computer.call("end");
  words(name ? "The walk is on this device." : "");
});
on("report", () => report("", shown));
element("choose-recipe").addEventListener("change", () =>
  act(async () => {
    const { value } = element("choose-recipe");
    await computer.call("choose", value);
    words(`The recipe ${value} is used ${since()}.`);
  }),
);
computer.on("recipe", (name) => (element("choose-recipe").value = name));
const since = () => (running() ? "by the next walk" : "from now on");

// Fills the lists with what the worker knows.
function offerChoices({ recipes, profiles, recipe }) {
  for (const [id, names] of [["choose-recipe", recipes], ["choose-kind", profiles]]) {
    const known = new Set([...element(id).options].map((one) => one.value));
    for (const name of names) if (!known.has(name)) element(id).add(new Option(name));
  }
  element("choose-recipe").value = recipe;
}

function played(name) {
  shown = name;
  show(element("report"), true);
  show(element("report-file"), false);
}

async function report(name, title) {
  const text = await computer.call("report", name, title);
  const file = new File([text], `${title.replace(/\.jsonl(\.gz)?$/, "")}.html`, { type: "text/html" });
  const link = element("report-link");
  URL.revokeObjectURL(link.href);
  link.href = URL.createObjectURL(file);
  element("report-save").onclick = () => act(() => offer(file));
  show(element("report-file"), true);
}

computer.on("walk", (walk) => {
  measured = walk?.name;
  listWalks();
  for (const id of ["end", "demo"]) show(element(id), (walk === null) === (id === "demo"));
  if (walk?.resumed && sensors.size === 0) addWords("The walk goes on: connect the sensors again.");
  keepAwake("walk", walk !== null);
  if (walk !== null) show(element("report"), false);
});
computer.on("walks", (list) => {
  walks = list;
  listWalks();
});
computer.on("words", addWords);
computer.on("progress", (share) => {
  show(element("progress"), share < 1);
  element("progress").value = share;
});
computer.on("state", (state) => {
  if (state === "loading") words("");
  if (state === "ready") {
    offerChoices(computer.choices);
    element("site").dataset.ready = "true";
  }
  for (const button of element("site").querySelectorAll(CONTROLS)) button.disabled = state !== "ready";
});

computer.on("sensors", (sensors) => {
  element("sensors").replaceChildren();
  for (const sensor of sensors.values()) row("sensors", sensor.name, sensor.words, { Disconnect: () => sensor.end() });
});

function listWalks() {
  element("walks").replaceChildren();
  const others = walks.filter(({ name }) => name !== measured); // what is written now can be neither played nor deleted
  for (const { name, size } of others) walkRow(name, size);
  show(element("walks-part"), others.length > 0);
}

function walkRow(name, size) {
  row("walks", name, `${name.replace(/\.jsonl$/, "")}, ${(size / 1_000_000).toFixed(1)} MB`, {
    Play: async () => {
      await computer.call("open", await computer.call("get", name));
      played(name);
    },
    Report: () => report(name, name.replace(/\.jsonl$/, "")),
    Share: async () => offer(await computer.call("get", name)),
    Delete: async () => {
      if (confirm(`Delete ${name} from this device for ever?`)) await computer.call("remove", name);
    },
  });
}

// Adds a line to a list, with a button for each action.
function row(list, name, text, actions) {
  const item = child(element(list), "li");
  write(child(item, "span", "row-name"), text);
  for (const [label, what] of Object.entries(actions)) {
    const button = child(item, "button");
    button.type = "button";
    write(button, label);
    button.setAttribute("aria-label", `${label} ${name}`);
    button.addEventListener("click", () => act(what));
  }
}

show(element("connect-part"), bluetoothWords() === "");
write(element("bluetooth-words"), bluetoothWords());
show(element("bluetooth-words"), bluetoothWords() !== "");
if ("serviceWorker" in navigator) {
  navigator.serviceWorker.register("sw.js").catch((error) => words(`The page cannot be used offline: ${error.message}`));
}
