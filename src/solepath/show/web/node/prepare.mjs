// Run by node: `node prepare.mjs FOLDER`. Pyodide uses once what the site can do, with the packages in FOLDER/source,
// and compiles the modules that this loaded, its own standard library's too, into FOLDER/compiled.

import { pathToFileURL } from "node:url";

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
const { rehearse } = python.pyimport("solepath.show.web.rehearsal");
const list = python.toPy([1, [2.5, "left_foot"]]); // as the worker passes packets
const files = rehearse("/build/demo.jsonl", list);
python.pyimport("solepath.show.web.compiling").compile_files(files, "/build/source", "/build/compiled");
process.exit(0);
