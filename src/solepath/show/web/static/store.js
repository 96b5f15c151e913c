// A few values by name in IndexedDB; a value is replaced whole or not at all.

const PATH = new URL("./", import.meta.url).pathname;

// Name of what this copy of the site stores: another copy, at another path of the same origin, has others.
export const ownName = (name) => (PATH === "/" ? name : `${name} ${encodeURIComponent(PATH)}`);

const opened = () =>
  new Promise((resolve, reject) => {
    const request = indexedDB.open(ownName("solepath"), 1);
    request.onupgradeneeded = () => request.result.createObjectStore("values");
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

let database = null;

async function done(mode, act) {
  database ??= opened();
  const transaction = (await database).transaction("values", mode, { durability: "strict" });
  const request = act(transaction.objectStore("values"));
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve(request.result);
    transaction.onerror = transaction.onabort = () => reject(transaction.error ?? request.error);
  });
}

export const store = {
  get: (name) => done("readonly", (values) => values.get(name)),
  put: (name, value) => done("readwrite", (values) => values.put(value, name)),
  remove: (name) => done("readwrite", (values) => values.delete(name)),
};
