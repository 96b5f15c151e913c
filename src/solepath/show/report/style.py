"""Holds the style sheet of the report: light or dark as the system, light on paper, one column on a phone."""

from __future__ import annotations

STYLE = """
:root { --paper: #fff; --ink: #1b2430; --soft: #566372; --rule: #d9dfe6; --panel: #f5f7f9;
  --left: #0067a8; --right: #c04a00; --accent: #1d6f5c; --warn: #8a5a00; --grid: #e4e8ed; --double: #d5dbe2;
  --onbar: #fff; color-scheme: light dark; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #12171d; --ink: #e6ebf1; --soft: #a3afbc; --rule: #333e4a; --panel: #1a2129;
    --left: #5ab4f0; --right: #ff9d57; --accent: #5fd0b3; --warn: #e8b558; --grid: #29323c; --double: #3a4653;
    --onbar: #0d1116; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 1.2rem 1rem 3rem; max-width: 66rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .4rem; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; padding-bottom: .25rem; border-bottom: 1px solid var(--rule); }
p, ul { margin: .5rem 0; max-width: 46rem; }
ul { padding-left: 1.2rem; }
.note, .caution { color: var(--soft); font-size: .875rem; }
dl.facts { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1rem; margin: .6rem 0; }
dl.facts dt { color: var(--soft); }
dd { margin: 0; }
details { margin: .8rem 0; font-size: .875rem; color: var(--soft); }
summary { cursor: pointer; font-weight: 600; }
details dl { columns: 2; column-gap: 2rem; margin: .5rem 0; }
details dt { font-weight: 600; break-after: avoid; }
details dd { margin-bottom: .35rem; break-before: avoid; }
table { border-collapse: collapse; margin: 1rem 0; width: 100%; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .35rem; }
th, td { padding: .28rem .5rem; text-align: right; border-bottom: 1px solid var(--rule); vertical-align: baseline; }
thead th { color: var(--soft); font-size: .8125rem; font-weight: 600; }
tbody th { font-weight: 400; }
th:first-child { text-align: left; padding-left: 0; }
td span { white-space: nowrap; } td span + span { color: var(--soft); margin-left: .35em; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 26rem), 1fr)); gap: 1.2rem;
  align-items: start; }
.figures > p { grid-column: 1 / -1; margin: 0; } .figures > table { margin: .7rem 0; }
figure { margin: 0; padding: .7rem; background: var(--panel); border-radius: .5rem; min-width: 0; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { margin-top: .4rem; font-size: .875rem; }
figcaption strong, figcaption .note { display: block; }
figcaption .note { font-size: .8125rem; }
svg:where(:not(.plan)) text { fill: var(--ink); font-size: 11px; }
svg .tick { fill: var(--soft); font-size: 10.5px; } svg .label { fill: var(--soft); font-size: 11px; }
svg .strong { font-weight: 600; } svg .halo { paint-order: stroke; stroke: var(--panel); stroke-width: 3px; }
svg .onbar { fill: var(--onbar); font-weight: 600; }
svg:where(:not(.plan)) path { fill: none; }
.grid { stroke: var(--grid); stroke-width: 1; } .axis { stroke: var(--soft); stroke-width: 1; }
.way { stroke: var(--accent); stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
.start { fill: var(--panel); stroke: var(--accent); stroke-width: 2.5; } .end { fill: var(--accent); }
.time { fill: var(--ink); }
.line { stroke-width: 1.8; stroke-linejoin: round; } .line.left { stroke: var(--left); }
.line.right { stroke: var(--right); stroke-dasharray: 5 3; }
.mark.left { stroke: var(--left); stroke-width: 5; stroke-linecap: round; }
.mark.right { stroke: var(--right); stroke-width: 1.5; } .mark.faint { opacity: .45; }
.missing { stroke: var(--warn); stroke-width: 1.2; } .turn { stroke: var(--ink); stroke-width: 1.5; }
.dense .mark { opacity: .3; stroke-width: 1; } .dense .mark.left { stroke-width: 2.4; }
.dense .turn, .dense .missing { opacity: .35; stroke-width: .6; } .dense .line { stroke-width: 2.4; }
.double { fill: var(--double); } .flight { fill: none; stroke: var(--soft); stroke-dasharray: 3 3; }
.swing { fill: var(--paper); stroke: var(--rule); fill-opacity: .55; }
.stance.left { fill: var(--left); } .stance.right { fill: var(--right); }
svg path.bar { fill: var(--accent); }
.cells { stroke: var(--soft); stroke-width: .5; }
.centre { stroke: #10202e; stroke-width: 2.2; stroke-linecap: round; stroke-linejoin: round; }
.under { stroke: #fff; stroke-width: 4.6; stroke-linecap: round; stroke-linejoin: round; }
.single { stroke: #10202e; stroke-width: .6; opacity: .45; }
.path-start { fill: #fff; stroke: #10202e; stroke-width: 1.8; }
@media screen and (prefers-color-scheme: dark) { svg.plan { filter: invert(.92) hue-rotate(180deg); } }
svg.plan { font-family: system-ui, sans-serif; }
@media screen and (max-width: 34rem) {
  body { padding: .9rem .75rem 2rem; }
  h1 { font-size: 1.35rem; }
  details dl { columns: 1; }
  dl.facts { grid-template-columns: 1fr; gap: 0; } dl.facts dd { margin-bottom: .35rem; }
  table, tbody, thead, caption { display: block; }
  tr { display: grid; grid-template-columns: repeat(var(--columns, 5), 1fr); border-bottom: 1px solid var(--rule);
    padding: .25rem 0; }
  tr > :first-child { grid-column: 1 / -1; }
  th, td { border: 0; padding: .05rem .2rem .05rem 0; font-size: .875rem; text-align: left; }
  thead th { font-size: .75rem; } tbody th { font-weight: 600; }
  td span { display: block; } td span + span { margin-left: 0; }
  table.gait tr { grid-template-columns: 1fr 1fr 1.3fr .8fr 1.3fr; }
  table.links tr { --columns: 4; } table.thirds tr { --columns: 2; }
}
@media print {
  @page { size: A4; margin: 15mm 14mm; }
  html { font-size: 9.5pt; }
  body { padding: 0; max-width: none; }
  figure { border: .5pt solid #ccc; background: #fff; break-inside: avoid; }
  .figures { grid-template-columns: 1fr 1fr; gap: 4mm; }
  h2 { break-after: avoid; } tr, li { break-inside: avoid; } table { break-inside: auto; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
"""
