// Values under the pointer and zoom for every chart of the page, and their shape in narrow windows. A chart says its axes in <rect class="axes">:
// data-x and data-y hold the ends of the axis and 0 (linear) or ±1 (values are ±10^place); data-names its names.
'use strict';
const panelsOf = svg => [...svg.querySelectorAll('rect.axes')].map(rect => {
  const number = name => Number(rect.getAttribute(name));
  const axis = text => text.split(' ').map(Number);
  const [x, y, w, h] = ['x', 'y', 'width', 'height'].map(number);
  return { x, y, w, h, across: axis(rect.dataset.x), up: axis(rect.dataset.y), names: rect.dataset.names.split('|') };
});

// In a narrow window a chart is as wide as the window and LOWER as high as drawn; its words and points keep their own shape. Words that would
// lie on others are left out. Pictures of shapes, and charts with one scale on both axes, stay as they are.
const slim = matchMedia('screen and (max-width: 640px)'), LOWER = 0.74;
const equal = ({ w, h, across, up }) => !across[2] && !up[2] && Math.abs((across[1] - across[0]) / w * h / (up[1] - up[0]) - 1) < 0.01;
const shapes = svg => !svg.querySelector('rect.axes') && svg.querySelector('path:not([fill="none"]), circle, image');
for (const svg of document.querySelectorAll('figure svg:not(.whole)')) {
  if (panelsOf(svg).some(equal) || shapes(svg)) continue;
  const { width, height } = svg.viewBox.baseVal;
  const marks = [...svg.querySelectorAll('text, circle')].map(mark => ({ mark, own: mark.getAttribute('transform') || '' }));
  // The names of the axes first.
  marks.sort((a, b) => (b.own !== '') - (a.own !== ''));
  const fit = () => {
    const on = slim.matches, stretch = on ? LOWER * width / (svg.parentElement.clientWidth || innerWidth) : 1;
    svg.classList.toggle('slim', on);
    svg.setAttribute('preserveAspectRatio', on ? 'none' : 'xMidYMid');
    svg.style.height = on ? `${LOWER * height}px` : '';
    svg.dataset.stretch = stretch;
    const kept = [];
    for (const { mark, own } of marks) {
      const x = Number(mark.getAttribute('x') || mark.getAttribute('cx'));
      const place = (shift, part) => mark.setAttribute('transform', on ? `translate(${x + shift} 0) scale(${stretch * part} 1) translate(${-x} 0) ${own}` : own);
      place(0, 1);
      mark.style.visibility = '';
      if (!on || mark.tagName === 'circle') continue;
      // Words that go beyond the edge are made narrower, or moved inside where that would be too narrow.
      const all = svg.getBoundingClientRect(), box = mark.getBoundingClientRect();
      const over = Math.max(all.left - box.left, 0) || Math.min(all.right - box.right, 0), part = 1 - Math.abs(over) / box.width;
      if (over && mark.getAttribute('text-anchor') !== 'middle' && part > 0.55) place(0, part);
      else if (over && box.width < all.width) place(over * width / all.width, 1);
      const near = own ? 5 : 0, at = mark.getBoundingClientRect();
      const { left, right, top, bottom } = { left: at.left + near, right: at.right - near, top: at.top + 3, bottom: at.bottom - 3 };
      const covered = kept.some(b => left < b.right && b.left < right && top < b.bottom && b.top < bottom);
      if (covered) mark.style.visibility = 'hidden';
      else kept.push({ left, right, top, bottom });
    }
  };
  fit();
  addEventListener('resize', fit);
  slim.addEventListener('change', fit);
  // What was folded away had no size.
  svg.closest('details')?.addEventListener('toggle', fit);
}

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
  const panels = panelsOf(svg);
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
    if (value !== 0 && (size >= 1e6 || size < 1e-3)) {
      const more = Math.ceil(Math.log10(size / (Math.abs(span) || size)));
      return value.toExponential(Math.min(3 + more, 15));
    }
    return value.toFixed(Math.min(Math.max(Math.ceil(3 - Math.log10(Math.abs(span) || 1)), 0), 15));
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
    const stretch = Number(svg.dataset.stretch) || 1, long = stretch * box.width;
    const x = at.x + gap + long > view.x + view.width ? at.x - gap - long : at.x + gap;
    const y = at.y - gap - box.height < view.y ? at.y + gap + box.height : at.y - gap;
    const from = Math.max(x, view.x + 4 * scale), transform = `translate(${from} 0) scale(${stretch} 1) translate(${-from} 0)`;
    set(words, { x: from, y, transform });
    const fit = words.getBBox();
    set(plate, { transform, x: fit.x - 4 * scale, y: fit.y - 2 * scale, width: fit.width + 8 * scale, height: fit.height + 4 * scale });
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
