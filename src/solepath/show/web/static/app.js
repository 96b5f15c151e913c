// The site's own controls: demonstration, files, walks on this device, report; what the page cannot do, in words.

import { addSensor, bluetoothWords, sensors, wornWords } from "./bluetooth.js";
import { computer } from "./computer.js";
import { running } from "./live.js"; // loaded first: it hears of a walk that goes on before anybody connects a sensor
import "./pocket.js";
import { child, element, note, show, write } from "./words.js";

const SITES = ["left_foot", "right_foot", "pelvis", "left_thigh", "right_thigh", "left_shank", "right_shank"];
const KEPT_TIME = 60_000; // ms for which a file waits to be downloaded
const say = (text) => write("site-words", text);
function sayToo(text) {
  const before = element("site-words").textContent;
  if (!before.includes(text)) say(`${before} ${text}`.trim());
}
let shown = ""; // name of what is played
let walks = []; // {name, size} of the recordings on this device
let measured; // name of the one that is written now

function enable(enabled) {
  for (const control of element("site").querySelectorAll("button, #choose-recipe")) control.disabled = !enabled;
}

async function act(what) {
  say("");
  enable(false);
  await what().catch((error) => say(error.message));
  enable(true);
}

const on = (id, kind, what) => element(id).addEventListener(kind, () => act(what));
const since = () => (running() ? "by the next walk" : "from now on");

on("connect", "click", () => addSensor(element("worn").value || null, element("choose-kind").value || null));
on("demo", "click", async () => {
  await computer.call("demo", "A demonstration: an emulated walk");
  played("demonstration");
});
on("end", "click", async () => say((await computer.call("end")) ? "The walk is on this device." : ""));
on("report", "click", () => report("", shown));
on("choose-recipe", "change", async () => {
  const { value } = element("choose-recipe");
  await computer.call("choose", value);
  say(`The recipe ${value} is used ${since()}.`);
});
element("open").addEventListener("click", () => element("file").click());
on("file", "change", async () => {
  const sentences = [];
  for (const file of element("file").files) {
    const { kind, notes } = await computer.call("open", file);
    if (kind === "recording") played(file.name);
    else sentences.push(`${file.name}: this ${kind === "plan" ? "floor plan" : "calibration"} is used ${since()}.`);
    sentences.push(...notes);
  }
  element("file").value = "";
  say(sentences.join(" "));
});

function played(name) {
  shown = name;
  show("report", true);
  show("report-file", false);
}

async function report(name, title) {
  const text = await computer.call("report", name, title);
  const file = new File([text], `${title.replace(/\.jsonl(\.gz)?$/, "")}.html`, { type: "text/html" });
  const link = element("report-link");
  URL.revokeObjectURL(link.href);
  link.href = URL.createObjectURL(file);
  element("report-save").onclick = () => act(() => offer(file));
  show("report-file", true);
}

// Gives a file to another app or, where a browser does not share it, to its downloads.
async function offer(file) {
  // browsers share text, not every kind of file
  const shared = new File([file], file.name.replace(/\.jsonl$/, ".jsonl.txt"), { type: file.type || "text/plain" });
  if (navigator.canShare?.({ files: [shared] })) {
    try {
      return await navigator.share({ files: [shared], title: file.name });
    } catch (error) {
      if (error.name === "AbortError") return; // somebody closed the list of apps
    }
  }
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(file), download: file.name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), KEPT_TIME);
}

computer.on("recipe", (name) => (element("choose-recipe").value = name));
computer.on("walk", (walk) => {
  measured = walk?.name;
  listWalks();
  show("end", walk !== null);
  show("demo", walk === null);
  if (walk !== null) show("report", false);
  if (walk?.resumed && sensors.size === 0) sayToo("The walk goes on: connect the sensors again.");
  keepAwake();
});
computer.on("walks", (list) => {
  walks = list;
  listWalks();
});
computer.on("words", sayToo);
computer.on("progress", (share) => {
  show("progress", share < 1);
  element("progress").value = share;
});
computer.on("state", (state) => {
  if (state === "loading") say("");
  if (state === "ready") {
    const { recipes, profiles, recipe } = computer.choices;
    fill("choose-recipe", recipes);
    fill("choose-kind", profiles);
    element("choose-recipe").value = recipe;
    element("site").dataset.ready = "true";
  }
  enable(state === "ready");
});
computer.on("sensors", (sensors) => {
  element("sensors").replaceChildren();
  for (const sensor of sensors.values()) addRow("sensors", sensor.name, sensor.words, { Disconnect: () => sensor.end() });
});

// Adds what a list does not have yet.
function fill(id, names) {
  const known = [...element(id).options].map((one) => one.value);
  for (const name of names) if (!known.includes(name)) element(id).add(new Option(name));
}

function listWalks() {
  element("walks").replaceChildren();
  const others = walks.filter(({ name }) => name !== measured); // what is written now can be neither played nor deleted
  show("walks-part", others.length > 0);
  for (const { name, size } of others) {
    const title = name.replace(/\.jsonl$/, "");
    const get = () => computer.call("get", name);
    addRow("walks", name, `${title}, ${(size / 1_000_000).toFixed(1)} MB`, {
      Play: async () => {
        await computer.call("open", await get());
        played(name);
      },
      Report: () => report(name, title),
      Share: async () => offer(await get()),
      Delete: async () => confirm(`Delete ${name} from this device for ever?`) && computer.call("remove", name),
    });
  }
}

// Adds a line to a list, with a button for each action.
function addRow(list, name, text, actions) {
  const item = child(element(list), "li");
  child(item, "span", "row-name", text);
  for (const [label, what] of Object.entries(actions)) {
    const button = child(item, "button", "", label);
    button.type = "button";
    button.setAttribute("aria-label", `${label} ${name}`);
    button.addEventListener("click", () => act(what));
  }
}

// Keeps the screen on while a walk is measured; a browser forgets that whenever the page is hidden. One after the other,
// so that no lock is requested twice or forgotten.
let lock = null;
let updates = Promise.resolve();
function keepAwake() {
  updates = updates.then(updateLock).catch(() => {}); // refused, perhaps for a low battery
}

async function updateLock() {
  if (document.hidden || !navigator.wakeLock) return;
  if (!running()) {
    await lock?.release();
    lock = null;
  } else if (lock === null || lock.released) lock = await navigator.wakeLock.request("screen");
}

document.addEventListener("visibilitychange", keepAwake);
for (const site of SITES) element("worn").add(new Option(wornWords(site), site));
show("connect-part", bluetoothWords() === "");
note("bluetooth-words", bluetoothWords());
if ("serviceWorker" in navigator) {
  navigator.serviceWorker.register("sw.js").catch((error) => say(`The page cannot be used offline: ${error.message}`));
}
