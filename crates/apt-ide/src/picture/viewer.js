"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const canvas = document.getElementById("canvas");
  const pen = canvas.getContext("2d");
  const tip = document.getElementById("tip");
  document.getElementById("title").textContent = data.title;
  document.getElementById("summary").textContent = data.summary;

  const names = document.getElementById("names");
  for (const role of ["part", "drive", "check"]) {
    const list = data.surfaces.filter((s) => s.role === role && s.name).map((s) => s.name);
    if (!list.length) continue;
    const word = document.createElement("b");
    word.className = role;
    word.textContent = role + " surface ";
    names.append(word, list.slice(0, 24).join(", ") + (list.length > 24 ? " …" : "") + "   ");
  }

  // All positions of the path in one array; a stretch is a range of it.
  let total = 0;
  for (const s of data.path) total += s.points.length;
  const world = new Float64Array(3 * total);
  const screen = new Float32Array(2 * total);
  const stretches = [];
  let fill = 0;
  for (const s of data.path) {
    stretches.push({ kind: s.kind, isn: s.isn, first: fill, last: fill + s.points.length - 1 });
    for (const p of s.points) {
      world[3 * fill] = p[0];
      world[3 * fill + 1] = p[1];
      world[3 * fill + 2] = p[2];
      fill += 1;
    }
  }

  const middle = [0, 1, 2].map((i) => (data.low[i] + data.high[i]) / 2);
  const size = Math.hypot(...[0, 1, 2].map((i) => data.high[i] - data.low[i])) || 1;
  const views = {
    iso: [-Math.PI / 4, Math.atan(Math.SQRT1_2)],
    top: [0, Math.PI / 2],
    front: [0, 0],
    right: [-Math.PI / 2, 0],
  };
  // Turn about z, elevation of the eye, scale in pixels per unit, offset of the middle in pixels.
  const eye = { turn: views.iso[0], tilt: views.iso[1], scale: 1, x: 0, y: 0 };
  const shown = { feed: true, rapid: true, start: true, surfaces: true };
  let width = 1, height = 1, hover = null, kept = null, waiting = false;
  // The positions that the tool comes to: a stretch begins where the one before it ended, but for jumps.
  const stops = [];
  for (const s of stretches) {
    const same = s.first > 0 && [0, 1, 2].every((i) => world[3 * s.first + i] === world[3 * s.first - 3 + i]);
    for (let k = same ? s.first + 1 : s.first; k <= s.last; k += 1) stops.push(k);
  }
  // The one that it stands at: the path beyond it is drawn pale. At the last one all of the path is done.
  const lastStop = Math.max(0, stops.length - 1);
  let stop = lastStop;
  const at = () => stops[stop] ?? 0;

  // Rows of the view: what is to the right and what is up.
  function axes() {
    const [s, c, st, ct] = [Math.sin(eye.turn), Math.cos(eye.turn), Math.sin(eye.tilt), Math.cos(eye.tilt)];
    return [[c, -s, 0], [s * st, c * st, ct]];
  }
  function project(p, [r, u]) {
    const d = [p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]];
    return [
      width / 2 + eye.x + eye.scale * (r[0] * d[0] + r[1] * d[1] + r[2] * d[2]),
      height / 2 + eye.y - eye.scale * (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]),
    ];
  }
  function fit() {
    eye.x = eye.y = 0;
    const [r, u] = axes();
    let w = 1e-12 * size, h = 1e-12 * size;
    for (let k = 0; k < 8; k += 1) {
      const d = [0, 1, 2].map((i) => ((k >> i) & 1 ? data.high[i] : data.low[i]) - middle[i]);
      w = Math.max(w, 2 * Math.abs(r[0] * d[0] + r[1] * d[1] + r[2] * d[2]));
      h = Math.max(h, 2 * Math.abs(u[0] * d[0] + u[1] * d[1] + u[2] * d[2]));
    }
    eye.scale = Math.min((width - 60) / w, (height - 70) / h);
    if (!(eye.scale > 0)) eye.scale = 1;
  }
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

  // The path from one position to another.
  function drawPath(from, to) {
    const dashes = { feed: [], rapid: [6, 4], start: [2, 4] };
    for (const kind of ["rapid", "start", "feed"]) {
      if (!shown[kind]) continue;
      pen.beginPath();
      for (const s of stretches) {
        const [begin, end] = [Math.max(s.first, from), Math.min(s.last, to)];
        if (s.kind !== kind || begin >= end) continue;
        let x = screen[2 * begin], y = screen[2 * begin + 1];
        pen.moveTo(x, y);
        for (let k = begin + 1; k <= end; k += 1) {
          const [nx, ny] = [screen[2 * k], screen[2 * k + 1]];
          // Points that cannot be told apart cost nothing.
          if (k < end && Math.abs(nx - x) + Math.abs(ny - y) < 0.6) continue;
          pen.lineTo(nx, ny);
          x = nx;
          y = ny;
        }
      }
      pen.strokeStyle = colour(kind);
      pen.setLineDash(dashes[kind]);
      pen.lineWidth = kind === "feed" ? 1.7 : 1.3;
      pen.stroke();
    }
    pen.setLineDash([]);
  }
  function drawSurfaces(rows) {
    pen.lineWidth = 1;
    pen.globalAlpha = 0.4;
    for (const s of data.surfaces) {
      pen.beginPath();
      for (const line of s.lines) {
        line.forEach((p, k) => {
          const [x, y] = project(p, rows);
          if (k) pen.lineTo(x, y);
          else pen.moveTo(x, y);
        });
      }
      pen.strokeStyle = colour(s.role);
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }
  function drawMarks(rows) {
    const isn = kept ?? hover?.isn;
    if (isn !== undefined && isn !== null) {
      pen.beginPath();
      for (const s of stretches) {
        if (s.isn !== isn || !shown[s.kind]) continue;
        pen.moveTo(screen[2 * s.first], screen[2 * s.first + 1]);
        for (let k = s.first + 1; k <= s.last; k += 1) pen.lineTo(screen[2 * k], screen[2 * k + 1]);
      }
      pen.strokeStyle = colour("mark");
      pen.lineWidth = 3;
      pen.stroke();
    }
    if (total) {
      pen.fillStyle = "#2ea043";
      pen.beginPath();
      pen.arc(screen[0], screen[1], 4.5, 0, 7);
      pen.fill();
      pen.fillStyle = colour("ink");
      pen.fillRect(screen[2 * total - 2] - 4, screen[2 * total - 1] - 4, 8, 8);
      if (stop < lastStop) {
        pen.strokeStyle = colour("mark");
        pen.lineWidth = 3;
        pen.beginPath();
        pen.arc(screen[2 * at()], screen[2 * at() + 1], 6, 0, 7);
        pen.stroke();
      }
    }
    const origin = [46, height - 46];
    pen.font = "600 12px sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineWidth = 1.6;
    ["X", "Y", "Z"].forEach((name, i) => {
      const [x, y] = [rows[0][i], -rows[1][i]];
      pen.strokeStyle = pen.fillStyle = colour("soft");
      pen.beginPath();
      pen.moveTo(...origin);
      pen.lineTo(origin[0] + 28 * x, origin[1] + 28 * y);
      pen.stroke();
      if (Math.hypot(x, y) > 0.1) pen.fillText(name, origin[0] + 39 * x, origin[1] + 39 * y);
    });
    drawScaleBar();
  }
  function drawScaleBar() {
    const least = 70 / eye.scale;
    const power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].find((f) => f * power >= least * (1 - 1e-9)) * power;
    const [x, y, w] = [width - 16, 20, step * eye.scale];
    if (!Number.isFinite(w)) return;
    pen.strokeStyle = pen.fillStyle = colour("soft");
    pen.lineWidth = 1.4;
    pen.beginPath();
    pen.moveTo(x - w, y - 5);
    pen.lineTo(x - w, y);
    pen.lineTo(x, y);
    pen.lineTo(x, y - 5);
    pen.stroke();
    pen.font = "11px sans-serif";
    pen.textAlign = "right";
    pen.fillText(`${Number(step.toPrecision(3))} ${data.units}`.trim(), x - w - 6, y - 2);
  }
  function draw() {
    waiting = false;
    const rows = axes();
    pen.clearRect(0, 0, width, height);
    const [r, u] = rows;
    for (let k = 0; k < total; k += 1) {
      const x = world[3 * k] - middle[0], y = world[3 * k + 1] - middle[1], z = world[3 * k + 2] - middle[2];
      screen[2 * k] = width / 2 + eye.x + eye.scale * (r[0] * x + r[1] * y + r[2] * z);
      screen[2 * k + 1] = height / 2 + eye.y - eye.scale * (u[0] * x + u[1] * y + u[2] * z);
    }
    if (shown.surfaces) drawSurfaces(rows);
    drawPath(0, at());
    if (stop < lastStop) {
      pen.globalAlpha = 0.25;
      drawPath(at(), total - 1);
      pen.globalAlpha = 1;
    }
    drawMarks(rows);
    if (!total) {
      pen.fillStyle = colour("soft");
      pen.font = "15px sans-serif";
      pen.textAlign = "center";
      pen.fillText("no motion", width / 2, height / 2);
    }
  }
  function redraw() {
    if (!waiting) requestAnimationFrame(draw);
    waiting = true;
  }

  // The nearest piece of the path within a few pixels.
  function nearest(x, y) {
    let best = null, least = 8;
    for (const s of stretches) {
      if (!shown[s.kind]) continue;
      for (let k = s.first; k < s.last; k += 1) {
        const [ax, ay] = [screen[2 * k], screen[2 * k + 1]];
        const [dx, dy] = [screen[2 * k + 2] - ax, screen[2 * k + 3] - ay];
        const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
        const d = Math.hypot(x - ax - t * dx, y - ay - t * dy);
        if (d < least) [least, best] = [d, { isn: s.isn, kind: s.kind, index: k }];
      }
    }
    return best;
  }
  function tell(found, x, y) {
    tip.style.display = found ? "block" : "none";
    if (!found) return;
    const p = [0, 1, 2].map((i) => Number(world[3 * (found.index + 1) + i].toFixed(6)));
    const kind = found.kind === "start" ? "start-up" : found.kind;
    tip.textContent = `ISN ${found.isn} · ${kind}\nto ${p.join(", ")}`;
    tip.style.left = Math.min(x + 14, width - tip.offsetWidth - 6) + "px";
    tip.style.top = Math.min(y + 14, height - tip.offsetHeight - 6) + "px";
  }

  // Stepping through the motion: the tool goes to a position, and its statement is kept.
  const slider = document.getElementById("step");
  slider.max = String(lastStop);
  slider.value = slider.max;
  function stretchAt(position) {
    let [low, high] = [0, stretches.length - 1];
    while (low < high) {
      const half = (low + high) >> 1;
      if (stretches[half].last < position) low = half + 1;
      else high = half;
    }
    return stretches[low];
  }
  function standAt(number) {
    if (!total) return;
    stop = Math.max(0, Math.min(lastStop, number));
    slider.value = String(stop);
    const { isn, kind } = stretchAt(at());
    const p = [0, 1, 2].map((i) => Number(world[3 * at() + i].toFixed(6)));
    const manner = kind === "start" ? "start-up" : kind;
    const place = `${stop + 1} of ${lastStop + 1} · ISN ${isn} · ${manner} · ${p.join(", ")}`;
    document.getElementById("at").textContent = place;
    kept = stop < lastStop ? isn : null;
    document.dispatchEvent(new CustomEvent("apt-isn", { detail: kept }));
    redraw();
  }
  slider.addEventListener("input", () => standAt(Number(slider.value)));
  document.getElementById("back").addEventListener("click", () => standAt(stop - 1));
  document.getElementById("forth").addEventListener("click", () => standAt(stop + 1));

  let drag = null;
  canvas.addEventListener("pointerdown", (e) => {
    drag = { x: e.clientX, y: e.clientY, move: e.shiftKey || e.button !== 0, far: 0 };
    canvas.setPointerCapture(e.pointerId);
    canvas.classList.add("busy");
  });
  canvas.addEventListener("pointermove", (e) => {
    if (!drag) {
      const found = nearest(e.offsetX, e.offsetY);
      tell(found, e.offsetX, e.offsetY);
      if (found?.isn !== hover?.isn) {
        hover = found;
        redraw();
      }
      return;
    }
    const [dx, dy] = [e.clientX - drag.x, e.clientY - drag.y];
    [drag.x, drag.y] = [e.clientX, e.clientY];
    drag.far += Math.abs(dx) + Math.abs(dy);
    tell(null);
    if (drag.move) {
      eye.x += dx;
      eye.y += dy;
    } else {
      eye.turn += 0.008 * dx;
      eye.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, eye.tilt + 0.008 * dy));
    }
    redraw();
  });
  canvas.addEventListener("pointerup", (e) => {
    if (drag && drag.far < 4) {
      kept = nearest(e.offsetX, e.offsetY)?.isn ?? null;
      document.dispatchEvent(new CustomEvent("apt-isn", { detail: kept }));
      redraw();
    }
    drag = null;
    canvas.classList.remove("busy");
  });
  canvas.addEventListener("pointercancel", () => (drag = null));
  canvas.addEventListener("pointerleave", () => {
    hover = null;
    tell(null);
    redraw();
  });
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  function zoom(factor, x, y) {
    const [cx, cy] = [x - width / 2 - eye.x, y - height / 2 - eye.y];
    eye.scale *= factor;
    eye.x -= cx * (factor - 1);
    eye.y -= cy * (factor - 1);
    redraw();
  }
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(Math.exp(-0.0015 * Math.max(-300, Math.min(300, e.deltaY))), e.offsetX, e.offsetY);
  }, { passive: false });
  function choose(view) {
    if (views[view]) [eye.turn, eye.tilt] = views[view];
    fit();
    redraw();
  }
  canvas.addEventListener("dblclick", () => choose("fit"));
  canvas.addEventListener("keydown", (e) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[e.key];
    if (turn) {
      eye.turn += turn[0];
      eye.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, eye.tilt + turn[1]));
      redraw();
    } else if (e.key === "+" || e.key === "-") zoom(e.key === "+" ? 1.2 : 1 / 1.2, width / 2, height / 2);
    else if (e.key === "Home") choose("fit");
    else if (e.key === "," || e.key === ".") standAt(stop + (e.key === "." ? 1 : -1));
    else return;
    e.preventDefault();
  });
  for (const b of document.querySelectorAll("[data-view]")) b.addEventListener("click", () => choose(b.dataset.view));
  for (const b of document.querySelectorAll("[data-show]")) {
    b.addEventListener("change", () => {
      shown[b.dataset.show] = b.checked;
      redraw();
    });
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  let first = true;
  new ResizeObserver(() => {
    const box = canvas.getBoundingClientRect();
    const ratio = devicePixelRatio || 1;
    [width, height] = [Math.max(1, box.width), Math.max(1, box.height)];
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (first) fit();
    first = false;
    redraw();
  }).observe(canvas);
})();
