// SPDX-License-Identifier: GPL-3.0-or-later
// Starts the real server and a real browser, and keeps what a page must not do: errors on its
// console, requests to other hosts.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import net from "node:net";
import { after, before } from "node:test";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const ROOT = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const PROGRAM = join(ROOT, process.env.HOLONOM || "build/holonom");
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
/**
 * [ms] How long a test waits for what must come: a bound on what never comes, no guess about how
 * fast a machine is. A test that holds does not wait for it.
 */
export const PATIENCE = 120000;
const FLAGS = [
  "--headless",
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** A port that was free a moment ago. */
function freePort() {
  return new Promise((resolve, reject) => {
    const probe = net.createServer();
    probe.on("error", reject);
    probe.listen(0, "127.0.0.1", () => {
      const { port } = probe.address();
      probe.close(() => resolve(port));
    });
  });
}

/** @param {string[]} options of `holonom serve` */
export async function startServer(options = []) {
  assert.ok(existsSync(PROGRAM), `${PROGRAM} is built`);
  const child = spawn(PROGRAM, ["serve", "--port", String(await freePort()), ...options], {
    cwd: ROOT,
    stdio: ["ignore", "pipe", "pipe"],
  });
  let text = "";
  const url = await new Promise((resolve, reject) => {
    const timer = setTimeout(() => {
      child.kill("SIGKILL"); // or the program of the tests would wait for it
      reject(new Error(`no address within ${PATIENCE} ms: ${text}`));
    }, PATIENCE);
    const read = (chunk) => {
      text += chunk;
      const address =
        /http:\/\/127\.0\.0\.1:\d+\//.exec(text) ?? /http:\/\/localhost:\d+\//.exec(text);
      if (address) {
        clearTimeout(timer);
        resolve(address[0]);
      }
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("exit", (code) => reject(new Error(`the server ended with ${code}: ${text}`)));
  });
  let stopped = false;
  /** Returns how it ended although nobody asked it to; "" while it serves. */
  const ended = () => {
    const how = child.signalCode ?? child.exitCode;
    return stopped || how === null ? "" : `the server ended with ${how}: ${text.slice(-2000)}`;
  };
  const stop = () => {
    stopped = true;
    return end(child);
  };
  return { url, port: Number(new URL(url).port), id: child.pid, stop, ended };
}

/**
 * Asks a process to end, and waits until it has.
 * @param {import("node:child_process").ChildProcess} child
 */
export function end(child) {
  return new Promise((resolve) => {
    if (child.exitCode !== null || child.signalCode !== null) {
      resolve(child.exitCode);
      return;
    }
    child.removeAllListeners("exit");
    child.on("exit", resolve);
    child.kill("SIGTERM");
  });
}

/** @param {string[]} [more] flags of the browser */
export async function startBrowser(more = []) {
  assert.ok(existsSync(CHROMIUM), `${CHROMIUM} is installed`);
  return chromium.launch({ executablePath: CHROMIUM, args: [...FLAGS, ...more] });
}

/** Returns what the page must not do, noted while it lives. @returns {string[]} */
function watch(page, host) {
  const faults = [];
  page.on("console", (message) => {
    // the browser itself reports each refused request; refusals are part of some tests and shown by
    // the page
    if (message.type() === "error" && !/Failed to load resource/.test(message.text())) {
      faults.push(`console: ${message.text()}`);
    }
  });
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("request", (request) => {
    const target = new URL(request.url());
    if (target.protocol !== "data:" && target.host !== host) {
      faults.push(`request to ${target.host}`);
    }
  });
  page.on("response", (response) => {
    if (response.status() === 404) {
      faults.push(`not found: ${response.url()}`);
    }
  });
  return faults;
}

/**
 * Returns the value of a promise, or an error where it does not come: a page that computes without
 * end answers nothing, and would stop all tests of its file.
 * @template T @param {Promise<T>} promise @param {string} what @returns {Promise<T>}
 */
async function within(promise, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what} within ${PATIENCE} ms`)), PATIENCE);
  });
  try {
    return await Promise.race([promise, late]);
  } finally {
    clearTimeout(timer);
  }
}

/**
 * The things that a file of tests drives: a server and a browser, from before its first test until
 * after its last. Where a test is the end of one of them, that test fails and the next one gets
 * another. A page, and a line, live as long as the test that opened them; pages with the same
 * options share what the browser keeps of the files it loaded, unless they ask to be `fresh`.
 */
export function createBench() {
  let server;
  let browser;
  /** by their options @type {Map<string, Promise<any>>} */
  const homes = new Map();
  const faultsOf = new WeakMap();

  before(async () => {
    // where one of them fails, the other is there to be ended
    const started = await Promise.allSettled([startServer(), startBrowser()]);
    [server, browser] = started.map((one) => one.value);
    const failed = started.find(({ status }) => status === "rejected");
    if (failed) {
      throw failed.reason;
    }
  });
  after(async () => {
    await browser?.close();
    await server?.stop();
  });

  /** Server and browser again, where a test before was the end of them. */
  async function revive() {
    if (server.ended()) {
      server = await startServer();
    }
    if (!browser.isConnected()) {
      browser = await startBrowser();
      homes.clear();
    }
  }

  function homeOf(fresh, options) {
    const make = async () => {
      const home = await browser.newContext({
        viewport: { width: 1280, height: 900 },
        reducedMotion: "no-preference",
        ...options,
      });
      home.setDefaultTimeout(PATIENCE);
      return home;
    };
    const key = JSON.stringify(options);
    if (!fresh && !homes.has(key)) {
      homes.set(key, make());
    }
    return fresh ? make() : homes.get(key);
  }

  return {
    /** Address of the server. */
    get url() {
      return server.url;
    },
    /** Id of the server's process. */
    get serverId() {
      return server.id;
    },
    /** Faults of a page so far; what is taken out of the list is forgiven. */
    faultsOf: (page) => faultsOf.get(page),
    /**
     * Opens the page and waits until it can be used. The test fails if the page does what it must
     * not.
     * @param {import("node:test").TestContext} t
     * @param {{url?: string, hash?: string, wait?: boolean, init?: () => void, fresh?: boolean,
     *   keep?: boolean}} [options] and those of a browser's context; keep: what other pages stored
     */
    async open(t, options = {}) {
      await revive();
      const {
        url = server.url,
        hash = "",
        wait = true,
        init,
        fresh = false,
        keep = false,
        ...context
      } = options;
      const serves = server;
      const home = await homeOf(fresh, context);
      const page = await home.newPage();
      const faults = watch(page, new URL(url).host);
      faultsOf.set(page, faults);
      t.after(async () => {
        try {
          if (context.javaScriptEnabled !== false) {
            const cleared = page.evaluate(
              () => location.protocol === "about:" || localStorage.clear(),
            );
            await within(cleared, "the page did not answer");
          }
        } finally {
          await (fresh ? home : page).close();
        }
        assert.equal(serves.ended(), "");
        assert.deepEqual(faults, []);
      });
      if (!keep) {
        await page.addInitScript(forgetOthers);
      }
      if (init) {
        await page.addInitScript(init);
      }
      await page.goto(`${url}${hash}`);
      if (wait) {
        await page.waitForFunction(
          () => document.querySelector("main")?.getAttribute("aria-busy") === "false",
        );
        await page.waitForFunction(() => globalThis.holonom?.data.history?.count > 0);
      }
      return page;
    },
    /**
     * A line to the server; a page comes over it by its `url`.
     * @param {import("node:test").TestContext} t
     */
    async line(t) {
      await revive();
      const line = await startLine(server.port);
      t.after(() => line.close());
      return line;
    },
    /**
     * A server of the test's own, that it may end.
     * @param {import("node:test").TestContext} t
     * @param {string[]} [options] of `holonom serve`
     */
    async server(t, options) {
      const own = await startServer(options);
      t.after(() => own.stop());
      return own;
    },
  };
}

/** In the page, when it is first loaded: other pages have stored nothing. */
function forgetOthers() {
  if (location.protocol !== "about:" && !sessionStorage.getItem("loaded")) {
    localStorage.clear();
    sessionStorage.setItem("loaded", "yes");
  }
}

/** A look at the page's data, by a function that gets it. */
export function read(page, pick) {
  return within(page.evaluate(`(${pick})(globalThis.holonom.data)`), "the page did not answer");
}

/**
 * Waits until the data fulfil a condition; asked from here, since the page forbids text as script.
 */
export async function until(page, condition, timeout = PATIENCE) {
  const end = Date.now() + timeout;
  while (!(await read(page, condition))) {
    assert.ok(
      Date.now() < end,
      `within ${timeout} ms: ${condition}; notice: ${await read(page, (data) => data.notice)}`,
    );
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}

/**
 * Waits until a check holds: what the page shows follows an action in its own time. The last
 * failure is thrown when time is up.
 * @param {() => Promise<unknown>} check throws while it does not hold
 */
export async function soon(check, timeout = PATIENCE) {
  const end = Date.now() + timeout;
  for (;;) {
    try {
      await check();
      return;
    } catch (error) {
      if (Date.now() > end) {
        throw error;
      }
    }
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}

/**
 * Returns where an element is on the screen: one that is drawn anew has no place for a moment.
 * @param {import("playwright-core").Locator} locator
 */
export async function screenBox(locator) {
  /** @type {{x: number, y: number, width: number, height: number} | null} */
  let place = null;
  await soon(async () => assert.ok((place = await locator.boundingBox())));
  return place;
}

/** Until no colour fades into another one any more. */
export function settled(page) {
  return page.evaluate(() => {
    const fading = document.getAnimations().filter((change) => change instanceof CSSTransition);
    return Promise.allSettled(fading.map((change) => change.finished)).then(() => undefined);
  });
}

/** Until what was told is drawn as well. */
export function drawn(page) {
  return page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
}

/** Returns where a joint is on the screen: the pin nearest to its name. */
export async function jointAt(page, name) {
  await drawn(page);
  return page.evaluate((wanted) => {
    const svg = document.querySelector(".picture").getBoundingClientRect();
    const texts = [...document.querySelectorAll(".picture .labels text")];
    const label = texts.find(({ textContent }) => textContent === wanted);
    const near = [Number(label.getAttribute("x")), Number(label.getAttribute("y"))];
    const pins = document.querySelector(".ghosts .ghost.selected .pins").getAttribute("d");
    const places = [...pins.matchAll(/M([-\d.]+) ([-\d.]+)a([\d.]+)/g)].map(([, x, y, r]) => [
      Number(x) + Number(r),
      Number(y),
    ]);
    const distance = ([x, y]) => Math.hypot(x - near[0], y - near[1]);
    const [x, y] = places.reduce((a, b) => (distance(b) < distance(a) ? b : a));
    return { x: svg.left + x, y: svg.top + y };
  }, name);
}

/**
 * Waits until the runs stand, and the last frame that the server made is here and drawn: frames may
 * come after the answer.
 */
export async function stood(page) {
  await until(page, (data) => data.state !== "running");
  const id = await read(page, (data) => data.id);
  const answer = await fetch(new URL(`/api/v1/comparisons/${id}`, page.url()));
  const { frame } = await answer.json();
  await until(page, `(data) => data.latest?.frame === ${frame}`);
  await drawn(page);
}

/**
 * Computes to the first frame after a time and stands there, as by pressing the right arrow: the
 * same frame on every machine, however busy.
 * @param {number} t [s]
 */
export async function playTo(page, t) {
  const { id, frame, dt } = await read(page, (data) => ({
    id: data.id,
    frame: data.latest?.frame ?? 0,
    dt: data.frameDt,
  }));
  const step = Math.floor(t / dt + 1e-9) + 1 - frame;
  const answer = await fetch(new URL(`/api/v1/comparisons/${id}`, page.url()), {
    method: "PATCH",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ step }),
  });
  assert.equal(answer.status, 200, `a step of ${step} frames`);
  await stood(page);
}

/** Plays to a time at least, as a person sees it, and stands. @param {number} t [s] */
export async function watchTo(page, t) {
  await page.keyboard.press("Space");
  await until(page, `(data) => data.latest?.t > ${t}`);
  await page.keyboard.press("Space");
  await stood(page);
}

/** The greatest speed; then Play has the focus. */
export async function fastest(page) {
  for (let k = 0; k < 9 && (await read(page, (data) => data.speed)) < 10; k++) {
    const before = await read(page, (data) => data.speed);
    await page.getByRole("button", { name: /^Faster/ }).click();
    await until(page, `(data) => data.speed > ${before}`);
  }
  await page.focus("#play");
}

/**
 * A picture of the page for whoever wants to look; of all of it unless only the window is `seen`.
 */
export async function screenshot(page, name, { seen = false } = {}) {
  const folder = join(ROOT, "build/screenshots");
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`), fullPage: !seen });
}

/** A request for the events of a comparison. */
const ASKS_EVENTS = /^GET \S+\/events[? ]/m;

/**
 * A line between page and server. Cut, what connects through it loses its connection, and gets none
 * until it is mended.
 * Held, the events of comparisons wait, and answers to all else overtake them, until they are let
 * go.
 */
async function startLine(first) {
  let port = first;
  const open = new Set();
  let cut = false;
  let held = false;
  /** events that wait @type {(() => void)[]} */
  let waiting = [];
  const line = net.createServer((client) => {
    if (cut) {
      client.destroy();
      return;
    }
    const server = net.connect(port, "127.0.0.1");
    let events = false;
    for (const socket of [client, server]) {
      open.add(socket);
      socket.on("error", () => socket.destroy());
      socket.on("close", () => {
        open.delete(socket);
        client.destroy();
        server.destroy();
      });
    }
    client.on("data", (chunk) => {
      events ||= ASKS_EVENTS.test(chunk.toString("latin1"));
      server.write(chunk);
    });
    server.on("data", (chunk) => {
      const pass = () => client.destroyed || client.write(chunk);
      if (held && events) {
        waiting.push(pass);
      } else {
        pass();
      }
    });
  });
  await new Promise((resolve) => line.listen(0, "127.0.0.1", resolve));
  return {
    url: `http://127.0.0.1:${line.address().port}/`,
    cut() {
      cut = true;
      open.forEach((socket) => socket.destroy());
    },
    /** @param {number} [to] port of another server */
    mend(to = port) {
      port = to;
      cut = false;
    },
    hold() {
      held = true;
    },
    letGo() {
      held = false;
      waiting.forEach((pass) => pass());
      waiting = [];
    },
    close() {
      open.forEach((socket) => socket.destroy());
      return new Promise((resolve) => line.close(resolve));
    },
  };
}
