// Values under the pointer and zoom for every chart of the page. A chart says its axes in <rect class="axes">:
// data-x and data-y hold the ends of the axis and 0 (linear) or ±1 (values are ±10^place); data-names its names.
'use strict';
const charts = [...document.querySelectorAll('figure svg')].filter(svg => svg.querySelector('rect.axes'));
if (charts.length) {
  const help = document.createElement('p');
  help.className = 'note';
  help.textContent = 'Charts show the values under the pointer. Zoom: drag a rectangle, or Ctrl and the wheel; back: double click.';
  charts[0].closest('figure').before(help);
  addEventListener('beforeprint', () => help.remove());
}
for (const svg of charts) {
  const NS = 'http://www.w3.org/2000/svg';
  const whole = svg.viewBox.baseVal, home = [whole.x, whole.y, whole.width, whole.height];
  const panels = [...svg.querySelectorAll('rect.axes')].map(rect => {
    const number = name => Number(rect.getAttribute(name));
    const axis = text => text.split(' ').map(Number);
    const [x, y, w, h] = ['x', 'y', 'width', 'height'].map(number);
    return { x, y, w, h, across: axis(rect.dataset.x), up: axis(rect.dataset.y), names: rect.dataset.names.split('|') };
  });
  const element = (name, style) => {
    const made = svg.appendChild(document.createElementNS(NS, name));
    made.setAttribute('style', `pointer-events:none;display:none;${style}`);
    return made;
  };
  const line = () => element('path', 'stroke:#1b1f24;stroke-width:1;stroke-dasharray:3 3;fill:none;vector-effect:non-scaling-stroke');
  const frame = element('rect', 'fill:#0072b2;fill-opacity:.12;stroke:#0072b2;vector-effect:non-scaling-stroke');
  const cross = line(), plate = element('rect', 'fill:#fff;fill-opacity:.92;stroke:#5b6570;vector-effect:non-scaling-stroke');
  const words = element('text', "font:13px system-ui,'Segoe UI',Helvetica,Arial,sans-serif;fill:#1b1f24");
  const show = (made, on) => { made.style.display = on ? '' : 'none'; };
  const set = (made, values) => Object.entries(values).forEach(([key, value]) => made.setAttribute(key, value));
  const spot = event => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  const clear = () => [cross, plate, words].forEach(made => show(made, false));
  // The common name of the axis below stands under the last panel.
  const below = panels.map(p => p.names[0]).filter(Boolean).pop() || '';

  const digits = (value, span) => {
    const size = Math.max(Math.abs(value), Math.abs(span));
    if (value !== 0 && (size >= 1e6 || size < 1e-3)) return value.toExponential(3);
    return value.toFixed(Math.min(Math.max(Math.ceil(3 - Math.log10(Math.abs(span) || 1)), 0), 9));
  };
  const read = ([from, to, decades], part, name) => {
    const place = from + part * (to - from), value = decades ? decades * 10 ** place : place;
    const unit = (name.match(/\[(.*)\]\s*$/) || [])[1], word = name.replace(/\s*\[.*\]\s*$/, '');
    const text = decades ? value.toPrecision(4) : digits(value, to - from);
    return `${word} ${text.replace('-', '−')}${unit && unit !== '1' && unit !== '–' ? ` ${unit}` : ''}`;
  };
  function hover(at) {
    const p = panels.find(q => at.x >= q.x && at.x <= q.x + q.w && at.y >= q.y && at.y <= q.y + q.h);
    if (!p) return clear();
    const scale = svg.viewBox.baseVal.width / home[2];
    set(cross, { d: `M${at.x} ${p.y}v${p.h}M${p.x} ${at.y}h${p.w}` });
    words.textContent = `${read(p.across, (at.x - p.x) / p.w, p.names[0] || below)} · ${read(p.up, 1 - (at.y - p.y) / p.h, p.names[1])}`;
    words.style.fontSize = `${13 * scale}px`;
    [cross, plate, words].forEach(made => show(made, true));
    const box = words.getBBox(), view = svg.viewBox.baseVal, gap = 10 * scale;
    const x = at.x + gap + box.width > view.x + view.width ? at.x - gap - box.width : at.x + gap;
    const y = at.y - gap - box.height < view.y ? at.y + gap + box.height : at.y - gap;
    set(words, { x: Math.max(x, view.x + 4 * scale), y });
    const fit = words.getBBox();
    set(plate, { x: fit.x - 4 * scale, y: fit.y - 2 * scale, width: fit.width + 8 * scale, height: fit.height + 4 * scale });
  }
  function view(x, y, w) {
    const width = Math.min(Math.max(w, home[2] / 200), home[2]), height = width * home[3] / home[2];
    const inside = (v, size, k) => Math.min(Math.max(v, home[k]), home[k] + home[k + 2] - size);
    svg.setAttribute('viewBox', [inside(x, width, 0), inside(y, height, 1), width, height].join(' '));
    svg.style.cursor = width < home[2] ? 'zoom-out' : '';
  }
  let start = null;
  svg.style.touchAction = 'pan-x pan-y';
  svg.addEventListener('pointerdown', event => { if (event.pointerType === 'mouse' && event.button === 0) { start = spot(event); event.preventDefault(); } });
  svg.addEventListener('pointermove', event => {
    const at = spot(event);
    if (start && event.buttons) {
      set(frame, { x: Math.min(at.x, start.x), y: Math.min(at.y, start.y), width: Math.abs(at.x - start.x), height: Math.abs(at.y - start.y) });
      show(frame, true);
    }
    hover(at);
  });
  addEventListener('pointerup', event => {
    if (!start) return;
    const at = spot(event), w = Math.abs(at.x - start.x), h = Math.abs(at.y - start.y);
    show(frame, false);
    if (w > 0.01 * home[2] && h > 0.01 * home[3]) {
      const width = Math.max(w, h * home[2] / home[3]), height = width * home[3] / home[2];
      view((at.x + start.x - width) / 2, (at.y + start.y - height) / 2, width);
    }
    start = null;
  });
  svg.addEventListener('pointerleave', clear);
  svg.addEventListener('dblclick', () => { view(home[0], home[1], home[2]); getSelection().removeAllRanges(); });
  // The wheel alone moves the page.
  svg.addEventListener('wheel', event => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    const at = spot(event), now = svg.viewBox.baseVal, factor = Math.exp(event.deltaY * 0.002);
    view(at.x - (at.x - now.x) * factor, at.y - (at.y - now.y) * factor, now.width * factor);
    hover(at);
  }, { passive: false });
  addEventListener('beforeprint', () => { clear(); view(home[0], home[1], home[2]); });
}
