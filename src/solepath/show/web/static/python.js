// Python in the worker: Pyodide with solepath, and its calls that may take long.

import { loadPyodide } from "./pyodide.mjs";

const SLICE = 0.05; // s for which Python computes before the worker may do something else
const METHODS = ["message", "heartbeat", "receive", "command", "play", "start", "step", "save", "choices", "take_lines"];
const here = (name) => new URL(name, import.meta.url).href;

// The bytes of a blob, unpacked if gzip packed them: some servers and browsers have unpacked such a file already.
export async function unpacked(blob) {
  const start = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  const packed = start[0] === 0x1f && start[1] === 0x8b;
  const source = packed ? new Response(blob.stream().pipeThrough(new DecompressionStream("gzip"))) : blob;
  return new Uint8Array(await source.arrayBuffer());
}

// A fault that a person can understand.
export class Problem extends Error {}

export class Python {
  static async load() {
    const site = fetch(here("site.json")).then((answer) => answer.json());
    const library = await unpacked(await (await fetch(here("python.zip.gz"))).blob());
    const stdLibURL = URL.createObjectURL(new Blob([library], { type: "application/zip" }));
    const runtime = await loadPyodide({ indexURL: here("./"), stdLibURL });
    URL.revokeObjectURL(stdLibURL);
    runtime.FS.mkdirTree("/files");
    runtime.FS.chdir("/files");
    const worker = runtime.pyimport("solepath.show.web.worker").Worker((await site).solepath);
    const gc = runtime.pyimport("gc");
    gc.collect();
    gc.freeze();
    return new Python(runtime, worker);
  }

  // worker: the one of worker.py; each look at a method of it would make another object
  constructor(runtime, worker) {
    this.runtime = runtime;
    for (const name of METHODS) this[name] = worker[name];
  }

  // Returns the lines of the recording since the last call, as bytes.
  takeLines() {
    const lines = this.take_lines();
    const bytes = lines.toJs();
    lines.destroy();
    return bytes;
  }

  // Runs a method of worker.py; progress(share) is called meanwhile. Throws Problem.
  async run(name, values, progress = () => {}) {
    this.start(name, this.runtime.toPy(values));
    for (;;) {
      const answer = JSON.parse(this.step(SLICE));
      if ("problem" in answer) throw new Problem(answer.problem);
      if ("value" in answer) return answer.value;
      progress(answer.share);
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
  }

  write(name, bytes) {
    this.runtime.FS.writeFile(`/files/${name}`, bytes);
  }

  remove(name) {
    this.runtime.FS.unlink(`/files/${name}`);
  }
}
