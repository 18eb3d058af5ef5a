// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The recording as one HTML file that plays by itself: pixels of the drawn points of every method,
// the loop gap over time, and a player of some lines. It asks nobody for anything.

const MOST_NUMBERS = 240000; // about 1.5 MB of text
const MOST_FRAMES = 600;

/** Text inside a script or an element. @param {string} text */
const escaped = (text) =>
  text.replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c] ?? c);

/** Frames that are kept, evenly over the recording. @param {number} count @param {number} most */
export function pickFrames(count, most) {
  const n = Math.max(1, Math.min(count, most));
  return Array.from({ length: n }, (_, i) => Math.round((i * (count - 1)) / Math.max(1, n - 1)));
}

/**
 * Returns where words change: [index, words] of the first and of every one that differs from that
 * before.
 * @param {string[]} words @returns {[number, string][]}
 */
export const changesOf = (words) =>
  words.flatMap((text, i) => (text === words[i - 1] ? [] : [[i, text]]));

/** Runs in the file. It stands alone: nothing of the page is there. */
const PLAYER = `
const svg = document.querySelector("svg.drawing"), NS = "http://www.w3.org/2000/svg";
const make = (name, to, attributes) => {
  const node = to.appendChild(document.createElementNS(NS, name));
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  return node;
};
const at = (row, i) => [row[2 * i] / 10, row[2 * i + 1] / 10];
const zigzag = (a, b, r) => {
  const dx = b[0] - a[0], dy = b[1] - a[1], l = Math.hypot(dx, dy) || 1, n = [-dy / l, dx / l];
  let d = "M" + a;
  for (let i = 1; i < 12; i++) {
    const s = i / 12, w = i === 1 || i === 11 ? 0 : i % 2 ? r : -r;
    d += "L" + [a[0] + s * dx + w * n[0], a[1] + s * dy + w * n[1]];
  }
  return d + "L" + b;
};
const groups = film.methods.map((method, m) => {
  const g = make("g", svg, { opacity: m ? 0.6 : 1 });
  const nodes = film.shapes.map((shape) => {
    const solid = shape.kind === "bar" || shape.kind === "polygon" || shape.kind === "slider";
    const look = shape.kind === "pivot" || shape.kind === "ground"
      ? { fill: "Canvas", "stroke-width": 1.6 }
      : { "stroke-width": 2, "fill-opacity": solid && !m ? 0.3 : 0, fill: method.colour, "stroke-dasharray": m ? method.dash : "" };
    return make("path", g, { stroke: method.colour, fill: "none", "stroke-linejoin": "round", ...look });
  });
  svg.prepend(g);
  return { g, nodes };
});
const outline = (shape, row) => {
  const a = at(row, shape.p), b = shape.q < 0 ? a : at(row, shape.q), r = shape.r;
  if (a.some(isNaN) || b.some(isNaN)) return "";
  if (shape.kind === "polygon") {
    return "M" + Array.from({ length: shape.n }, (_, i) => at(row, shape.p + i)).join("L") + "Z";
  }
  if (shape.kind === "spring" || shape.kind === "damper") return zigzag(a, b, r + 2);
  if (shape.kind === "slider") {
    const t = Math.atan2(b[1] - a[1], b[0] - a[0]), c = Math.cos(t), s = Math.sin(t);
    const w = 1.5 * r + 6, h = r + 4;
    return "M" + [[-w, -h], [w, -h], [w, h], [-w, h]]
      .map(([x, y]) => [a[0] + x * c - y * s, a[1] + x * s + y * c]).join("L") + "Z";
  }
  if (shape.kind === "bar") {
    const t = Math.atan2(b[1] - a[1], b[0] - a[0]), x = r * Math.sin(t), y = -r * Math.cos(t);
    const round = "A" + r + " " + r + " 0 0 1 ";
    return "M" + [a[0] + x, a[1] + y] + "L" + [b[0] + x, b[1] + y] + round + [b[0] - x, b[1] - y] +
      "L" + [a[0] - x, a[1] - y] + round + [a[0] + x, a[1] + y] + "Z";
  }
  if (shape.kind === "pivot" || shape.kind === "ground") {
    const k = Math.max(2.5, 0.55 * r);
    return "M" + (a[0] - k) + " " + a[1] + "a" + k + " " + k + " 0 1 0 " + 2 * k + " 0a" + k + " " + k + " 0 1 0 " + -2 * k + " 0";
  }
  return "M" + a + "L" + b;
};
const plot = document.querySelector("svg.gap"), W = 640, H = 180;
const end = film.t[film.t.length - 1] || 1;
const low = -17, high = Math.max(-3, ...film.gap.flat().filter((x) => x !== null));
const px = (t) => 40 + (W - 50) * t / end, py = (g) => 8 + (H - 28) * (high - g) / (high - low);
const put = (x, y, anchor, words) => {
  make("text", plot, { x, y, "text-anchor": anchor, "font-size": 11, fill: "currentColor" }).textContent = words;
};
for (let d = Math.ceil(low); d <= high; d += 4) {
  make("path", plot, { d: "M40 " + py(d) + "H" + (W - 10), stroke: "currentColor", opacity: 0.15 });
  put(34, py(d) + 4, "end", "10" + [..."" + d].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join(""));
}
const span = 10 ** Math.floor(Math.log10(end));
const every = [0.2, 0.5, 1, 2].find((k) => end / (k * span) <= 6) * span;
for (let k = 0; k * every <= end * (1 + 1e-9); k++) {
  const t = Number((k * every).toPrecision(6));
  make("path", plot, { d: "M" + px(t) + " " + (H - 20) + "v4", stroke: "currentColor" });
  put(px(t), H - 5, "middle", t + (k === 0 ? " s" : ""));
}
film.gap.forEach((row, m) => {
  let d = "";
  row.forEach((g, i) => { d += g === null ? "" : (d ? "L" : "M") + px(film.t[i]).toFixed(1) + " " + py(Math.max(low, g)).toFixed(1); });
  make("path", plot, { d, fill: "none", stroke: film.methods[m].colour, "stroke-width": 1.8, "stroke-dasharray": film.methods[m].dash });
});
const cursor = make("path", plot, { stroke: "currentColor" });
const words = document.querySelectorAll(".said");
const slider = document.querySelector("input[type=range]"), clock = document.querySelector("output");
slider.max = film.t.length - 1;
let now = 0, playing = false, began = 0, from = 0;
const draw = (i) => {
  now = i;
  slider.value = i;
  clock.textContent = "t = " + film.t[i].toFixed(2) + " s";
  groups.forEach(({ nodes }, m) => nodes.forEach((node, k) => node.setAttribute("d", outline(film.shapes[k], film.points[m][i]))));
  film.methods.forEach(({ said }, m) => {
    const last = said.filter(([from]) => from <= i).pop();
    words[m].textContent = last ? last[1] : "";
  });
  cursor.setAttribute("d", "M" + px(film.t[i]) + " 8V" + (H - 20));
};
const button = document.querySelector("button");
const tick = (time) => {
  if (!playing) return;
  began = began || time;
  const t = from + (time - began) / 1000;
  let i = now;
  while (i < film.t.length - 1 && film.t[i + 1] <= t) i++;
  draw(i);
  if (i === film.t.length - 1) toggle(); else requestAnimationFrame(tick);
};
const toggle = () => {
  playing = !playing;
  button.textContent = playing ? "Pause" : "Play";
  if (playing) {
    if (now === film.t.length - 1) draw(0);
    began = 0;
    from = film.t[now];
    requestAnimationFrame(tick);
  }
};
button.onclick = toggle;
slider.oninput = () => { if (playing) toggle(); draw(Number(slider.value)); };
document.querySelectorAll("input[type=checkbox]").forEach((box, m) => {
  box.onchange = () => { groups[m].g.style.display = box.checked ? "" : "none"; };
});
draw(0);
`;

const STYLE = `:root{color-scheme:light dark}body{margin:0 auto;padding:16px;max-width:960px;font:15px/1.45 system-ui,sans-serif}
h1{font-size:20px;margin:0 0 4px}p{margin:0 0 8px}
svg{display:block;width:100%;height:auto}.drawing{max-height:42vh}.gap{max-height:24vh}
.row{display:flex;gap:12px;align-items:center;margin:8px 0}.row input[type=range]{flex:1}
button{min-width:88px;min-height:36px;font:inherit}ul{list-style:none;margin:8px 0;padding:0}
li{display:flex;gap:8px;align-items:center}li .line{flex:none;width:36px;height:4px}
output{min-width:90px;font-variant-numeric:tabular-nums}.fixed path{fill:none;stroke:GrayText;stroke-width:1.4}`;

/**
 * @param {import("./store.js").Data} data
 * @param {{
 *   size: {width: number, height: number},
 *   point: (points: ArrayLike<number>, i: number) => [number, number],
 *   radius: (shape: import("./types.js").Shape) => number, fixed: string[],
 *   verdictAt: (m: number, i: number) => string,
 * }} drawing fixed: outlines of what never moves; verdictAt: of a method at a kept frame
 */
export function toReplay(data, { size, point, radius, fixed, verdictAt }) {
  const { scene, history, methods, look, view } = data;
  const order = methods
    .map((_, m) => m)
    .sort((a, b) => Number(b === view.selected) - Number(a === view.selected));
  const perFrame = methods.length * (2 * history.nPoints + 1);
  const frames = pickFrames(history.count, Math.min(MOST_FRAMES, MOST_NUMBERS / perFrame));
  const tenth = (x) => (Number.isFinite(x) ? Math.round(10 * x) : null);
  const film = {
    t: frames.map((i) => Number(history.t[i].toPrecision(6))),
    shapes: scene.drawing.shapes
      .filter(({ kind }) => kind !== "trace" && kind !== "guide")
      .map(({ kind, p, q, n, ...shape }) => ({
        kind,
        p,
        q: kind === "polygon" ? -1 : q,
        n,
        r: Number(radius({ kind, p, q, n, ...shape }).toFixed(1)),
      })),
    methods: order.map((m) => ({
      label: methods[m].label,
      colour: look.slots[methods[m].slot].light,
      dash: look.slots[methods[m].slot].dash.join(" "),
      said: changesOf(frames.map((i) => verdictAt(m, i))),
    })),
    points: order.map((m) =>
      frames.map((i) => {
        const points = history.pointsAt(m, i);
        return Array.from({ length: history.nPoints }, (_, k) =>
          point(points, k).map(tenth),
        ).flat();
      }),
    ),
    gap: order.map((m) =>
      frames.map((i) => {
        const gap = history.columns[m].gap[i];
        return gap > 0 ? Number(Math.log10(gap).toFixed(2)) : null;
      }),
    ),
  };
  const script = JSON.stringify(film).replaceAll("<", "\\u003c");
  const rows = order.map(
    (m, k) =>
      `<li><input type="checkbox" id="m${k}" checked><svg class="line" viewBox="0 0 36 4" aria-hidden="true"><path d="M0 2H36" stroke="${film.methods[k].colour}" stroke-width="3" stroke-dasharray="${film.methods[k].dash}"/></svg>` +
      `<label for="m${k}">${escaped(methods[m].label)}: <span class="said"></span> <code>${escaped(methods[m].spelling)}</code></label></li>`,
  );
  const settings = Object.entries(data.settings).map(([name, value]) => `${name} = ${value}`);
  const every =
    frames.length < history.count ? `, ${frames.length} of ${history.count} frames` : "";
  return `<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escaped(scene.title)}</title><style>${STYLE}</style></head><body>
<h1>${escaped(scene.title)}</h1>
<p>${escaped([scene.caption, ...settings].join(", "))}</p>
<svg class="drawing" viewBox="0 0 ${size.width} ${size.height}" role="img" aria-label="${escaped(scene.title).replaceAll('"', "&quot;")}"><g class="fixed">${fixed.map((d) => `<path d="${d}"/>`).join("")}</g></svg>
<div class="row"><button type="button" autofocus>Play</button><input type="range" min="0" value="0" aria-label="Time"><output></output></div>
<ul>${rows.join("")}</ul>
<p>Loop gap over time, m. The state at the time shown stands beside each method.</p>
<svg class="gap" viewBox="0 0 640 180" role="img" aria-label="Loop gap over time, logarithmic"></svg>
<p><small>Recorded by holonom ${escaped(data.build)}${every}. This file needs no server.</small></p>
<script>const film = ${script};${PLAYER}</script></body></html>
`;
}
