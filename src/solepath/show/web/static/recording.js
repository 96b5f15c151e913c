// A recording of packets in the origin's private file system, in the form of protocol/recording.md.

import { ownName } from "./store.js";

const MAX_WAITING = 20_000_000; // bytes that wait in memory while nothing can be written
const RETRY_INTERVAL = 2000; // ms from a write that failed to the next
export const MAX_LINE = 65_536; // bytes
const LINE_FEED = 10;
const WHY = {
  QuotaExceededError: "the storage of this device is full",
  NoModificationAllowedError: "another tab of this page records",
  SecurityError: "this browser lets the page store nothing",
  NotAllowedError: "this browser lets the page store nothing",
};

export async function walksFolder() {
  const root = await navigator.storage.getDirectory();
  return root.getDirectoryHandle(ownName("walks"), { create: true });
}

// Opens a new recording, or one that a killed tab left: a torn last line is removed.
export async function openRecording(name, header) {
  const folder = await walksFolder();
  const file = await folder.getFileHandle(name, { create: true });
  return new Recording(await file.createSyncAccessHandle(), header);
}

// Words for an error of the storage.
export const storageWords = (error, what) => `${what}: ${WHY[error.name] ?? `the storage does not work (${error.message})`}.`;

class Recording {
  count = 0; // parts that were added
  #size; // bytes of whole lines in the file
  #handle;
  #header;
  #waiting = []; // whole lines
  #waitingSize = 0; // bytes
  #retryAt = -Infinity; // ms; later than now while nothing can be written
  #broken = false;
  #dropped = false; // lines were left out

  constructor(handle, header) {
    this.#handle = handle;
    this.#header = new TextEncoder().encode(`${JSON.stringify({ format: "solepath-packets", version: 1, ...header })}\n`);
    const size = handle.getSize();
    const end = new Uint8Array(Math.min(size, MAX_LINE));
    handle.read(end, { at: size - end.length });
    this.#size = size - end.length + end.lastIndexOf(LINE_FEED) + 1;
    if (this.#size === 0) this.#wait(this.#header);
    else this.count = 1;
    handle.truncate(this.#size);
  }

  // Size of the file once everything that waits is in it.
  get wholeSize() {
    return this.#size + this.#waitingSize;
  }

  // lines: bytes of whole lines; returns words when they begin to be left out, and "" else.
  add(lines) {
    this.count += 1;
    const fits = this.#waitingSize + lines.length <= MAX_WAITING;
    if (fits) this.#wait(lines);
    const words = fits || this.#dropped ? "" : "The storage is full for so long that the recording now has a gap.";
    this.#dropped ||= !fits;
    return words;
  }

  // Writes what waits; returns words when that begins to fail, and "" else.
  flush() {
    if (performance.now() < this.#retryAt) return "";
    try {
      const lines = joined(this.#waiting);
      if (this.#handle.write(lines, { at: this.#size }) !== lines.length) throw new DOMException("", "QuotaExceededError");
    } catch (error) {
      quietly(() => this.#handle.truncate(this.#size)); // the file ends with a whole line
      this.#retryAt = performance.now() + RETRY_INTERVAL;
      const words = this.#broken ? "" : storageWords(error, "The recording stops here, and is tried again");
      this.#broken = true;
      return words;
    }
    this.#size = this.wholeSize;
    this.#waiting = [];
    this.#waitingSize = 0;
    this.#broken = this.#dropped = false;
    return "";
  }

  // Lets the system write to its disk what a power failure would take; a full disk is reported by flush().
  sync() {
    quietly(() => this.#handle.flush());
  }

  // Returns the header and all lines from this place in the file on.
  from(place) {
    const start = Math.max(place, this.#header.length);
    const lines = new Uint8Array(Math.max(0, this.#size - start));
    this.#handle.read(lines, { at: start });
    return joined([this.#header, lines]);
  }

  #wait(lines) {
    this.#waiting.push(lines);
    this.#waitingSize += lines.length;
  }

  // Returns words when something could not be written, and "" else.
  close() {
    this.#retryAt = -Infinity;
    this.flush();
    this.sync();
    quietly(() => this.#handle.close());
    return this.#waitingSize > 0 ? "The end of the recording could not be stored." : "";
  }
}

function quietly(act) {
  try {
    act();
  } catch (error) {
    console.warn(error);
  }
}

function joined(parts) {
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
