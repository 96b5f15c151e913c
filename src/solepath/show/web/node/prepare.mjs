// Run by node: `node prepare.mjs FOLDER`. Pyodide loads what the site needs, with the packages in FOLDER/source, and
// compiles the modules that this loaded, its own standard library's too, into FOLDER/compiled.

import { pathToFileURL } from "node:url";

const MIN_NODE = 18; // oldest major version of node that this version of Pyodide runs in ("engines" of its package.json)
if (Number.parseInt(process.versions.node) < MIN_NODE) {
  console.error(`node is ${process.versions.node}; version ${MIN_NODE} or newer is needed`);
  process.exit(1);
}
const folder = process.argv[2];
const { loadPyodide } = await import(pathToFileURL(`${folder}/pyodide/pyodide.mjs`));
const python = await loadPyodide({
  stdLibURL: `${folder}/pyodide/python_stdlib.zip`,
  args: ["-X", "no_debug_ranges"], // a fifth of the size of a module; errors then name lines, not columns
  env: { HOME: "/home/pyodide", PYTHONHASHSEED: "0" },
});
python.FS.mkdirTree("/build");
python.FS.mount(python.FS.filesystems.NODEFS, { root: folder }, "/build");
python.runPython("import sys; sys.path.insert(0, '/build/source')");
const { load_all, compile_files } = python.pyimport("solepath.show.web.rehearsal");
python.toPy([1, [2.5, "left_foot"]]); // as the worker passes packets
compile_files(load_all(), "/build/source", "/build/compiled");
process.exit(0);
