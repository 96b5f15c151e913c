// Legend of the track: only what is drawn.

import { setData, show } from "./words.js";

export class Legend {
  constructor(section) {
    this.section = section;
    const items = [...section.querySelectorAll(".legend li")];
    const of = (name) => items.filter((item) => item.querySelector(`.${name}`));
    [this.areas, this.candidates] = [of("ellipse"), of("candidate")];
    this.line = section.querySelector(".legend .stroke-wearer");
  }

  // area: whether an ellipse or a circle is drawn; possible: whether the places at which the wearer could be are
  draw({ view, feetShown, area, possible, dashed }) {
    for (const item of this.areas) show(item, area);
    for (const item of this.candidates) show(item, possible);
    this.line.style.strokeDasharray = dashed ? "4 3" : "";
    setData(this.section, { view, feet: feetShown ? "shown" : "" });
  }
}
