// A recording of packets in the origin's private file system, in the form of protocol/recording.md.

import { ownName } from "./own.js";

const FOLDER = ownName("walks");
const MAX_WAITING = 20_000_000; // bytes that wait in memory while nothing can be written
const RETRY_INTERVAL = 2000; // ms from a write that failed to the next
const LINE_FEED = 10;

export async function walksFolder() {
  const root = await navigator.storage.getDirectory();
  return root.getDirectoryHandle(FOLDER, { create: true });
}

// Opens a new recording, or one that a killed tab left: a torn last line is removed.
export async function openRecording(name, header) {
  const folder = await walksFolder();
  const file = await folder.getFileHandle(name, { create: true });
  return new Recording(await file.createSyncAccessHandle(), header);
}

// Words for an error of the storage.
export function storageWords(error, what) {
  const why =
    {
      QuotaExceededError: "the storage of this device is full",
      NoModificationAllowedError: "another tab of this page records",
      SecurityError: "this browser lets the page store nothing",
      NotAllowedError: "this browser lets the page store nothing",
    }[error?.name] ?? `the storage does not work (${error?.message ?? error})`;
  return `${what}: ${why}.`;
}

class Recording {
  count = 0; // parts that were added
  size = 0; // bytes of whole lines in the file
  #retryAt = 0;
  #dropped = false; // lines were left out
  #handle;
  #header;
  #waiting = [];
  #waitingSize = 0;
  #broken = false;
  #encoder = new TextEncoder();

  constructor(handle, header) {
    this.#handle = handle;
    this.#header = this.#line({ format: "solepath-packets", version: 1, ...header });
    this.size = this.#wholeLines();
    if (this.size === 0) this.#wait(this.#header);
    else this.count = 1;
    handle.truncate(this.size);
  }

  // Size of the file once everything that waits is in it.
  get wholeSize() {
    return this.size + this.#waitingSize;
  }

  // lines: bytes of whole lines; returns words when they begin to be left out, and "" else.
  add(lines) {
    this.count += 1;
    if (this.#wait(lines)) return "";
    const words = this.#dropped ? "" : "The storage is full for so long that the recording now has a gap.";
    this.#dropped = true;
    return words;
  }

  // Writes what waits; returns words when that begins to fail, and "" else.
  flush() {
    if (this.#broken && performance.now() < this.#retryAt) return "";
    while (this.#waiting.length > 0) {
      const part = this.#waiting.length === 1 ? this.#waiting[0] : joined(this.#waiting);
      try {
        if (this.#handle.write(part, { at: this.size }) !== part.length) throw new DOMException("", "QuotaExceededError");
      } catch (error) {
        quietly(() => this.#handle.truncate(this.size)); // the file ends with a whole line
        this.#retryAt = performance.now() + RETRY_INTERVAL;
        const words = this.#broken ? "" : storageWords(error, "The recording stops here, and is tried again");
        this.#broken = true;
        return words;
      }
      this.size += part.length;
      this.#waiting = [];
      this.#waitingSize = 0;
    }
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
    const lines = new Uint8Array(Math.max(0, this.size - start));
    this.#handle.read(lines, { at: start });
    return joined([this.#header, lines]);
  }

  // Returns words when something could not be written, and "" else.
  close() {
    this.#retryAt = 0;
    this.flush();
    this.sync();
    quietly(() => this.#handle.close());
    return this.#waitingSize > 0 ? "The end of the recording could not be stored." : "";
  }

  #line(fields) {
    return this.#encoder.encode(`${JSON.stringify(fields)}\n`);
  }

  #wait(line) {
    if (this.#waitingSize + line.length > MAX_WAITING) return false;
    this.#waiting.push(line);
    this.#waitingSize += line.length;
    return true;
  }

  // bytes up to the last line feed
  #wholeLines() {
    const size = this.#handle.getSize();
    const end = new Uint8Array(Math.min(size, 65_536));
    this.#handle.read(end, { at: size - end.length });
    return size - end.length + end.lastIndexOf(LINE_FEED) + 1;
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
