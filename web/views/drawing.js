// @ts-check
// The mechanism: supports once, one ghost per method, the selected method opaque and on top.
import { lookOf } from "../state/look.js";
import { listen } from "../state/store.js";
import { quantity } from "../state/format.js";
import { describeDrawing } from "../state/words.js";
import { boxAround, createCamera, seenBox } from "../widgets/camera.js";
import { h, s, say, set } from "../widgets/dom.js";
import * as shapes from "../widgets/shapes.js";

const TRACE_POINTS = 600;
const CROWDED = 60; // shapes
const OUTLINES = ["bar", "slider", "polygon"]; // filled; the other kinds are lines
const LINES = ["spring", "damper", "arrow", "guide"];

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../state/session.js").Session} actions
 */
export function createDrawing(el, store, actions) {
  const data = store.data;
  const layers = Object.fromEntries(
    ["fixed", "traces", "ghosts", "tears", "labels", "scale"].map((name) => [
      name,
      s("g", { class: name }),
    ]),
  );
  const svg = s(
    "svg",
    { role: "img", "aria-labelledby": "drawing-title", tabindex: "-1", class: "picture" },
    ...Object.values(layers),
  );
  const title = h("p", { id: "drawing-title", class: "hidden" });
  const spoken = h("p", { class: "spoken", role: "status" });
  const banner = h("div", { class: "banner", role: "alert", hidden: true });
  const caption = h("p", { class: "caption" });
  const labels = toggle("labels", "labels", true);
  const traces = toggle("traces", "paths", false);
  const describe = h(
    "button",
    { type: "button", class: "quiet", onclick: tellDrawing },
    "describe",
  );
  const stage = h("div", { class: "stage" }, svg, banner);
  el.replaceChildren(
    stage,
    title,
    h("div", { class: "under" }, caption, h("div", { class: "choices" }, labels, traces, describe)),
    spoken,
  );

  /** @type {{group: any, fill: any, pins: any, lines: any}[]} */
  let ghosts = [];
  let camera = createCamera([-1, -1, 1, 1], 100, 100);
  let size = { width: 0, height: 0 };

  function toggle(key, word, on) {
    return h(
      "button",
      {
        type: "button",
        class: "quiet",
        "aria-pressed": String(on),
        onclick: (event) => {
          const pressed = event.currentTarget.getAttribute("aria-pressed") !== "true";
          event.currentTarget.setAttribute("aria-pressed", String(pressed));
          actions.setView({ [key]: pressed });
        },
      },
      word,
    );
  }

  function shown() {
    const count = data.history?.count ?? 0;
    return data.view.shown < 0 ? count - 1 : Math.min(data.view.shown, count - 1);
  }

  function tellDrawing() {
    const sentence = describeDrawing(data, shown());
    say(spoken, sentence);
    say(title, sentence);
  }

  // ---- once per scene and size -----------------------------------------------------------------------------------

  /** A long chain is drawn with thinner bars and without rings at its cuts. */
  const crowded = () => data.scene.drawing.shapes.length > CROWDED;

  function radius(shape) {
    const width = shape.width > 0 ? shape.width : 0.045 * data.scene.length;
    return Math.min(11, Math.max(crowded() ? 1.5 : 4.5, 0.5 * width * camera.scale));
  }

  /** Drawn once: what stands on the ground. @param {import("../state/store.js").Shape} shape */
  const isFixed = ({ kind, body }) => kind === "ground" || (kind === "guide" && body < 0);

  /** The guide reaches across the view. @returns {[[number, number], [number, number]]} */
  function guideEnds(p, q) {
    const dx = q[0] - p[0];
    const dy = q[1] - p[1];
    const length = Math.hypot(dx, dy) || 1;
    const reach = (component, low, high, from) =>
      Math.abs(component) < 1e-9
        ? [-Infinity, Infinity]
        : [(low - from) / component, (high - from) / component].sort((a, b) => a - b);
    const [ax, bx] = reach(dx / length, 12, size.width - 12, p[0]);
    const [ay, by] = reach(dy / length, 12, size.height - 12, p[1]);
    const [a, b] = [Math.max(ax, ay), Math.min(bx, by)];
    const place = (along) =>
      /** @type {[number, number]} */ ([
        p[0] + (along * dx) / length,
        p[1] + (along * dy) / length,
      ]);
    return [place(a), place(b)];
  }

  function drawFixed(points) {
    const place = (i) => camera.point(points, i);
    layers.fixed.replaceChildren(
      ...data.scene.drawing.shapes.filter(isFixed).map((shape) => {
        const p = place(shape.p);
        if (shape.kind === "ground") {
          return s("path", { d: shapes.ground(p, crowded() ? 4 : 11), class: "ground" });
        }
        const [from, to] = guideEnds(p, place(shape.q));
        return s("path", { d: shapes.guide(from, to, radius(shape) + 5), class: "guide" });
      }),
    );
  }

  function drawScale() {
    const { pixels, metres } = camera.scaleBar;
    const x = 20;
    const y = size.height - 16;
    layers.scale.replaceChildren(
      s("path", { d: `M${x} ${y - 5}V${y}H${(x + pixels).toFixed(2)}V${y - 5}` }),
      s("text", { x: x + pixels / 2, y: y - 7, "text-anchor": "middle" }, quantity(metres, "m", 1)),
    );
  }

  function fit() {
    size = { width: svg.clientWidth, height: svg.clientHeight };
    set(svg, { viewBox: `0 0 ${size.width || 100} ${size.height || 100}` });
    if (!data.scene) {
      return;
    }
    const from = lookOf(data);
    const box = data.scene.extremes
      ? seenBox(data.scene.extremes, from)
      : boxAround(data.scene.envelope, data.scene.points);
    camera = createCamera(box, size.width, size.height, from);
    drawFixed(data.scene.points);
    drawScale();
    update();
  }

  function makeGhosts() {
    ghosts = data.methods.map((method) => {
      const fill = s("path", { class: "outline" });
      const lines = s("path", { class: "lines" });
      const pins = s("path", { class: "pins" });
      const group = s("g", { class: `ghost slot-${method.slot}` }, fill, lines, pins);
      const dash = data.look.slots[method.slot].dash;
      if (dash.length) {
        set(fill, { "stroke-dasharray": dash.join(" ") });
      }
      return { group, fill, pins, lines };
    });
    say(caption, data.scene?.caption ?? "");
    arrange();
  }

  function arrange() {
    const order = data.methods
      .map((_, m) => m)
      .filter((m) => m !== data.view.selected && !data.view.hidden.has(m));
    if (!data.view.hidden.has(data.view.selected)) {
      order.push(data.view.selected);
    }
    layers.ghosts.replaceChildren(...order.map((m) => ghosts[m]?.group).filter(Boolean));
    ghosts.forEach(({ group }, m) => group.classList.toggle("selected", m === data.view.selected));
    update();
  }

  // ---- every frame -----------------------------------------------------------------------------------------------

  /** @param {ArrayLike<number>} points @param {string[]} kinds */
  function pathOf(points, kinds) {
    const place = (i) => camera.point(points, i);
    let d = "";
    for (const shape of data.scene.drawing.shapes) {
      if (
        !kinds.includes(shape.kind) ||
        (shape.kind === "guide" && isFixed(shape)) ||
        Number.isNaN(points[3 * shape.p])
      ) {
        continue;
      }
      d += outlineOf(shape, place);
    }
    return d;
  }

  function outlineOf(shape, place) {
    const p = place(shape.p);
    const r = radius(shape);
    const q = shape.q >= 0 && shape.kind !== "polygon" ? place(shape.q) : p;
    switch (shape.kind) {
      case "bar":
        return shapes.bar(p, q, r);
      case "slider":
        return shapes.slider(p, q, r + 4);
      case "polygon":
        return shapes.polyline(
          Array.from({ length: shape.n }, (_, i) => place(shape.p + i)),
          true,
        );
      case "pivot":
      case "ground":
        return shapes.circle(p, Math.max(crowded() ? 1 : 2.5, 0.55 * r));
      case "spring":
        return shapes.spring(p, q, r + 2);
      case "guide":
        return shapes.guide(...guideEnds(p, q), r + 5);
      case "damper":
        return shapes.damper(p, q, r + 1);
      case "arrow":
        return shapes.load(p, 1.5 * r);
      default:
        return "";
    }
  }

  function drawTears(points) {
    const d = data.scene.drawing.tears
      .map(({ p, q }) => [camera.point(points, p), camera.point(points, q)])
      .filter(([[x]]) => Number.isFinite(x))
      .map(([a, b]) => `${shapes.polyline([a, b], false)}`)
      .join("");
    const rings = (crowded() ? [] : data.scene.drawing.tears)
      .map(({ p, q }) => [camera.point(points, p), camera.point(points, q)])
      .filter(([[x]]) => Number.isFinite(x))
      .map(([a, b]) => shapes.circle([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], 14))
      .join("");
    layers.tears.replaceChildren(
      s("path", { d, class: "tear" }),
      s("path", { d: rings, class: "cut" }),
    );
  }

  function drawLabels(points) {
    const taken = [];
    const nodes = [];
    data.scene.drawing.labels.forEach((label, i) => {
      const [x, y] = camera.point(points, i);
      if (!label || !Number.isFinite(x) || taken.some(([u, v]) => Math.hypot(u - x, v - y) < 16)) {
        return;
      }
      taken.push([x, y]);
      nodes.push(s("text", { x: (x + 12).toFixed(1), y: (y - 12).toFixed(1) }, label));
    });
    layers.labels.replaceChildren(...nodes);
  }

  function drawTraces(now) {
    if (!data.view.traces) {
      layers.traces.replaceChildren();
      return;
    }
    const m = data.view.selected;
    const step = Math.max(1, Math.ceil(now / TRACE_POINTS));
    const traced = data.scene.drawing.shapes
      .filter(({ kind }) => kind === "trace")
      .map(({ p }) => p);
    const which = traced.length ? traced : data.scene.drawing.tears.map(({ p }) => p);
    layers.traces.replaceChildren(
      ...which.map((p) => {
        const points = [];
        for (let i = 0; i <= now; i += step) {
          points.push(camera.point(data.history.pointsAt(m, i), p));
        }
        return s("path", {
          d: shapes.polyline(
            points.filter(([x]) => Number.isFinite(x)),
            false,
          ),
          class: `trace slot-${data.methods[m].slot}`,
        });
      }),
    );
  }

  function tellFailures(now) {
    const lines = data.methods.flatMap((method, m) => {
      const end = data.history.ended[m];
      const reason = data.latest?.methods[m]?.reason;
      return end <= data.history.t[now]
        ? [`${method.label} stopped at ${end.toFixed(3)} s${reason ? `: ${reason}` : ""}`]
        : [];
    });
    banner.hidden = lines.length === 0;
    if (lines.join("\n") !== banner.dataset.text) {
      banner.dataset.text = lines.join("\n");
      banner.replaceChildren(...lines.map((line) => h("p", {}, line)));
    }
  }

  function update() {
    const now = shown();
    if (!data.scene || !data.history || now < 0 || ghosts.length !== data.methods.length) {
      return;
    }
    ghosts.forEach(({ group, fill, pins, lines }, m) => {
      if (!group.parentNode) {
        return;
      }
      const points = data.history.pointsAt(m, now);
      set(fill, { d: pathOf(points, OUTLINES) });
      set(lines, { d: pathOf(points, LINES) });
      set(pins, { d: pathOf(points, ["pivot", "ground"]) });
      group.classList.toggle("ended", data.history.ended[m] <= data.history.t[now]);
    });
    const points = data.history.pointsAt(data.view.selected, now);
    drawTears(points);
    layers.labels.style.display = data.view.labels ? "" : "none";
    if (data.view.labels) {
      drawLabels(points);
    }
    drawTraces(now);
    tellFailures(now);
  }

  const observer = new ResizeObserver(fit);
  observer.observe(stage);
  const stop = listen(store, {
    scene: () => {
      fit();
      title.textContent = data.scene?.title ?? "";
      spoken.textContent = "";
    },
    methods: makeGhosts,
    view: () => {
      if (camera.look !== lookOf(data)) {
        fit();
      }
      arrange();
    },
    state: () => {
      if (data.state !== "running") {
        say(title, describeDrawing(data, shown()));
      }
    },
  });

  return {
    update,
    dispose() {
      stop();
      observer.disconnect();
      el.replaceChildren();
    },
  };
}
