// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The one place that speaks to the server: requests, and problem documents turned into errors.

/** The API lies beside this folder, also where the page is served below a prefix. */
export const BASE = new URL("v1", import.meta.url).pathname;

/** An address that the server names, below the same prefix. @param {string} path /api/v1/... */
export const addressOf = (path) => path.replace(/^\/api\/v1(?=\/)/, BASE);

/** A refusal of the server, with the fields at fault. */
export class Problem extends Error {
  /**
   * @param {number} status HTTP status, 0 when the server did not answer
   * @param {{title?: string, detail?: string, errors?: {detail: string, pointer?: string, hint?:
   *   string}[]}} body
   */
  constructor(status, body) {
    super(body.detail || body.title || `the server answered ${status}`);
    this.status = status;
    this.errors = Array.isArray(body.errors) ? body.errors : [];
  }

  /** The first sentence about a field, with its hint; the general detail when no field is named. */
  get sentence() {
    const first = this.errors[0];
    if (!first) {
      return this.message;
    }
    return first.hint ? `${first.detail} (${first.hint})` : first.detail;
  }
}

/** Returns what to tell of whatever was thrown. @param {unknown} error */
export function sentenceOf(error) {
  return error instanceof Problem
    ? error.sentence
    : String(error instanceof Error ? error.message : error);
}

/**
 * @param {string} method
 * @param {string} path
 * @param {unknown} [body]
 * @returns {Promise<any>}
 */
export async function request(method, path, body) {
  /** @type {RequestInit} */
  const init = { method, headers: { Accept: "application/json" } };
  if (body !== undefined) {
    init.headers = { Accept: "application/json", "Content-Type": "application/json" };
    init.body = JSON.stringify(body);
  }
  let response;
  try {
    response = await fetch(path, init);
  } catch {
    throw new Problem(0, { detail: "the server does not answer" });
  }
  if (response.status === 204) {
    return null;
  }
  const text = await response.text();
  let json;
  try {
    json = JSON.parse(text);
  } catch {
    throw new Problem(response.status, {
      detail: `the server's answer is not JSON (${response.status})`,
    });
  }
  if (!response.ok) {
    throw new Problem(response.status, json);
  }
  return json;
}

/** The API, one function per resource that the page uses. */
export const api = {
  index: () => request("GET", `${BASE}/`),
  scenes: () => request("GET", `${BASE}/scenes`),
  methods: () => request("GET", `${BASE}/methods`),
  lessons: () => request("GET", `${BASE}/lessons`),
  look: () => request("GET", `${BASE}/look`),
  /** @param {string} id */
  scene: (id) => request("GET", `${BASE}/scenes/${id}`),
  /**
   * @param {string} id
   * @param {Record<string, number>} settings
   * @param {number} every [s]
   * @param {boolean} compute
   */
  reference: (id, settings, every, compute) => {
    const query = new URLSearchParams({ every: String(every) });
    Object.entries(settings).forEach(([name, value]) => query.append("set", `${name}:${value}`));
    if (compute) {
      query.set("compute", "true");
    }
    return request("GET", `${BASE}/scenes/${id}/reference?${query}`);
  },
  /** @param {string | object} scene @param {Record<string, number>} settings */
  equations: (scene, settings) =>
    request("POST", `${BASE}/equations`, { scene, parameters: settings, format: "json" }),
  /** @param {object} body */
  terms: (body) => request("POST", `${BASE}/terms`, body),
  /** The start with closed loops, and the drawn points there. @param {object} body */
  assemble: (body) => request("POST", `${BASE}/assemble`, body),
  /** The closed configuration that brings a point or coordinate nearest. @param {object} body */
  drag: (body) => request("POST", `${BASE}/drag`, body),
  /** Ids of the comparisons that the server has. */
  comparisonIds: () => request("GET", `${BASE}/comparisons`).then((list) => list.comparisons),
  /** @param {object} body */
  createComparison: (body) => request("POST", `${BASE}/comparisons`, body),
  /** @param {string} id */
  comparison: (id) => request("GET", `${BASE}/comparisons/${id}`),
  /** @param {string} id @param {object} change */
  changeComparison: (id, change) => request("PATCH", `${BASE}/comparisons/${id}`, change),
  /** Returns the pulls of a hand so far. @param {string} id */
  pulls: (id) => request("GET", `${BASE}/comparisons/${id}/pulls`),
  /** @param {string} id */
  deleteComparison: (id) => request("DELETE", `${BASE}/comparisons/${id}`),
  /** The page is going away: no answer is waited for. @param {string} id */
  abandonComparison: (id) =>
    fetch(`${BASE}/comparisons/${id}`, { method: "DELETE", keepalive: true }).catch(() => null),
  /** @param {object} body */
  createStudy: (body) => request("POST", `${BASE}/studies`, body),
  /** @param {string} id */
  study: (id) => request("GET", `${BASE}/studies/${id}`),
  /** @param {string} id */
  stopStudy: (id) => request("PATCH", `${BASE}/studies/${id}`, { state: "stopped" }),
  /** Computes the rest of it, with a time limit of its own. @param {string} id */
  resumeStudy: (id) => request("PATCH", `${BASE}/studies/${id}`, { state: "running" }),
  /** Nobody waits for it any more. @param {string} id */
  abandonStudy: (id) =>
    fetch(`${BASE}/studies/${id}`, { method: "DELETE", keepalive: true }).catch(() => null),
  /** @param {string} id @param {string} lastId */
  eventsAddress: (id, lastId) => {
    const query = new URLSearchParams({ fields: "sigma_min,lambda,condition" });
    if (lastId) {
      query.set("last_event_id", lastId);
    }
    return `${BASE}/comparisons/${id}/events?${query}`;
  },
};
