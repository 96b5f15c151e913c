// Names of what this copy of the site stores: another copy, at another path of the same origin, has others.

const PATH = new URL("./", import.meta.url).pathname;

export const ownName = (name) => (PATH === "/" ? name : `${name} ${encodeURIComponent(PATH)}`);
