// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A mechanism in space, drawn by WebGL under the drawing's SVG: light, ground, shadows, solids,
// joints with their axes, paths as tubes. Names, arrows and cut joints stay in the SVG.
import * as THREE from "three";
import { coincide } from "../../state/between.js";
import { referenceAt } from "../../state/reference.js";
import { firstSpace } from "../../state/shown.js";
import { h } from "../../widgets/dom.js";
import { boxOf } from "./box.js";
import { makeFloor } from "./floor.js";
import { makeBase, makeModel, makeReference, release, widthOf } from "./models.js";
import { createPace } from "./pace.js";
import { createRig } from "./rig.js";
import { createTools } from "./tools.js";
import { createTrail } from "./trail.js";

const MOST_PIXELS = 2; // of the canvas per pixel of the page
const SETTLED = 300; // [ms] after a movement of the view
const INSIDE = 0.04; // of half a bar's width: so near, a slimmer solid is hidden in a thicker one
const NEAR = 0.02; // of the distance
const FAR = 12;

/** Names under which browsers draw without a graphics card. */
const BY_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Is everything drawn by the processor? Then smooth edges and shadows cost more than they show. */
function drawsBySoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info && gl ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return BY_SOFTWARE.test(String(name));
}

/** @param {boolean} coarse without smooth edges and shadows */
function makeRenderer(coarse) {
  const renderer = new THREE.WebGLRenderer({ antialias: !coarse, alpha: true });
  renderer.shadowMap.enabled = !coarse;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  return renderer;
}

/** @param {string} name of a custom property of the page */
const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/**
 * @param {HTMLElement} frame the drawing's stage; its SVG lies on top
 * @param {import("../../state/store.js").Store} store
 * @param {import("../../session/session.js").Session} actions
 * @param {{size: {width: number, height: number}, refit: () => void}} drawing
 *   refit: the SVG is drawn again by the camera of now
 */
export function createSpace(frame, store, actions, drawing) {
  const data = store.data;
  const pace = createPace(drawsBySoftware());
  const renderer = makeRenderer(pace.coarse);
  const rig = createRig(data, drawing.size);
  const world = new THREE.Scene();
  const cameras = {
    near: new THREE.PerspectiveCamera(),
    flat: new THREE.OrthographicCamera(),
  };
  const canvas = renderer.domElement;
  canvas.setAttribute("aria-hidden", "true");
  const place = h("div", { class: "space" }, canvas);
  frame.prepend(place);

  /** near: [m] what is no farther from the selected method is hidden inside it
   * @type {{ghosts: any[], reference: any, base: any, floor: any, trails: any[], near: number}
   *   | null} */
  let made = null;
  let frames = false;
  let settled = 0;
  /** what this view itself has put into the store @type {any} */
  let told = null;
  let seen = data.view.look;
  let lost = false;
  const tools = createTools(frame, rig, data, actions, {
    refit: moved,
    frames: () => frames,
    showFrames,
  });

  function clear() {
    if (made) {
      made.trails.forEach(({ node }) => release(node));
      [...made.ghosts, made.reference].forEach(({ group }) => release(group));
      [made.base, made.floor.group].forEach(release);
      made.floor.sun.shadow.map?.dispose();
      made = null;
    }
  }

  /** All solids of the scene, in the colours of now. */
  function make() {
    clear();
    const scene = data.scene;
    if (!scene?.view?.spatial || !data.methods.length) {
      return;
    }
    const dark = data.theme === "dark";
    const colours = { ink: colourOf("--ink"), pale: colourOf(dark ? "--edge" : "--paper") };
    const { coarse } = pace;
    const look = { line: colourOf("--hairline"), dark, shadows: !coarse };
    const floor = makeFloor(boxOf(scene), look);
    const base = makeBase(scene, floor, colourOf("--edge"), coarse);
    const ghosts = data.methods.map(({ slot }, m) =>
      makeModel(scene, {
        ...colours,
        colour: data.look.slots[slot][data.theme],
        selected: m === data.view.selected,
        coarse,
      }),
    );
    const reference = makeReference(scene, colourOf("--reference"), coarse);
    const traced = scene.drawing.shapes.filter(({ kind }) => kind === "trace");
    const which = (traced.length ? traced : scene.drawing.tears).map(({ p }) => p);
    const { slot } = data.methods[data.view.selected];
    const trails = which.map((p) => ({
      p,
      ...createTrail(
        0.45 * widthOf(scene),
        new THREE.MeshLambertMaterial({ color: data.look.slots[slot][data.theme] }),
      ),
    }));
    world.add(
      floor.group,
      base,
      reference.group,
      ...ghosts.map(({ group }) => group),
      ...trails.map(({ node }) => node),
    );
    const widths = scene.drawing.shapes.map((shape) => widthOf(scene, shape));
    const near = INSIDE * Math.min(...widths, widthOf(scene));
    made = { ghosts, reference, base, floor, trails, near };
    showFrames(frames);
  }

  /** @param {boolean} on */
  function showFrames(on) {
    frames = on;
    made?.ghosts.forEach((ghost) => ghost.showFrames(on));
    changed();
  }

  /** The view is another one. */
  function changed() {
    drawing.refit();
  }

  /** A person has moved the view: a link holds it, once it stands. */
  function keepView() {
    clearTimeout(settled);
    const { scene } = data;
    settled = window.setTimeout(() => {
      if (data.scene?.id === scene?.id) {
        told = { ...rig.own, frames };
        actions.setView({ space: told });
      }
    }, SETTLED);
  }

  function moved() {
    changed();
    keepView();
  }

  /** The view that a link asks for. */
  function obey() {
    const { space, look } = data.view;
    const turned = look !== seen;
    seen = look;
    if (made && space !== told) {
      told = space;
      clearTimeout(settled);
      rig.setOwn(space ?? firstSpace());
      frames = (space ?? firstSpace()).frames;
      made.ghosts.forEach((ghost) => ghost.showFrames(frames));
      tools.update();
      changed();
    } else if (made && turned && look) {
      rig.hold(); // turned by hand: what is seen stays at its size
      keepView();
    }
  }

  function setCamera() {
    const { width, height } = drawing.size;
    const aspect = width / Math.max(1, height);
    const far = rig.distance();
    const half = rig.halfHeight();
    const toward = rig.toward();
    const camera = rig.perspective ? cameras.near : cameras.flat;
    const look = rig.camera().look;
    camera.up.fromArray(look.up);
    camera.position.set(...rig.target.map((x, k) => x + far * toward[k]));
    camera.lookAt(...rig.target);
    camera.near = rig.perspective ? NEAR * far : -FAR * far;
    camera.far = FAR * far + (made ? 8 * boxOf(data.scene).radius : 0);
    Object.assign(
      camera,
      rig.perspective
        ? { fov: (360 / Math.PI) * rig.HALF_ANGLE, aspect }
        : { left: -half * aspect, right: half * aspect, top: half, bottom: -half },
    );
    camera.updateProjectionMatrix();
    return camera;
  }

  const moves = () => data.state === "running" || data.view.replaying;

  const finest = () => Math.min(MOST_PIXELS, devicePixelRatio);

  /** @param {number} ratio pixels of the canvas per pixel of the page */
  function setPixels(ratio) {
    if (renderer.getPixelRatio() !== ratio) {
      renderer.setPixelRatio(ratio);
    }
  }

  /** Pictures that come late are made coarser. */
  function keepPace() {
    const { coarse } = pace;
    pace.drawn(moves(), performance.now());
    if (pace.coarse !== coarse) {
      renderer.shadowMap.enabled = false;
      make();
    }
  }

  /** @param {number} now index of the frame shown */
  function drawTrails(now) {
    const { history, view } = data;
    const m = view.selected;
    for (const { p, node, draw } of made?.trails ?? []) {
      node.visible = view.traces;
      if (view.traces) {
        const key = `${data.run} ${m} ${history.stride}`;
        draw(key, history.count, now, (i) => history.pointsAt(m, i).subarray(3 * p, 3 * p + 3));
      }
    }
  }

  /** @param {number} now index of the frame shown */
  function drawReference(now) {
    const points = data.view.reference
      ? referenceAt(data.reference, data.history.frameAt(now))
      : null;
    if (made) {
      made.reference.group.visible = points !== null && !isInside(points, now);
      if (points) {
        made.reference.place(points);
      }
    }
  }

  /** Is it hidden inside the selected method, which is the thickest? @param {number} now */
  function isInside(points, now) {
    const { history, view } = data;
    return (
      made !== null &&
      !view.hidden.has(view.selected) &&
      coincide(points, history.pointsAt(view.selected, now), made.near)
    );
  }

  /** @param {number} now place among the kept frames */
  function drawGhosts(now) {
    const { history, view } = data;
    made?.ghosts.forEach((ghost, m) => {
      const points = history.pointsAt(m, now);
      const covered = m !== view.selected && isInside(points, now);
      ghost.group.visible = !view.hidden.has(m) && !covered;
      if (ghost.group.visible) {
        ghost.place(points, history.coordinatesAt(m, now));
      }
    });
  }

  /** @param {number} now index of the frame shown */
  function render(now) {
    drawGhosts(now);
    drawReference(now);
    drawTrails(now);
    renderer.render(world, setCamera());
  }

  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    lost = true;
    frame.classList.remove("solid");
    changed();
  });
  canvas.addEventListener("webglcontextrestored", () => {
    lost = false;
    make();
    changed();
  });

  return {
    make,
    rig,
    /** Whether the scene is drawn here, and the SVG leaves it out. */
    get shows() {
      return made !== null && !lost && Boolean(data.scene?.view?.spatial);
    },
    fit: rig.fitOnce,
    camera: rig.camera,
    resize() {
      const { width, height } = drawing.size;
      setPixels(pace.ratio(moves(), finest()));
      renderer.setSize(width, height);
    },
    /**
     * The solids of now with so many pixels per pixel of the page, as a picture of their own.
     * @param {number} now index of the frame shown @param {number} scale
     */
    picture(now, scale) {
      const copy = document.createElement("canvas");
      setPixels(scale);
      render(now);
      copy.width = canvas.width;
      copy.height = canvas.height;
      copy.getContext("2d")?.drawImage(canvas, 0, 0); // what WebGL drew is gone after this task
      this.draw(now);
      return copy;
    },
    show(on) {
      place.hidden = !on;
      tools.show(on);
    },
    /** @param {number} now index of the frame shown */
    follow(now) {
      obey();
      if (made) {
        const { scene, history, view } = data;
        const points = history.pointsAt(view.selected, now);
        const traced = scene.drawing.shapes.find(({ kind }) => kind === "trace");
        const p = traced?.p ?? scene.drawing.tears[0]?.p ?? 0;
        rig.track([...points.slice(3 * p, 3 * p + 3)]);
      }
    },
    /** @param {number} now index of the frame shown */
    draw(now) {
      if (made && !lost) {
        setPixels(pace.ratio(moves(), finest()));
        render(now);
        keepPace();
      }
    },
    dispose() {
      clearTimeout(settled);
      clear();
      tools.dispose();
      renderer.dispose();
      place.remove();
    },
  };
}

/** @typedef {ReturnType<typeof createSpace>} Space */
