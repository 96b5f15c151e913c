// The walk that is measured now: packets go to Python and to the recording, and all of it is saved again and again.

import { now } from "./clock.js";
import { METRES } from "./files.js";
import { Problem } from "./python.js";
import { openRecording, storageWords } from "./recording.js";
import { ownName, store } from "./store.js";

const SAVE_INTERVAL = 60; // s
const WRITE_INTERVAL = 100; // ms between two writes of the recording: each is a message to the browser that is waited for
const MAX_ATTEMPTS = 3; // to continue a walk
const MAX_PAUSE = 6 * 3600; // s without the page, after which a walk is over
const TICK = 1000; // ms between two looks at the clock
const LOCK = ownName("solepath walk");
const LOCK_WAIT = 2000; // ms; a tab that was just killed may hold the lock a moment longer
const ELSEWHERE = "another tab of this page is open: a walk goes on there";

export class Walk {
  #recording = null;
  #record = null; // what the store has of this walk
  #savedAt = 0;
  #writtenAt = 0;
  #alone = false; // no other tab measures

  // post(message) sends to the page
  constructor(python, files, post) {
    Object.assign(this, { python, files, post });
    setInterval(() => now() - this.#savedAt > SAVE_INTERVAL && this.save(), TICK);
  }

  get running() {
    return this.#record !== null;
  }

  // Starts a walk, or continues one that a closed tab left.
  async start(title) {
    if (this.running) await this.end();
    if (!(await this.#lock())) throw new Problem(ELSEWHERE);
    await this.resume();
    if (this.running) return;
    await this.python.run("start_walk", [title]);
    const began = now();
    const name = `walk-${localTime(new Date(1000 * began))}.jsonl`;
    this.#record = { name, title, began, size: 0, saved: undefined, savedT: began };
    await this.#openRecording();
    await store.put("files", this.files.used).catch(() => {});
    await this.#keep();
    this.#announce();
  }

  // Ends the walk of so many metres; its recording stays.
  async end(metres = null) {
    if (!this.running) return "";
    const { name } = this.#record;
    await this.python.run("finish_walk", []);
    this.#flush();
    const recorded = this.#recording?.count > 0;
    const known = await store.get(METRES).catch(() => {});
    await store.put(METRES, { ...known, [name]: metres }).catch(() => {});
    await this.#forget();
    await this.files.list();
    return recorded ? name : "";
  }

  // Takes messages of the page on sensors and returns the answers of Python (protocol/host.md).
  receive(messages) {
    if (!this.running) return [];
    const answers = JSON.parse(this.python.receive(JSON.stringify(messages), now() - this.#record.began));
    if (performance.now() - this.#writtenAt >= WRITE_INTERVAL) this.#flush();
    return answers;
  }

  // Continues the walk that a tab left when it was closed or killed. One that cannot go on is left alone after that, so
  // that the page can always be used; its recording stays.
  async resume() {
    const record = await store.get("walk").catch(() => undefined);
    if (record === undefined) return this.#announce();
    if (!(await this.#lock())) {
      this.#say("Another tab of this page measures a walk.");
      return this.#announce();
    }
    this.#record = { ...record, attempts: (record.attempts ?? 0) + 1 };
    await this.#keep(); // the tab may be killed meanwhile, perhaps by what it computes
    try {
      if (this.#record.attempts > MAX_ATTEMPTS) throw new Problem(`the page ended ${MAX_ATTEMPTS} times before it went on`);
      if (now() - record.savedT > MAX_PAUSE) throw new Problem("this page was closed for hours");
      await this.files.reopen(await store.get("files"));
      await this.#openRecording();
      const t = await this.#continueOrCompute();
      this.#record.attempts = 0;
      this.#announce(true, t);
    } catch (error) {
      console.warn(error);
      this.#say(`${record.title} does not go on: ${error.message.trim().split("\n").at(-1)}. Its recording is below.`);
      return this.#forget();
    }
    await this.save(); // what is computed next time starts behind the gap
  }

  async #continueOrCompute() {
    try {
      return await this.#continue(this.#record.saved, this.#record.size);
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      this.#say(`The saved state cannot be used (${error.message}); the recording is computed again.`);
      return this.#continue(undefined, 0);
    }
  }

  async #continue(saved, size) {
    const tail = this.#recording?.from(saved === undefined ? 0 : size);
    if (tail) this.python.write("tail.jsonl", tail);
    const elapsed = now() - this.#record.began;
    const t = await this.python.run("resume_walk", [this.#record.title, saved, tail ? "tail.jsonl" : "", elapsed]);
    if (t > elapsed) this.#record.began = now() - t; // the clock of this device was set back
    if (tail) this.python.remove("tail.jsonl");
    return t;
  }

  async #forget() {
    this.#say(this.#recording?.close());
    this.#recording = this.#record = null;
    await store.remove("walk").catch(() => {});
    this.#announce();
  }

  // Makes sure that two tabs do not write one walk; the lock lasts as long as this worker.
  async #lock() {
    if (this.#alone) return true;
    const signal = AbortSignal.timeout(LOCK_WAIT);
    await new Promise((resolve) => {
      const hold = () => {
        this.#alone = true;
        resolve();
        return new Promise(() => {});
      };
      navigator.locks.request(LOCK, { signal }, hold).catch(resolve);
    });
    return this.#alone;
  }

  // Saves session, scene and how much of the recording they have.
  async save() {
    if (!this.running) return;
    this.#savedAt = now();
    this.#flush();
    this.#recording?.sync();
    const saved = this.python.save();
    if (saved === undefined) return;
    // what waits for room in the storage is part of the saved state, and must not be computed again
    Object.assign(this.#record, { saved, size: this.#recording?.wholeSize ?? 0, savedT: now() });
    await this.#keep();
  }

  async #keep() {
    await store.put("walk", this.#record).catch((error) => this.#say(storageWords(error, "This walk cannot be saved for a restart")));
  }

  async #openRecording() {
    const { name, began } = this.#record;
    const header = { began: new Date(1000 * began).toISOString(), began_t: 0 };
    this.#recording = await openRecording(name, header).catch((error) => {
      this.#say(storageWords(error, "This walk is shown, but not recorded"));
      return null;
    });
  }

  #flush() {
    this.#writtenAt = performance.now();
    const lines = this.python.takeLines();
    if (lines.length > 0) this.#say(this.#recording?.add(lines));
    this.#say(this.#recording?.flush());
  }

  #say(words) {
    if (words) this.post({ words });
  }

  // t: time of the walk that goes on, s
  #announce(resumed = false, t = 0) {
    const { began, title, name } = this.#record ?? {};
    this.post({ walk: this.running ? { began, title, name, resumed, t } : null });
  }
}

// Date and time of day where the person is, as Swedes write them: in a form that sorts and that every file system has.
const localTime = (date) => date.toLocaleString("sv").replace(/[ :]/g, "-");
