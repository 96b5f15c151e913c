// The worker that computes: it is started, called, watched, and started again when somebody asks for it.

const SILENCE_LIMIT = 4; // s without a sign of life of a worker that is ready, while the page is visible
const COVERED_LIMIT = 10; // s of the same under the cover, where a worker gives a sign every three seconds
const BUSY_LIMIT = 120; // s of the same while it does what a person asked for: a large floor plan takes its time
const SOURCE = `import ${JSON.stringify(new URL("worker.js", import.meta.url).href)};`;

class Computer {
  state = "none"; // "loading" | "ready" | "dead"
  choices = null; // {recipes, profiles: their names, recipe: the name of the one in use}
  #worker = null;
  #listeners = [];
  #calls = new Map();
  #next = 0;
  #silence = 0;
  #covered = false;

  constructor() {
    document.addEventListener("visibilitychange", () => this.#tellSeen());
    setInterval(() => this.#watch(), 1000);
  }

  // kinds: "text" of a message for the page, "state", "walk", "walks", "words", "progress", "recipe", "orders", "sensors",
  // and "happened": {what: a row of the table of situation.js, and members of the state's `program`}
  on(kind, listener) {
    this.#listeners.push({ kind, listener });
  }

  emit(kind, value) {
    for (const one of this.#listeners) if (one.kind === kind) one.listener(value);
  }

  start() {
    this.#worker?.terminate();
    // a worker from a blob has the Content-Security-Policy of this page, also where the server sends no header
    const source = URL.createObjectURL(new Blob([SOURCE], { type: "text/javascript" }));
    const worker = new Worker(source, { type: "module", name: "solepath" });
    this.#worker = worker;
    this.#set("loading");
    worker.onmessage = ({ data }) => worker === this.#worker && this.#take(data);
    worker.onerror = (event) => worker === this.#worker && this.#die(event.message);
    this.#tellSeen();
  }

  post(message) {
    if (this.state !== "dead") this.#worker?.postMessage(message);
  }

  // Whether a person waits for an answer.
  get isAsked() {
    return this.#calls.size > 0;
  }

  // Returns what a function of worker.js returns, once it is ready; an error has words for a person.
  call(name, ...values) {
    if (this.state === "dead") return Promise.reject(new Error("the part of this page that computes has stopped"));
    return new Promise((resolve, reject) => {
      this.#calls.set(++this.#next, { resolve, reject });
      this.emit("asked");
      this.#worker.postMessage({ call: name, values, id: this.#next });
    });
  }

  #take(data) {
    this.#silence = 0;
    const [kind, value] = Object.entries(data)[0];
    if (kind === "answer") {
      const { resolve, reject } = this.#calls.get(value.id);
      this.#calls.delete(value.id);
      if ("problem" in value) reject(new Error(value.problem));
      else resolve(value.result);
    } else if (kind === "ready") {
      Object.assign(this, value);
      this.#set("ready");
    } else if (kind === "failed") this.#die(value);
    else this.emit(kind, value);
  }

  #die(reason) {
    console.error(reason);
    this.kill();
    this.#set("dead");
    for (const { reject } of this.#calls.values()) reject(new Error("it was not finished"));
    this.#calls.clear();
  }

  #set(state) {
    this.state = state;
    this.#silence = 0;
    this.emit("state", state);
  }

  // Whether anybody sees what is drawn.
  get seen() {
    return !document.hidden && !this.#covered;
  }

  setCovered(covered) {
    this.#covered = covered;
    this.#tellSeen();
  }

  #tellSeen() {
    this.#silence = 0;
    this.post({ seen: this.seen, covered: this.#covered && !document.hidden });
  }

  #watch() {
    if (this.state !== "ready" || document.hidden) return;
    this.#silence += 1;
    const limit = this.#calls.size > 0 ? BUSY_LIMIT : this.#covered ? COVERED_LIMIT : SILENCE_LIMIT;
    if (this.#silence > limit) this.#die("the worker does not answer");
  }

  // Ends the worker, as an operating system does that needs the memory.
  kill() {
    this.#worker.terminate();
  }
}

export const computer = new Computer();
