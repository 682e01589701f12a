#include "scenarios/report/page_style.hpp"

namespace ironbird::scenarios {

const char* const kPageScript = R"js(
(function () {
  'use strict';
  const NS = 'http://www.w3.org/2000/svg';
  const make = (name, attributes, parent) => {
    const node = document.createElementNS(NS, name);
    for (const key in attributes) node.setAttribute(key, attributes[key]);
    parent.appendChild(node);
    return node;
  };
  const curvePoints = (path) => path.getAttribute('d').split('M').filter(Boolean)
    .map((run) => run.trim().split(' ').map((pair) => pair.split(',').map(Number)));
  const stacks = Array.from(document.querySelectorAll('svg.time-stack')).map((svg) => {
    const data = svg.dataset;
    const panels = Array.from(svg.querySelectorAll('g.panel')).map((node) => ({
      top: +node.dataset.top, bottom: +node.dataset.bottom, low: +node.dataset.low, high: +node.dataset.high,
      curves: Array.from(node.querySelectorAll('path.curve')).map((path) => ({
        name: path.dataset.name, points: null, path: path })),
      reading: make('text', { class: 'reading', x: +data.right, y: +node.dataset.top - 7 }, svg) }));
    const first = panels[0], last = panels[panels.length - 1];
    const cursor = make('line', { class: 'cursor', y1: first.top, y2: last.bottom, visibility: 'hidden' }, svg);
    return { svg, panels, cursor, left: +data.left, right: +data.right, from: +data.from, to: +data.to,
             axis: svg.querySelector('.time-axis'), names: svg.querySelectorAll('.phase-names, .mark-names'), bottom: last.bottom };
  });
  if (!stacks.length) return;
  const full = { from: stacks[0].from, to: stacks[0].to };
  let view = { from: full.from, to: full.to };

  const xOf = (s, t) => s.left + (t - view.from) / (view.to - view.from) * (s.right - s.left);
  const timeAt = (s, event) => {
    const box = s.svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * s.svg.viewBox.baseVal.width;
    return view.from + (Math.min(Math.max(x, s.left), s.right) - s.left) / (s.right - s.left) * (view.to - view.from);
  };
  const valueAt = (s, panel, curve, t) => {
    curve.points = curve.points || curvePoints(curve.path);
    const x = s.left + (t - s.from) / (s.to - s.from) * (s.right - s.left);
    if (curve.path.classList.contains('dots')) {
      const dot = curve.points.find((run) => Math.abs(run[0][0] - x) < 4);
      return dot ? panel.low + (panel.bottom - dot[0][1]) / (panel.bottom - panel.top) * (panel.high - panel.low) : null;
    }
    for (const run of curve.points) {
      if (!run.length || x < run[0][0] || x > run[run.length - 1][0]) continue;
      let a = 0, b = run.length - 1;
      while (b - a > 1) { const m = (a + b) >> 1; if (run[m][0] <= x) a = m; else b = m; }
      const span = run[b][0] - run[a][0];
      const y = span > 0 ? run[a][1] + (run[b][1] - run[a][1]) * (x - run[a][0]) / span : run[a][1];
      return panel.low + (panel.bottom - y) / (panel.bottom - panel.top) * (panel.high - panel.low);
    }
    return null;
  };
  const point = (t) => {
    for (const s of stacks) {
      const inside = t !== null && t >= view.from && t <= view.to;
      s.cursor.setAttribute('visibility', inside ? 'visible' : 'hidden');
      for (const panel of s.panels) panel.reading.textContent = '';
      if (!inside) continue;
      const x = xOf(s, t);
      s.cursor.setAttribute('x1', x);
      s.cursor.setAttribute('x2', x);
      s.panels.forEach((panel, index) => {
        const words = index === 0 ? [t.toFixed(2) + ' s'] : [];
        for (const curve of panel.curves) {
          const value = valueAt(s, panel, curve, t);
          if (value !== null) words.push((curve.name ? curve.name + ' ' : '') + Number(value.toPrecision(3)));
        }
        panel.reading.textContent = words.join('\u2003');
      });
    }
  };
  const niceStep = (span, most) => {
    const rough = span / most, power = Math.pow(10, Math.floor(Math.log10(rough)));
    for (const factor of [1, 2, 5]) if (rough <= factor * power * (1 + 1e-9)) return factor * power;
    return 10 * power;
  };
  const redraw = () => {
    for (const s of stacks) {
      const scale = (s.to - s.from) / (view.to - view.from);
      const shift = xOf(s, s.from) - s.left * scale;
      for (const g of s.svg.querySelectorAll('g.zoom')) g.setAttribute('transform', 'matrix(' + scale + ' 0 0 1 ' + shift + ' 0)');
      for (const g of s.names) g.setAttribute('visibility', scale > 1.001 ? 'hidden' : 'visible');
      s.axis.replaceChildren();
      const step = niceStep(view.to - view.from, Math.max(2, Math.floor((s.right - s.left) / 70)));
      const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
      for (let i = Math.ceil(view.from / step - 1e-6); i * step <= view.to + step * 1e-6; ++i) {
        const x = xOf(s, i * step);
        for (const panel of s.panels) make('line', { class: 'grid', x1: x, x2: x, y1: panel.top, y2: panel.bottom }, s.axis);
        make('text', { class: 'number x', x: x, y: s.bottom + 16 }, s.axis).textContent = (i * step).toFixed(decimals);
      }
    }
  };
  for (const s of stacks) {
    let start = null, brush = null;
    s.svg.addEventListener('pointermove', (event) => {
      const t = timeAt(s, event);
      point(t);
      if (start === null) return;
      brush = brush || make('rect', { class: 'brush', y: s.panels[0].top, height: s.bottom - s.panels[0].top }, s.svg);
      brush.setAttribute('x', Math.min(xOf(s, start), xOf(s, t)));
      brush.setAttribute('width', Math.abs(xOf(s, t) - xOf(s, start)));
    });
    s.svg.addEventListener('pointerleave', () => point(null));
    s.svg.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || event.pointerType === 'touch') return;
      event.preventDefault();
      start = timeAt(s, event);
      s.svg.setPointerCapture(event.pointerId);
    });
    s.svg.addEventListener('pointerup', (event) => {
      if (start === null) return;
      const end = timeAt(s, event), from = Math.min(start, end), to = Math.max(start, end);
      start = null;
      if (brush) brush.remove();
      brush = null;
      if (to - from > (view.to - view.from) * 0.01) { view = { from, to }; redraw(); }
    });
    s.svg.addEventListener('dblclick', () => { view = { from: full.from, to: full.to }; redraw(); });
  }
  for (const link of document.querySelectorAll('a.moment')) link.addEventListener('click', () => point(+link.dataset.time));
})();
)js";

}  // namespace ironbird::scenarios
