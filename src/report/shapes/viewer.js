// The mode shapes of the page in motion, and its motion in time: u = Σ re_h cos hωt − im_h sin hωt at every node, h = 1, 2 …, worked
// out by the graphics processor.
// Drawn with WebGL2; where there is none, as a still picture that follows the controls.
'use strict';
(() => {
  const root = document.getElementById('shapes');
  const data = JSON.parse(document.getElementById('shapes-data').textContent);
  let canvas = root.querySelector('canvas');
  const at = name => root.querySelector(`[data-of=${name}]`);
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const shorts = text => Float32Array.from(new Int16Array(bytes(text)), v => v / 32767);

  // Vertices: the nodes first, then those of the tubes about bars and the octahedra about points.
  const places = [...shorts(data.places)];
  const normals = Array.from(new Int8Array(bytes(data.normals)), v => v / 127);
  const nodeOf = Array.from({ length: places.length / 3 }, (_, k) => k);
  const place = k => places.slice(3 * k, 3 * k + 3);
  const vertex = (node, offset) => {
    for (let c = 0; c < 3; c++) { places.push(places[3 * node + c] + offset[c]); normals.push(0); }
    return nodeOf.push(node) - 1;
  };
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const scaled = (a, s) => a.map(c => c * s);
  const unit = a => scaled(a, 1 / (Math.hypot(...a) || 1));
  const THICK = 0.008, BALL = 0.03;

  function tube(triangles, a, b) {
    const along = unit(place(b).map((c, k) => c - place(a)[k]));
    const e = unit(cross(along, Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), f = cross(along, e);
    const ring = node => [0, 1, 2, 3, 4, 5].map(k => {
      const t = k * Math.PI / 3;
      return vertex(node, e.map((c, i) => THICK * (c * Math.cos(t) + f[i] * Math.sin(t))));
    });
    const [p, q] = [ring(a), ring(b)];
    for (let k = 0; k < 6; k++) { const n = (k + 1) % 6; triangles.push(p[k], q[k], q[n], p[k], q[n], p[n]); }
  }

  function ball(triangles, node) {
    const tips = [0, 1, 2].map(c => [1, -1].map(s => vertex(node, [0, 1, 2].map(k => (k === c ? s * BALL : 0)))));
    for (const x of tips[0]) for (const y of tips[1]) for (const z of tips[2]) triangles.push(x, y, z);
  }

  // Edges of one face only: the outline of a plate.
  function outline(faces) {
    const count = new Map();
    for (let k = 0; k < faces.length; k += 3) {
      for (let c = 0; c < 3; c++) {
        const [a, b] = [faces[k + c], faces[k + (c + 1) % 3]].sort((x, y) => x - y);
        count.set(a * 4294967296 + b, (count.get(a * 4294967296 + b) || 0) + 1);
      }
    }
    return [...count].filter(([, n]) => n === 1).flatMap(([key]) => [Math.floor(key / 4294967296), key % 4294967296]);
  }

  const parts = data.parts.map(part => {
    const triangles = Array.from(new Uint32Array(bytes(part.faces)));
    const edges = outline(triangles);
    const bars = new Uint32Array(bytes(part.bars));
    for (let k = 0; k < bars.length; k += 2) tube(triangles, bars[k], bars[k + 1]);
    new Uint32Array(bytes(part.points)).forEach(node => ball(triangles, node));
    return { ...part, triangles: Uint32Array.from(triangles), edges: Uint32Array.from(edges), on: true };
  }).filter(part => part.triangles.length);

  const spread = field => {
    const values = new Float32Array(3 * nodeOf.length);
    if (field) nodeOf.forEach((node, k) => { for (let c = 0; c < 3; c++) values[3 * k + c] = field[3 * node + c]; });
    return values;
  };
  const rgb = hex => [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16) / 255);
  const stops = [data.diverging, data.sequential].map(list => list.map(rgb));

  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const state = { phase: 0, amplitude: 0.08, colour: 0, zoom: 1, turn: data.view, playing: !still, mode: null, speed: 0.5 };
  // Of each harmonic of the mode: re and im at every vertex. WebGL2 has attributes for six, place and normal.
  const MOST = 6, each = Array.from({ length: MOST }, (_, h) => h);
  let fields = [];
  const waves = () => each.flatMap(h => [Math.cos((h + 1) * state.phase), Math.sin((h + 1) * state.phase)]);

  // --- WebGL2 ---
  const VERTEX = `#version 300 es
    in vec3 place, normal, ${each.map(h => `re${h}, im${h}`).join(', ')};
    uniform mat3 turn; uniform vec2 waves[${MOST}], fit; uniform float amplitude; uniform int colour;
    out vec3 seen; out float value;
    void main() {
      vec3 u = ${each.map(h => `re${h} * waves[${h}].x - im${h} * waves[${h}].y`).join(' + ')};
      seen = (place + amplitude * u) * turn;
      value = colour == 0 ? 0.5 + 0.5 * dot(u, normal) : length(u);
      // Outlines stand a little before their faces.
      gl_Position = vec4(seen.xy * fit, -0.3 * seen.z - (colour == 3 ? 0.001 : 0.0), 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float; precision highp int;
    in vec3 seen; in float value;
    uniform vec3 stops[5], ink; uniform int colour;
    out vec4 shown;
    void main() {
      if (colour == 3) { shown = vec4(ink, 1.0); return; }
      float t = clamp(value, 0.0, 1.0) * 4.0;
      int k = min(int(t), 3);
      vec3 base = colour == 2 ? ink : mix(stops[k], stops[k + 1], t - float(k));
      vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
      shown = vec4(base * (0.75 + 0.25 * abs(n.z)), 1.0);
    }`;

  function webgl() {
    const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
    if (!gl) return null;
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      // A canvas keeps the kind of its first context.
      const fresh = canvas.cloneNode();
      canvas.replaceWith(fresh);
      canvas = fresh;
      return null;
    }
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    const uniform = name => gl.getUniformLocation(program, name);
    const buffers = {};
    const attribute = (name, values) => {
      const slot = gl.getAttribLocation(program, name);
      if (!values) {
        if (slot >= 0) gl.disableVertexAttribArray(slot);
        return;
      }
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name] ||= gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      if (slot < 0) return;
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, 3, gl.FLOAT, false, 0, 0);
    };
    attribute('place', Float32Array.from(places));
    attribute('normal', Float32Array.from(normals));
    const indices = values => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, values, gl.STATIC_DRAW);
      return buffer;
    };
    for (const part of parts) part.buffers = [indices(part.triangles), indices(part.edges)];
    const draw = (buffer, kind, count) => {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.drawElements(kind, count, gl.UNSIGNED_INT, 0);
    };
    const frame = () => {
      const [w, h] = [canvas.width, canvas.height], size = fit(w, h);
      gl.viewport(0, 0, w, h);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.uniform2fv(uniform('waves'), waves());
      gl.uniform2f(uniform('fit'), size / w, size / h);
      // Rows as columns: the shader multiplies from the left.
      gl.uniformMatrix3fv(uniform('turn'), false, state.turn.flat());
      gl.uniform3fv(uniform('stops'), stops[state.colour === 1 ? 1 : 0].flat());
      gl.uniform1f(uniform('amplitude'), state.amplitude);
      gl.uniform1i(uniform('colour'), state.colour);
      for (const part of parts.filter(part => part.on)) {
        gl.uniform3fv(uniform('ink'), rgb(part.colour));
        draw(part.buffers[0], gl.TRIANGLES, part.triangles.length);
      }
      // Outlines: in motion, and fainter at rest.
      gl.uniform1i(uniform('colour'), 3);
      for (const [amplitude, ink] of [[state.amplitude, [0.25, 0.28, 0.32]], [0, [0.6, 0.63, 0.67]]]) {
        gl.uniform1f(uniform('amplitude'), amplitude);
        gl.uniform3fv(uniform('ink'), ink);
        parts.filter(part => part.on).forEach(part => draw(part.buffers[1], gl.LINES, part.edges.length));
      }
    };
    // An attribute without an array is zero.
    return { frame, fields: () => each.forEach(h => { attribute(`re${h}`, fields[h]?.re); attribute(`im${h}`, fields[h]?.im); }) };
  }

  // --- Without WebGL2: the faces from the farthest to the nearest ---
  function painted() {
    const sheet = canvas.getContext('2d');
    const frame = () => {
      const [w, h] = [canvas.width, canvas.height], size = 0.5 * fit(w, h);
      const wave = waves();
      const seen = nodeOf.map((_, k) => {
        const u = [0, 1, 2].map(i => fields.reduce((sum, { re, im }, h) => sum + re[3 * k + i] * wave[2 * h] - im[3 * k + i] * wave[2 * h + 1], 0));
        const p = place(k).map((x, i) => x + state.amplitude * u[i]);
        const value = state.colour === 0 ? 0.5 + 0.5 * u.reduce((sum, v, i) => sum + v * normals[3 * k + i], 0) : Math.hypot(...u);
        const [x, y, z] = state.turn.map(row => row.reduce((sum, r, i) => sum + r * p[i], 0));
        return [w / 2 + size * x, h / 2 - size * y, z, value];
      });
      const faces = [];
      for (const part of parts.filter(part => part.on)) {
        for (let k = 0; k < part.triangles.length; k += 3) {
          const corners = [0, 1, 2].map(i => seen[part.triangles[k + i]]);
          const mean = i => (corners[0][i] + corners[1][i] + corners[2][i]) / 3;
          const t = 4 * Math.min(Math.max(mean(3), 0), 1), j = Math.min(Math.floor(t), 3), ramp = stops[state.colour === 1 ? 1 : 0];
          const base = state.colour === 2 ? rgb(part.colour) : ramp[j].map((v, i) => v + (t - j) * (ramp[j + 1][i] - v));
          faces.push([mean(2), corners, `rgb(${base.map(v => Math.round(255 * v))})`]);
        }
      }
      sheet.clearRect(0, 0, w, h);
      for (const [, corners, colour] of faces.sort((a, b) => a[0] - b[0])) {
        sheet.fillStyle = sheet.strokeStyle = colour;
        sheet.beginPath();
        corners.forEach(([x, y], k) => (k ? sheet.lineTo(x, y) : sheet.moveTo(x, y)));
        sheet.closePath();
        sheet.fill();
        sheet.stroke();
      }
    };
    state.playing = false;
    at('play').disabled = true;
    at('note').textContent = 'This browser shows no WebGL2: a still picture at the chosen phase.';
    return { frame, fields: () => {} };
  }

  // The scale at which the model at rest fills the picture in the first view: half extents to the right and up.
  const extent = data.view.slice(0, 2).map(row => {
    let most = 0.1;
    for (let k = 0; k < places.length; k += 3) most = Math.max(most, Math.abs(row[0] * places[k] + row[1] * places[k + 1] + row[2] * places[k + 2]));
    return most;
  });
  const fit = (w, h) => 0.86 * state.zoom * Math.min(w / extent[0], h / extent[1]);

  const picture = webgl() || painted();
  let due = false, last = 0, visible = true;
  const redraw = () => { if (!due) { due = true; requestAnimationFrame(frame); } };
  function frame(now) {
    due = false;
    if (state.playing && visible) {
      state.phase = (state.phase + Math.min(now - last, 100) * 0.002 * Math.PI * state.speed) % (2 * Math.PI);
      at('phase').value = Math.round(state.phase * 180 / Math.PI);
      redraw();
    }
    last = now;
    // A mode that does not oscillate has no time of its own.
    const { hz, begin } = state.mode, time = begin + state.phase / (2 * Math.PI * hz);
    at('degrees').value = `${at('phase').value}°` + (hz > 0 ? `, t = ${(1000 * time).toFixed(3)} ms` : '');
    at('slower').value = hz > 0 ? `1 : ${Math.round(hz / state.speed)}` : '';
    picture.frame();
  }

  // --- Controls ---
  function choose(k) {
    state.mode = data.modes[k];
    fields = state.mode.harmonics.map(({ re, im }) => ({ re: spread(shorts(re)), im: spread(im && shorts(im)) }));
    picture.fields();
    canvas.setAttribute('aria-label', `The model in the motion of ${state.mode.name}`);
    redraw();
  }
  function play(on) {
    state.playing = on;
    at('play').textContent = on ? 'Pause' : 'Play';
    redraw();
  }
  function scale() {
    const [low, high] = root.querySelectorAll('.scale span');
    const ramp = state.colour === 1 ? data.sequential : data.diverging;
    root.querySelector('.scale').hidden = state.colour === 2;
    root.querySelector('.scale').style.display = state.colour === 2 ? 'none' : '';
    root.querySelector('.scale i').style.background = `linear-gradient(to right, ${ramp.join(', ')})`;
    low.textContent = state.colour === 1 ? '0' : '−largest';
    high.textContent = state.colour === 1 ? 'largest displacement' : '+largest displacement';
  }
  const groups = new Map();
  data.modes.forEach((mode, k) => {
    if (!groups.has(mode.set)) {
      groups.set(mode.set, document.createElement('optgroup'));
      groups.get(mode.set).label = mode.set;
      at('mode').append(groups.get(mode.set));
    }
    groups.get(mode.set).append(new Option(mode.name, k));
  });
  for (const part of parts) {
    const label = document.createElement('label'), box = document.createElement('input');
    box.type = 'checkbox';
    box.checked = true;
    box.addEventListener('change', () => { part.on = box.checked; redraw(); });
    label.append(box, part.name);
    at('parts').append(label);
  }
  at('mode').value = data.first;
  at('mode').addEventListener('change', () => choose(at('mode').value));
  at('colour').addEventListener('change', () => { state.colour = Number(at('colour').value); scale(); redraw(); });
  at('play').addEventListener('click', () => play(!state.playing));
  at('home').addEventListener('click', () => { state.turn = data.view; state.zoom = 1; redraw(); });
  at('phase').addEventListener('input', () => { state.phase = at('phase').value * Math.PI / 180; play(false); });
  at('speed').addEventListener('input', () => { state.speed = 0.5 * 2 ** at('speed').value; redraw(); });
  at('amplitude').addEventListener('input', () => { state.amplitude = at('amplitude').value / 100; redraw(); });

  // --- Turning and zooming: the rows of `turn` are right, up and towards the viewer ---
  function rotate(dx, dy) {
    const by = (a, b, angle) => [0, 1, 2].map(k => a[k] * Math.cos(angle) + b[k] * Math.sin(angle));
    let [right, up, towards] = state.turn;
    [right, towards] = [by(right, towards, dx), by(towards, right, -dx)];
    [up, towards] = [by(up, towards, -dy), by(towards, up, dy)];
    state.turn = [right, up, towards].map(unit);
    redraw();
  }
  const zoom = factor => { state.zoom = Math.min(Math.max(state.zoom * factor, 0.3), 20); redraw(); };
  const fingers = new Map();
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener('pointermove', event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const other = [...fingers].find(([id]) => id !== event.pointerId);
    if (other) {
      const far = p => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]) || 1;
      zoom(far(now) / far(before));
    } else {
      rotate((now[0] - before[0]) * 0.01, (now[1] - before[1]) * 0.01);
    }
    fingers.set(event.pointerId, now);
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener('wheel', event => {
    if (document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.0015));
  }, { passive: false });
  const keys = {
    ArrowLeft: () => rotate(-0.1, 0), ArrowRight: () => rotate(0.1, 0), ArrowUp: () => rotate(0, -0.1), ArrowDown: () => rotate(0, 0.1),
    '+': () => zoom(1.15), '-': () => zoom(1 / 1.15), ' ': () => play(!state.playing),
  };
  canvas.addEventListener('keydown', event => {
    if (!keys[event.key] || (event.key === ' ' && at('play').disabled)) return;
    event.preventDefault();
    keys[event.key]();
  });

  function resize() {
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const [w, h] = [canvas.clientWidth, canvas.clientHeight].map(v => Math.max(1, Math.round(v * ratio)));
    if (canvas.width === w && canvas.height === h) return;
    canvas.width = w;
    canvas.height = h;
    picture.frame();
  }
  choose(data.first);
  scale();
  play(state.playing);
  new ResizeObserver(resize).observe(canvas);
  new IntersectionObserver(([entry]) => { visible = entry.isIntersecting; redraw(); }).observe(canvas);
  addEventListener('beforeprint', () => { resize(); picture.frame(); });
})();
