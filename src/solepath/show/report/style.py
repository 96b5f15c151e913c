"""Holds the style sheet of the report: light or dark as the system, one column on a phone, two pages of A4 on paper.

Letters are 12 px or larger on a screen. A drawing scales with its figure, so that its letters have a size for each
width of the screen. Drawings of the class `wide` are for wide screens and paper, those of the class `narrow` for the
others."""

from __future__ import annotations

STYLE = """
:root { --paper: #fff; --ink: #1b2430; --soft: #54606e; --rule: #d9dfe6; --panel: #f5f7f9;
  --left: #0067a8; --right: #b84700; --accent: #1d6f5c; --warn: #7d5200; --grid: #e4e8ed;
  --onbar: #fff; --good: #1d6f5c; --stop: #a4262c; --band: #9fd3c3; color-scheme: light dark; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #12171d; --ink: #e6ebf1; --soft: #a3afbc; --rule: #333e4a; --panel: #1a2129;
    --left: #5ab4f0; --right: #ff9d57; --accent: #5fd0b3; --warn: #e8b558; --grid: #29323c;
    --onbar: #0d1116; --good: #5fd0b3; --stop: #ff8f8a; --band: #2c6f5f; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 1.6rem 1.25rem 3rem; max-width: 64rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0; }
h2 { font-size: 1.1rem; margin: 1.8rem 0 .6rem; padding-bottom: .25rem; border-bottom: 1px solid var(--rule); }
h3 { font-size: 1rem; margin: 1rem 0 .3rem; }
p, ul { margin: .5rem 0; max-width: 52rem; }
ul { padding-left: 1.2rem; }
.note, .caution { color: var(--soft); font-size: .875rem; }
.headline { font-size: 1.3rem; line-height: 1.4; margin: 1rem 0 .4rem; }
.beside { margin: 0 0 .4rem; }
.warning { color: var(--stop); font-weight: 600; margin: 0; }
.warning.look { color: var(--warn); }
dl { margin: .5rem 0; } dd { margin: 0; }
dl.facts div { display: grid; grid-template-columns: 6.2rem 1fr; gap: 0 .8rem; }
header dl.facts { display: flex; flex-wrap: wrap; gap: .1rem 2rem; }
dl.facts dt { color: var(--soft); } header dl.facts div { display: flex; gap: .5rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(10.5rem, 1fr)); gap: .8rem; }
.card { background: var(--panel); border-radius: .5rem; padding: .7rem .8rem; min-width: 0; }
.card h3 { margin: 0; font-size: .875rem; font-weight: 600; color: var(--soft); }
.card p { margin: 0; } .card .note { line-height: 1.35; }
.card .value { line-height: 1.2; margin: .1rem 0 .25rem; }
.value span { font-size: 2.1rem; font-weight: 650; font-variant-numeric: tabular-nums; }
.value small { font-size: .9375rem; color: var(--soft); margin-left: .3em; }
.card svg { display: block; width: 100%; max-width: 15rem; height: auto; margin-top: .4rem; }
.scale { stroke: var(--rule); stroke-width: 6; stroke-linecap: round; } .band { stroke: var(--band); stroke-width: 8; }
svg path.pointer { fill: var(--ink); }
dl.quality { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 0 1.6rem; }
dl.quality div { display: grid; grid-template-columns: 6.2rem 1fr; column-gap: .8rem; padding: .35rem 0;
  border-bottom: 1px solid var(--rule); font-size: .9375rem; }
dl.quality .whole { grid-column: 1 / -1; }
dl.quality dt span { display: block; font-weight: 600; } dl.quality dt span::first-letter { text-transform: uppercase; }
.verdict { font-size: .8125rem; font-weight: 600; color: var(--soft); }
.verdict.good { color: var(--good); } .verdict.look { color: var(--warn); } .verdict.stop { color: var(--stop); }
dl.definitions { columns: 22rem; column-gap: 2rem; font-size: .875rem; color: var(--soft); }
dl.definitions div { break-inside: avoid; margin-bottom: .3rem; }
dl.definitions dt, dl.definitions dd { display: inline; } dl.definitions dt { font-weight: 600; color: var(--ink); }
dl.definitions dt::after { content: ": "; }
table { border-collapse: collapse; margin: 1rem 0; width: 100%; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .35rem; }
th, td { padding: .28rem .5rem; text-align: right; border-bottom: 1px solid var(--rule); vertical-align: baseline; }
thead th { color: var(--soft); font-size: .8125rem; font-weight: 600; }
table { overflow-wrap: break-word; }
tbody th { font-weight: 400; }
th:first-child { text-align: left; padding-left: 0; }
td span { white-space: nowrap; } td span + span { color: var(--soft); margin-left: .35em; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 25.5rem), 1fr)); gap: 1.2rem;
  align-items: start; margin-top: .8rem; }
.figures > p { grid-column: 1 / -1; margin: 0; } .figures > table { margin: .7rem 0; }
.ways figure + figure { margin-top: 1.2rem; }
figure { margin: 0; padding: .7rem; background: var(--panel); border-radius: .5rem; min-width: 0; }
figure svg { display: block; width: 100%; height: auto; } figure svg.narrow { max-width: 34rem; }
@media screen and (min-width: 56rem) { svg.narrow { display: none !important; } }
@media screen and (max-width: 55.99rem) { svg.wide { display: none !important; } }
figcaption { margin-top: .4rem; font-size: .875rem; }
figcaption strong, figcaption .note { display: block; }
figcaption .note { font-size: .8125rem; }
svg text { fill: var(--ink); font-size: 12.6px; }
svg .tick, svg .label { fill: var(--soft); }
svg .strong { font-weight: 600; } svg .halo { paint-order: stroke; stroke: var(--panel); stroke-width: 3px; }
svg text.onbar { fill: var(--onbar); font-weight: 600; }
svg.plan text { font-size: 13.2px; } svg.narrow text { font-size: 15.6px; } .card svg text { font-size: 18.6px; }
svg:where(:not(.plan)) path { fill: none; }
.grid { stroke: var(--grid); stroke-width: 1; } .axis { stroke: var(--soft); stroke-width: 1; }
.way { stroke: var(--accent); stroke-width: 2.4; stroke-linejoin: round; stroke-linecap: round; }
.start { fill: var(--panel); stroke: var(--accent); stroke-width: 2.5; } .end { fill: var(--accent); }
.time { fill: var(--ink); }
.line { stroke-width: 1.8; stroke-linejoin: round; } .line.left { stroke: var(--left); }
.line.right { stroke: var(--right); stroke-dasharray: 5 3; }
.mark.left { stroke: var(--left); stroke-width: 5; stroke-linecap: round; }
.mark.right { stroke: var(--right); stroke-width: 1.5; } .mark.faint { opacity: .45; }
.missing { stroke: var(--warn); stroke-width: 1.2; } .turn { stroke: var(--ink); stroke-width: 1.5; }
.dense .mark { opacity: .3; stroke-width: 1; } .dense .mark.left { stroke-width: 2.4; }
.dense .turn, .dense .missing { opacity: .35; stroke-width: .6; }
.flight { fill: none; stroke: var(--soft); stroke-dasharray: 3 3; }
svg .bar { fill: var(--accent); }
.cells { stroke: var(--soft); stroke-width: .5; }
.centre { stroke: #10202e; stroke-width: 2.2; stroke-linecap: round; stroke-linejoin: round; }
.under { stroke: #fff; stroke-width: 4.6; stroke-linecap: round; stroke-linejoin: round; }
.single { stroke: #10202e; stroke-width: .6; opacity: .45; }
.path-start { fill: #fff; stroke: #10202e; stroke-width: 1.8; }
@media screen and (prefers-color-scheme: dark) { svg.plan { filter: invert(.92) hue-rotate(180deg); } }
svg.plan { font-family: system-ui, sans-serif; }
@media screen and (max-width: 36rem) {
  body { padding: 1rem .75rem 2rem; }
  h1 { font-size: 1.35rem; } .headline { font-size: 1.125rem; }
  .cards { grid-template-columns: 1fr 1fr; gap: .6rem; } .card { padding: .6rem; }
  .card:last-child:nth-child(odd) { grid-column: 1 / -1; }
  .value span { font-size: 1.7rem; }
  figure { padding: .5rem; }
  figure svg text { font-size: 15.6px; } figure svg.plan.narrow text { font-size: 16.6px; }
  table, tbody, thead, caption { display: block; }
  tr { display: grid; grid-template-columns: repeat(var(--columns, 5), 1fr); border-bottom: 1px solid var(--rule);
    padding: .25rem 0; }
  .columns-1 { --columns: 1; } .columns-2 { --columns: 2; } .columns-3 { --columns: 3; } .columns-4 { --columns: 4; }
  tr > * { min-width: 0; } tr > :first-child { grid-column: 1 / -1; }
  th, td { border: 0; padding: .05rem .2rem .05rem 0; font-size: .875rem; text-align: left; }
  thead th { font-size: .75rem; } tbody th { font-weight: 600; }
  td span { display: block; white-space: normal; } td span + span { margin-left: 0; }
  table.gait tr { grid-template-columns: 1fr 1fr 1.3fr .8fr 1.3fr; }
  table.comparison tr { grid-template-columns: .8fr .8fr 1.7fr .8fr .8fr; }
  table.links tr { --columns: 4; }
}
@media print {
  @page { size: A4; margin: 10mm 14mm; }
  html { font-size: 9pt; }
  body { padding: 0; max-width: none; line-height: 1.35; }
  h1 { font-size: 17pt; } h2 { font-size: 10.5pt; margin: 2.8mm 0 1.2mm; padding-bottom: .5mm; break-after: avoid; }
  .headline { font-size: 12.5pt; margin: 2mm 0 1mm; }
  .cards { grid-template-columns: repeat(5, 1fr); gap: 2.5mm; } .card { padding: 2mm; border: .5pt solid #ccc; }
  .card .note { font-size: 7.5pt; } .value span { font-size: 19pt; }
  figure { border: .5pt solid #ccc; background: #fff; break-inside: avoid; padding: 1.5mm; }
  figcaption { margin-top: .5mm; font-size: 7.5pt; } figcaption .note { font-size: 7pt; }
  svg.narrow.narrow { display: block; } svg.wide ~ svg.narrow { display: none; }
  .figures { grid-template-columns: repeat(3, 1fr); gap: 2mm; margin-top: 1.5mm; }
  .figures svg text, .figures svg.narrow text { font-size: 17px; } .figures > p { margin: 0; }
  .figures .stride-speed { display: none; } .ways svg { max-height: 82mm; }
  .figures.soles svg { max-height: 32mm; }
  .figures.soles svg text { font-size: 19px; }
  .figures.soles .note, #gait ~ .figures figcaption .note { display: none; }
  #course ~ .figures { display: flex; flex-wrap: wrap; } #course ~ .figures > figure { flex: 0 1 calc(25% - 1.5mm); }
  #course ~ .figures > figure:only-of-type { flex-basis: 65mm; }
  #course ~ .figures > ul { flex: 1 0 100%; columns: 3; margin: 0; } #course ~ .figures svg { max-height: 28mm; }
  #course ~ .figures .note { display: none; }
  #comparison ~ .figures svg { max-height: 24mm; } #comparison ~ .figures .note { display: none; }
  #health ~ ul { columns: 2; } ul { padding-left: 3.5mm; font-size: 7.5pt; line-height: 1.25; }
  dl.quality { grid-template-columns: 1fr 1fr; } dl.quality div { padding: 1mm 0; font-size: 8pt; }
  .verdict { font-size: 7.5pt; }
  .test section { break-inside: avoid; } .test section p { font-size: 7.5pt; } .test .headline { font-size: 11.5pt; }
  .test h2 { margin: 2mm 0 1mm; } .test .figures { margin-top: 1mm; }
  .test section dl.facts { font-size: 6.5pt; line-height: 1.2; columns: 1; } table.titled caption { display: none; }
  .second-page { break-before: page; }
  .second-page > section:first-child h2 { margin-top: 0; }
  table { margin: 1mm 0; font-size: 7.5pt; line-height: 1.2; break-inside: auto; } th, td { padding: .28mm 1.5mm; }
  thead th { font-size: 7pt; } h3 { margin: 1.5mm 0 .5mm; }
  tr, li { break-inside: avoid; } p, ul { margin: 1mm 0; max-width: none; }
  .note, .caution { font-size: 7.5pt; }
  dl.definitions { columns: 3; column-gap: 5mm; font-size: 6.5pt; line-height: 1.17; margin: 1mm 0; }
  dl.definitions div { margin-bottom: .3mm; }
  dl.facts { font-size: 7.5pt; margin: 1mm 0; columns: 2; } table.links caption { display: none; }
  dl.facts div { grid-template-columns: 15mm 1fr; gap: 0 2mm; } header dl.facts { font-size: 9pt; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
"""
