// Run by node: `node energy.mjs FOLDER RUNS`. Prints the processor times, s, of the runs of FOLDER/walk.jsonl in Pyodide.

import { pathToFileURL } from "node:url";

const [folder, runs] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${folder}/pyodide/pyodide.mjs`));
const python = await loadPyodide({
  stdLibURL: `${folder}/pyodide/python_stdlib.zip`,
  env: { HOME: "/home/pyodide", PYTHONHASHSEED: "0" },
});
python.FS.mkdirTree("/build");
python.FS.mount(python.FS.filesystems.NODEFS, { root: folder }, "/build");
python.runPython("import sys; sys.path.insert(0, '/build/source'); import feeding; walk = feeding.Walk('/build/walk.jsonl')");
const times = [];
for (let run = 0; run < Number(runs); run += 1) {
  const before = process.cpuUsage();
  python.runPython("walk.feed()");
  const used = process.cpuUsage(before);
  times.push((used.user + used.system) / 1e6);
}
console.log(JSON.stringify(times));
process.exit(0);
