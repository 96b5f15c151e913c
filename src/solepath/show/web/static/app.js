// The site's own controls: demonstration, files, walks on this device, report; what the page cannot do, in words.

import { addSensor, bluetoothWords, wornWords } from "./bluetooth.js";
import { computer } from "./computer.js";
import { running } from "./live.js"; // loaded first: it hears of a walk that goes on before anybody connects a sensor
import "./pocket.js";
import { distance } from "./trust.js";
import { child, element, fixed, setData, show, span, write } from "./words.js";

const SITES = ["left_foot", "right_foot", "pelvis", "left_thigh", "right_thigh", "left_shank", "right_shank"];
const KEPT_TIME = 60_000; // ms for which a file waits to be downloaded
const say = (text) => write("site-words", text);
function sayToo(text) {
  const before = element("site-words").textContent;
  if (!before.includes(text)) say(`${before} ${text}`.trim());
}
let shown = { name: "", title: "" }; // what the report is of: title, and the name of its file, "" for what is played
let walks = []; // {name, began, seconds, metres} of the recordings on this device
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

for (const button of document.querySelectorAll("[data-do]")) {
  button.addEventListener("click", () => {
    element("sheet").hidePopover();
    act(ACTIONS[button.dataset.do]);
  });
}
const ACTIONS = {
  connect: () => addSensor(element("worn").value || null, element("choose-kind").value || null),
  demo: async () => {
    await computing("The demonstration", () => computer.call("demo", "A demonstration"));
    showReportOf("", "demonstration");
  },
  open: async () => element("file").click(),
  end: async () => {
    const { state } = window.solepath;
    const { title } = state;
    const name = await computer.call("end", state.strides > 0 ? distance(state) : null);
    showReportOf(name, title);
    computer.emit("happened", { kept: name !== "" });
  },
  report: () => report(shown.name, shown.title),
};
element("news-close").addEventListener("click", () => {
  say("");
  show("report-file", false);
});
on("choose-recipe", "change", async () => {
  const { value } = element("choose-recipe");
  await computer.call("choose", value);
  say(`The recipe ${value} is used ${since()}.`);
});
on("file", "change", async () => {
  const sentences = [];
  for (const file of element("file").files) {
    const { kind, notes } = await computing(file.name, () => computer.call("open", file));
    if (kind === "recording") showReportOf("", file.name);
    else if (kind === "bands") sentences.push(`${file.name}: reports have these bands from now on.`);
    else sentences.push(`${file.name}: this ${kind === "plan" ? "floor plan" : "calibration"} is used ${since()}.`);
    sentences.push(...notes);
  }
  element("file").value = "";
  say(sentences.join(" "));
});

// Lets the page say what is computed.
async function computing(task, what) {
  element("sheet").hidePopover();
  computer.emit("happened", { task, kept: false });
  return what().finally(() => computer.emit("happened", { task: "" }));
}

function showReportOf(name, title) {
  shown = { name, title };
  show("report-file", false);
}

async function report(name, title) {
  element("sheet").hidePopover();
  const options = [...element("report-options").querySelectorAll("[name]")].map((one) => [one.name, one.type === "checkbox" ? one.checked : one.value.trim()]);
  const text = await computer.call("report", name, title, Object.fromEntries(options));
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
  if (walk !== null) show("report-file", false);
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
  enable(state !== "dead");
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
  show("no-walks", others.length === 0);
  const compared = element("compare").value;
  element("compare").length = 1; // what is first is no walk
  for (const { name, began, seconds, metres } of others) {
    const date = began ? new Date(began).toLocaleString([], { dateStyle: "medium", timeStyle: "short" }) : name;
    const title = `Walk of ${date}`;
    element("compare").add(new Option(date, name, false, name === compared));
    const figures = [Number.isFinite(seconds) && span(seconds), Number.isFinite(metres) && `${fixed(metres)} m`];
    const get = () => computer.call("get", name);
    addRow("walks", name, [date, ...figures].filter(Boolean).join(" · "), {
      Play: async () => {
        await computing(title, async () => computer.call("open", await get()));
        showReportOf("", title);
      },
      Report: () => report(name, title),
      Share: async () => offer(await get()),
      Delete: async () => confirm(`Delete the ${title.toLowerCase()} from this device for ever?`) && computer.call("remove", name),
    });
  }
}

// Adds a line to a list, with a button for each action.
function addRow(list, name, text, actions) {
  const item = child(element(list), "li");
  setData(item, { name });
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
enable(true); // what needs Python waits for it
setData("site", { bluetooth: bluetoothWords() === "" });
for (const site of SITES) element("worn").add(new Option(wornWords(site), site));
if ("serviceWorker" in navigator) {
  navigator.serviceWorker.register("sw.js").catch((error) => say(`The page cannot be used offline: ${error.message}`));
}
