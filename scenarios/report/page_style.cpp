#include "scenarios/report/page_style.hpp"

namespace ironbird::scenarios {

const char* const kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --card: #f6f7f9; --ink: #1b1f24; --soft: #5d6670; --hair: #d9dde2; --zero: #aab1b9;
  --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #cc79a7; --c4: #e69f00; --c5: #56b4e9; --c6: #8b5a2b; --c7: #7a7a00;
  --command: #4a5058; --pass: #0b7a4b; --fail: #b3261e; --open: #8a5a00; --on: #ffffff;
  --flight: #0072b212; --climb: #009e7318; --descend: #e69f001f; --fault: #b3261e;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171b; --card: #1d2126; --ink: #e8eaed; --soft: #9aa3ad; --hair: #31373e; --zero: #59616a;
    --c0: #58b4f0; --c1: #f08a4b; --c2: #35c99b; --c3: #e59cc4; --c4: #f2b632; --c5: #9ad4f7; --c6: #c79a6b; --c7: #c9c94a;
    --command: #b4bbc3; --pass: #1f8f5f; --fail: #cf4037; --open: #9c6b08; --fault: #ff7b72;
    --flight: #58b4f016; --climb: #35c99b20; --descend: #f2b63222;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1260px; margin: 0 auto; padding: 28px 28px 64px; }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 18px; margin: 40px 0 10px; letter-spacing: -0.005em; }
.verdict { display: grid; grid-template-columns: minmax(200px, auto) 1fr; border-radius: 12px; overflow: hidden; background: var(--card); border: 1px solid var(--hair); margin-top: 18px; }
.stamp { display: flex; align-items: center; justify-content: center; padding: 22px 34px; font-size: 38px; font-weight: 800; letter-spacing: 0.03em; text-transform: uppercase; color: var(--on); background: var(--open); }
.verdict.pass .stamp { background: var(--pass); } .verdict.fail .stamp { background: var(--fail); }
.verdict.inconclusive .stamp, .verdict.invalid .stamp { font-size: 24px; }
.words { padding: 20px 26px; min-width: 0; }
.summary { margin: 0; color: var(--soft); font-size: 16px; }
.warning { color: var(--fail); margin: 4px 0 0; }
.reasons { margin: 10px 0 0; padding-left: 18px; overflow-wrap: anywhere; }
.identity { display: flex; flex-wrap: wrap; gap: 4px 26px; margin: 14px 0 0; }
.identity.flight { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); } .identity.flight dt { white-space: nowrap; }
.identity div { display: flex; gap: 7px; } .identity dt { color: var(--soft); } .identity dd { margin: 0; font-variant-numeric: tabular-nums; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px; margin: 14px 0 0; }
.tile { background: var(--card); border: 1px solid var(--hair); border-radius: 10px; padding: 12px 16px; }
.tile b { display: block; font-size: 24px; line-height: 1.2; font-variant-numeric: tabular-nums; } .tile i { font-style: normal; font-weight: 500; font-size: 14px; color: var(--soft); margin-left: 5px; }
.tile span { color: var(--soft); font-size: 13px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; } table.short { width: auto; min-width: 420px; }
th, td { text-align: left; padding: 6px 14px 6px 0; border-bottom: 1px solid var(--hair); vertical-align: top; }
thead th { color: var(--soft); font-weight: 500; } tbody th { font-weight: 600; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.number, th.number { padding-right: 22px; } .meaning { color: var(--soft); }
td.margin.pass { color: var(--pass); } td.margin.fail { color: var(--fail); font-weight: 700; }
@media (prefers-color-scheme: dark) { td.margin.pass { color: var(--c2); } td.margin.fail { color: var(--fault); } }
code { font: 13px/1.4 ui-monospace, "DejaVu Sans Mono", monospace; }
.badge { display: inline-block; min-width: 5.2em; text-align: center; border-radius: 99px; padding: 0 10px; font-size: 12px; font-weight: 700; line-height: 20px; color: var(--on); background: var(--open); }
.badge.pass { background: var(--pass); } .badge.fail { background: var(--fail); }
a.moment { color: inherit; text-decoration: underline dotted; text-underline-offset: 3px; }
details { margin-top: 18px; } summary { cursor: pointer; font-weight: 600; }
pre { background: var(--card); border: 1px solid var(--hair); border-radius: 8px; padding: 14px 18px; overflow-x: auto; font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
.pair, .triple { margin-bottom: 14px; } .pair { display: grid; grid-template-columns: 480fr 780fr; gap: 12px; align-items: start; } .triple { display: grid; grid-template-columns: repeat(3, 1fr); gap: 10px; }
figure { margin: 0; min-width: 0; } figure > svg, .wide > svg, .narrow > svg { display: block; width: 100%; height: auto; } .narrow { display: none; } figcaption { font-weight: 600; margin: 0 0 4px; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 16px; color: var(--soft); font-size: 13px; margin: 0 0 4px; } .legend span { display: inline-flex; align-items: center; gap: 6px; }
.hint { color: var(--soft); font-size: 13px; margin: 0 0 8px; }
svg { font: 12px system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", sans-serif; fill: var(--ink); }
.time-stack { touch-action: pan-y; }
.frame { fill: none; stroke: var(--hair); } .grid { stroke: var(--hair); stroke-width: 0.7; } .zero { stroke: var(--zero); stroke-width: 1; }
.number.x, .axis-name, .phase-name, .missing, .place-name { text-anchor: middle; } .number.y { text-anchor: end; }
text.number, .axis-name, .unit, .missing { fill: var(--soft); } text.number { font-size: 11.5px; font-variant-numeric: tabular-nums; }
.panel-title { font-weight: 600; } .unit { font-weight: 400; }
.curve { fill: none; stroke: var(--ink); stroke-width: 1.6; stroke-linejoin: round; vector-effect: non-scaling-stroke; } .curve.thin { stroke-width: 1.1; }
.curve.c0 { stroke: var(--c0); } .curve.c1 { stroke: var(--c1); } .curve.c2 { stroke: var(--c2); } .curve.c3 { stroke: var(--c3); } .curve.c4 { stroke: var(--c4); } .curve.c5 { stroke: var(--c5); } .curve.c6 { stroke: var(--c6); } .curve.c7 { stroke: var(--c7); }
.curve.command { stroke-width: 5; stroke-opacity: 0.32; stroke-linecap: butt; } .curve.command.plain { stroke: var(--command); } .curve.under { stroke-width: 2.4; } .dashed { stroke-dasharray: 6 4; } .dotted { stroke-dasharray: 1.5 3.5; } .curve.dots { stroke-width: 3; stroke-linecap: round; } .curve.refused { stroke: var(--fault); stroke-width: 5; } .curve.bound { stroke-width: 1.1; stroke-dasharray: 5 3; }
.strip { stroke: none; fill: var(--c0); fill-opacity: 0.16; } .strip.several { fill-opacity: 0.06; } .strip.c1 { fill: var(--c1); } .strip.c2 { fill: var(--c2); } .strip.c3 { fill: var(--c3); } .strip.c4 { fill: var(--c4); } .strip.c5 { fill: var(--c5); } .strip.c6 { fill: var(--c6); } .strip.c7 { fill: var(--c7); }
.phase { fill: transparent; } .phase.offboard { fill: var(--flight); } .phase.take_off, .phase.hold { fill: var(--climb); } .phase.landing { fill: var(--descend); }
.phase-lane { fill: var(--card); stroke: var(--hair); vector-effect: non-scaling-stroke; } .phase-lane.offboard { fill: var(--flight); } .phase-lane.take_off, .phase-lane.hold { fill: var(--climb); } .phase-lane.landing { fill: var(--descend); }
.phase-name, .mark-name { font-size: 11px; fill: var(--soft); paint-order: stroke; stroke: var(--paper); stroke-width: 3px; stroke-linejoin: round; } .phase-name { stroke: none; } .mark-name.fault { fill: var(--fault); font-weight: 600; } .mark-name.before, .more { text-anchor: end; } .more { font-size: 11px; fill: var(--soft); }
.mark { stroke: var(--soft); stroke-width: 1; stroke-dasharray: 2 3; opacity: 0.7; vector-effect: non-scaling-stroke; } .mark.fault { stroke: var(--fault); stroke-width: 1.6; opacity: 1; stroke-dasharray: none; }
.place circle { fill: var(--paper); stroke: var(--ink); stroke-width: 1.4; } .place-name { font-size: 11px; font-weight: 700; }
.cursor { stroke: var(--ink); stroke-width: 1; opacity: 0.6; pointer-events: none; } .reading { font-size: 11.5px; font-variant-numeric: tabular-nums; text-anchor: end; pointer-events: none; }
.brush { fill: var(--c0); fill-opacity: 0.15; pointer-events: none; }
footer { margin-top: 48px; color: var(--soft); font-size: 13px; }
@media (max-width: 1000px) {
  .wide { display: none; } .narrow { display: block; }
  .pair { grid-template-columns: 1fr; } .triple { grid-template-columns: repeat(auto-fit, minmax(340px, 1fr)); }
  .verdict { grid-template-columns: 1fr; } main { padding: 14px; } figure { overflow-x: auto; }
  .narrow > .time-stack { min-width: 540px; } figure > svg { max-width: 580px; }
  table { font-size: 13px; } td { overflow-wrap: anywhere; } td.number { overflow-wrap: normal; } tbody th { min-width: 7.5em; }
}
@media print { main { max-width: none; padding: 0; } section, figure { break-inside: avoid; } .hint { display: none; } details { display: none; } }
)css";

}  // namespace ironbird::scenarios
