// A few values by name in IndexedDB; a value is replaced whole or not at all.

import { ownName } from "./own.js";

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
