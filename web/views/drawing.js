// @ts-check
// The mechanism: supports once, one ghost per method, the selected method opaque and on top.
import { lookOf } from "../state/look.js";
import { referenceAt } from "../state/reference.js";
import { arrowScale, sizeOf, zeroOf } from "../state/reactions.js";
import { listen } from "../state/store.js";
import { quantity } from "../state/format.js";
import { describeDrawing, predictionAt } from "../state/words.js";
import { boxAround, createCamera, seenBox } from "../widgets/camera.js";
import { h, s, say, set } from "../widgets/dom.js";
import { createNamePlaces } from "../widgets/name-places.js";
import { baseOf, createPen, isCrowded, piecesOf } from "../widgets/pieces.js";
import * as shapes from "../widgets/shapes.js";

const TRACE_POINTS = 600;
const SHORTEST_ARROW = 3; // [px]

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../state/session.js").Session} actions
 */
export function createDrawing(el, store, actions) {
  const data = store.data;
  const layers = Object.fromEntries(
    ["fixed", "traces", "truth", "ghosts", "tears", "arrows", "labels", "scale"].map((name) => [
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
  const ahead = h("p", { class: "ahead", hidden: true });
  const caption = h("p", { class: "caption" });
  const labels = toggle("labels", "labels");
  const traces = toggle("traces", "paths");
  const reference = toggle("reference", "reference");
  const describe = h(
    "button",
    { type: "button", class: "quiet", onclick: tellDrawing },
    "describe",
  );
  const stage = h("div", { class: "stage" }, svg, ahead, banner);
  el.replaceChildren(
    stage,
    title,
    h("div", { class: "under" }, caption, h("div", { class: "choices" }, labels, traces, reference, describe)),
    spoken,
  );

  /** @type {ReturnType<typeof makeGhost>[]} */
  let ghosts = [];
  /** @type {(ReturnType<typeof piecesOf>[number] & {path: SVGElement})[]} */
  let truth = [];
  let drawnFor = ""; // which methods are drawn, and which of them opaque
  const viewKey = () => JSON.stringify([data.view.selected, ...data.view.hidden]);
  let camera = createCamera([-1, -1, 1, 1], 100, 100);
  /** @type {ReturnType<typeof createPen>} */
  let pen;
  let newton = 1; // [px]
  let places = createNamePlaces({ width: 100, height: 100 });
  let size = { width: 0, height: 0 };

  function toggle(key, word) {
    return h(
      "button",
      {
        type: "button",
        class: "quiet",
        "aria-pressed": String(data.view[key]),
        onclick: () => actions.setView({ [key]: !data.view[key] }),
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

  function drawFixed(points) {
    const { solid, marks } = baseOf(data.scene);
    layers.fixed.replaceChildren(
      ...marks.map((shape) => s("path", { d: pen.mark(shape, points), class: shape.kind })),
      s("path", { d: solid.map((shape) => pen.outline(shape, points)).join(""), class: "base" }),
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
    pen = createPen(data.scene, camera, size);
    places = createNamePlaces(size);
    drawFixed(data.scene.points);
    drawScale();
    update();
  }

  /** The selected method in pieces that cover each other, any other in one path per layer. @param {number} m */
  function makeGhost(m) {
    const method = data.methods[m];
    const selected = m === data.view.selected;
    const inSpace = Boolean(data.scene.view?.spatial);
    const how = !selected || isCrowded(data.scene) ? "together" : inSpace ? "alone" : "bodies";
    const dash = data.look.slots[method.slot].dash.join(" ");
    const pieces = piecesOf(data.scene, how).map((piece) => ({
      ...piece,
      path: s("path", {
        class: piece.layer,
        "stroke-dasharray": (!selected && piece.layer === "outline" && dash) || null,
      }),
    }));
    const group = s(
      "g",
      { class: `ghost slot-${method.slot}${selected ? " selected" : ""}` },
      ...pieces.map(({ path }) => path),
    );
    return { group, pieces, sorted: how === "alone" };
  }

  function makeGhosts() {
    say(caption, data.scene?.caption ?? "");
    caption.title = data.scene?.caption ?? "";
    if (!data.scene) {
      return;
    }
    ghosts = data.methods.map((_, m) => makeGhost(m));
    const order = data.methods
      .map((_, m) => m)
      .filter((m) => m !== data.view.selected && !data.view.hidden.has(m));
    if (!data.view.hidden.has(data.view.selected)) {
      order.push(data.view.selected);
    }
    layers.ghosts.replaceChildren(...order.map((m) => ghosts[m].group));
    drawnFor = viewKey();
    update();
  }

  /** Says what there is, on the button that shows it. */
  function makeReference() {
    const { reference: known, scene } = data;
    const ready = known?.state === "ready";
    truth = (ready && scene ? piecesOf(scene, "together") : []).map((piece) => ({
      ...piece,
      path: s("path", { class: piece.layer }),
    }));
    layers.truth.replaceChildren();
    const digits = ready ? `${known.digits.toFixed(1)} digits to ${known.time} s` : "";
    reference.title = ready
      ? `the reference solution, grey: ${known.means.join(" and ")} agree to ${digits}`
      : (known?.reason ?? "");
    set(reference, { "aria-disabled": ready ? null : "true" });
    update();
  }

  // ---- every frame -----------------------------------------------------------------------------------------------

  /** What lies farther away comes first. */
  function sortPieces(ghost, points) {
    const depths = new Map(ghost.pieces.map((piece) => [piece, pen.depth(piece, points)]));
    const order = [...ghost.pieces].sort((a, b) => depths.get(a) - depths.get(b));
    if (order.some((piece, i) => ghost.group.childNodes[i] !== piece.path)) {
      ghost.group.replaceChildren(...order.map(({ path }) => path));
    }
  }

  function drawGhost(ghost, points) {
    for (const { shapes: drawn, path } of ghost.pieces) {
      set(path, { d: drawn.map((shape) => pen.outline(shape, points)).join("") });
    }
    if (ghost.sorted) {
      sortPieces(ghost, points);
    }
  }

  /** Thin and grey, beneath the methods. @param {number} now */
  function drawReference(now) {
    const points = data.view.reference
      ? referenceAt(data.reference, data.history.frameAt(now))
      : null;
    const pieces = points ? truth : [];
    if (layers.truth.childElementCount !== pieces.length) {
      layers.truth.replaceChildren(...pieces.map(({ path }) => path));
    }
    pieces.forEach(({ shapes: drawn, path }) =>
      set(path, { d: drawn.map((shape) => pen.outline(shape, points)).join("") }),
    );
  }

  function drawTears(points) {
    const d = data.scene.drawing.tears
      .map(({ p, q }) => [camera.point(points, p), camera.point(points, q)])
      .filter(([[x]]) => Number.isFinite(x))
      .map(([a, b]) => `${shapes.polyline([a, b], false)}`)
      .join("");
    const rings = (isCrowded(data.scene) ? [] : data.scene.drawing.tears)
      .map(({ p, q }) => [camera.point(points, p), camera.point(points, q)])
      .filter(([[x]]) => Number.isFinite(x))
      .map(([a, b]) => shapes.circle([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], 14))
      .join("");
    layers.tears.replaceChildren(
      s("path", { d, class: "tear" }),
      s("path", { d: rings, class: "cut" }),
    );
  }

  /** @param {ArrayLike<number>} points @param {number[][]} arrows names keep clear of them too */
  function drawLabels(points, arrows) {
    const names = data.scene.drawing.labels.flatMap((text, i) => {
      const at = camera.point(points, i);
      return text && Number.isFinite(at[0]) ? [{ i, text, at }] : [];
    });
    const placed = places.place(names, names.length ? [...pen.obstacles(points), ...arrows] : []);
    layers.labels.replaceChildren(
      ...placed.map(({ text, x, y }) =>
        s("text", { x: x.toFixed(1), y: (y + 4.5).toFixed(1), "text-anchor": "middle" }, text),
      ),
    );
  }

  /** The force on each joint's child, from the joint outwards; it moves with the joint until the next answer. Returns where arrows are. */
  function drawArrows(points) {
    const { reactions, view, scene } = data;
    if (!view.arrows || !reactions || reactions.method !== view.selected) {
      layers.arrows.replaceChildren();
      return [];
    }
    const zero = zeroOf(reactions.list, scene.length).force;
    const loaded = reactions.list.filter(({ force }) => sizeOf(force) > zero);
    newton = arrowScale(Math.max(0, ...loaded.map(({ force }) => sizeOf(force))), newton);
    const along = (axis, f) => axis[0] * f[0] + axis[1] * f[1] + axis[2] * f[2];
    /** @type {number[][]} */
    const lines = [];
    layers.arrows.replaceChildren(
      ...loaded.flatMap(({ force, place, point }) => {
        const p = point >= 0 ? camera.point(points, point) : camera.point(place, 0);
        const [dx, dy] = [
          newton * along(camera.look.right, force),
          -newton * along(camera.look.up, force),
        ];
        const length = Math.hypot(dx, dy);
        if (length < SHORTEST_ARROW) {
          return [];
        }
        const away = 1 + 16 / length;
        const text = { x: (p[0] + away * dx).toFixed(1), y: (p[1] + away * dy + 4).toFixed(1) };
        lines.push([...p, p[0] + away * dx, p[1] + away * dy, 8]);
        return [
          s("path", { d: shapes.arrow(p, [p[0] + dx, p[1] + dy]) }),
          s("text", { ...text, "text-anchor": "middle" }, quantity(sizeOf(force), "N", 2)),
        ];
      }),
    );
    return lines;
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

  function tellAhead(now) {
    const text = predictionAt(data, now);
    ahead.hidden = text === "";
    say(ahead, text);
  }

  function update() {
    const now = shown();
    if (!data.scene || !data.history || now < 0 || ghosts.length !== data.methods.length) {
      return;
    }
    ghosts.forEach((ghost, m) => {
      if (ghost.group.parentNode) {
        drawGhost(ghost, data.history.pointsAt(m, now));
        ghost.group.classList.toggle("ended", data.history.ended[m] <= data.history.t[now]);
      }
    });
    drawReference(now);
    const points = data.history.pointsAt(data.view.selected, now);
    drawTears(points);
    const arrows = drawArrows(points);
    layers.labels.style.display = data.view.labels ? "" : "none";
    if (data.view.labels) {
      drawLabels(points, arrows);
    }
    drawTraces(now);
    tellAhead(now);
    tellFailures(now);
  }

  const observer = new ResizeObserver(fit);
  observer.observe(stage);
  const stop = listen(store, {
    scene: () => {
      ghosts = []; // of the scene before; the methods follow
      fit();
      title.textContent = data.scene?.title ?? "";
      spoken.textContent = "";
    },
    methods: makeGhosts,
    reactions: update,
    reference: makeReference,
    view: () => {
      set(labels, { "aria-pressed": String(data.view.labels) });
      set(traces, { "aria-pressed": String(data.view.traces) });
      set(reference, { "aria-pressed": String(data.view.reference) });
      if (camera.look !== lookOf(data)) {
        fit();
      }
      if (drawnFor === viewKey()) {
        update();
      } else {
        makeGhosts();
      }
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
