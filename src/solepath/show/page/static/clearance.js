// Keeps the focused control visible: the browser scrolls it away from bars at the edges of the window.

const MARGIN = 12; // px, for the mark of the focus

export function keepClear() {
  const top = document.querySelector(".top");
  const playback = document.getElementById("playback");
  const measure = () => {
    const root = document.documentElement.style;
    root.scrollPaddingTop = `${Math.round(top.offsetHeight + MARGIN)}px`;
    root.scrollPaddingBottom = `${Math.round(playback.offsetHeight + MARGIN)}px`;
  };
  const observer = new ResizeObserver(measure);
  for (const one of [top, playback]) observer.observe(one);
}
