// Files in the worker: those that a person opens, and the recordings of walks on this device.

import { Problem, unpacked } from "./python.js";
import { MAX_LINE, walksFolder } from "./recording.js";
import { store } from "./store.js";

const DEMO = "demo.jsonl";
export const METRES = "metres"; // of the walks on this device, by name, as the page showed them at the end
const MAX_SIZE = 400_000_000; // bytes of a file that is opened; an hour of two insoles takes 240 MB

export class Files {
  used = { recipe: "default" }; // with what was opened: {recipe, plan: {name, bytes}, calibration: the same, bands: the same}

  // post(message) sends to the page
  constructor(python, post) {
    Object.assign(this, { python, post });
  }

  async demo(title) {
    const answer = await fetch(new URL(`${DEMO}.gz`, import.meta.url)).catch(() => null);
    if (!answer?.ok) throw new Problem("The demonstration is not on this device yet, and the site cannot be reached.");
    await this.#runWith({ [DEMO]: await unpacked(await answer.blob()) }, "open_demo", [DEMO, title]);
  }

  // Opens a file that a person chose: {kind, notes}.
  async open(file) {
    const name = nameOf(file.name);
    if (file.size > MAX_SIZE) throw new Problem(`${name}: is larger than ${MAX_SIZE / 1_000_000} MB`);
    const bytes = await orProblem(unpacked(file), `${name}: cannot be read`);
    const inner = name.replace(/\.gz$/, "");
    const result = await this.#runWith({ [inner]: bytes }, "open", [inner]);
    if (result.kind !== "recording") this.used = { ...this.used, [result.kind]: { name: inner, bytes } };
    return result;
  }

  // Uses this recipe from now on.
  async choose(recipe) {
    await this.#run("choose_recipe", [recipe]);
    this.used = { ...this.used, recipe };
    this.post({ recipe }); // that of a walk that goes on was chosen in another tab
  }

  // Uses recipe, floor plan and calibration of a saved walk again.
  async reopen({ recipe, ...files } = {}) {
    if (recipe) await this.choose(recipe);
    for (const { name, bytes } of Object.values(files)) await this.open(new File([bytes], name));
  }

  // Returns the report, as HTML, of a walk on this device, or of what is played.
  async report(name, title, options) {
    const files = {};
    for (const one of [name, options.compare].filter(Boolean)) files[one] = await unpacked(await this.get(one));
    return this.#runWith(files, "report", [name, title, options]);
  }

  get(name) {
    const file = walksFolder().then((folder) => folder.getFileHandle(name));
    return orProblem(file.then((handle) => handle.getFile()), `${name} is not on this device any more.`);
  }

  remove(name) {
    const removed = walksFolder().then((folder) => folder.removeEntry(name));
    return orProblem(removed, `${name} cannot be deleted now.`).finally(() => this.list());
  }

  // Tells the page which walks are on this device, the newest first.
  async list() {
    const walks = [];
    try {
      const metres = (await store.get(METRES)) ?? {};
      for await (const [name, handle] of (await walksFolder()).entries()) {
        walks.push({ name, metres: metres[name], ...(await timesOf(await handle.getFile())) });
      }
    } catch {
      // storage may be forbidden: there are none
    }
    this.post({ walks: walks.sort((one, other) => (one.name < other.name ? 1 : -1)) });
  }

  // Runs a call of Python that reads files; their bytes by name.
  async #runWith(files, call, values) {
    for (const [name, bytes] of Object.entries(files)) this.python.write(name, bytes);
    try {
      return await this.#run(call, values);
    } finally {
      for (const name of Object.keys(files)) this.python.remove(name);
    }
  }

  #run(call, values) {
    return this.python.run(call, values, (share) => this.post({ progress: share })).finally(() => this.post({ progress: 1 }));
  }
}

// When a recording began, and how long it is, s; nothing of a file that is none.
async function timesOf(file) {
  const lines = async (part) => (await part.text()).trim().split("\n");
  try {
    const [[header], end] = await Promise.all([file.slice(0, MAX_LINE), file.slice(-MAX_LINE)].map(lines));
    return { began: JSON.parse(header).began, seconds: JSON.parse(end.at(-1)).t };
  } catch {
    return {};
  }
}

// The same promise, which fails with words for a person.
const orProblem = (promise, words) =>
  promise.catch(() => {
    throw new Problem(words);
  });

// The last part of a path, without characters that a file name cannot have.
const nameOf = (path) => path.replace(/^.*[/\\]/, "").replace(/[\p{Cc}/\\]/gu, "_") || "file";
