// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Requests of views that are opened: scene files, import, programs, lessons, exercises.
import { BASE, Problem, request } from "./client.js";

/**
 * An answer that is text.
 * @param {string} path
 * @param {RequestInit} [init]
 */
async function text(path, init) {
  const response = await fetch(path, init).catch(() => {
    throw new Problem(0, { detail: "the server does not answer" });
  });
  const body = await response.text();
  if (!response.ok) {
    throw new Problem(response.status, JSON.parse(body));
  }
  return body;
}

export const documents = {
  /** The file of a shipped scene, as it was written. @param {string} id */
  scene: (id) => text(`${BASE}/scenes/${id}/document`),
  /** The JSON schema of scene files. */
  schema: () => request("GET", `${BASE}/schema`),
  /**
   * A model of another program as a scene.
   * @param {string} model XML
   * @param {string} name of the scene
   * @param {string} [loops] the loop file of a model
   * @returns {Promise<{format: string, document: string, notes: {outcome: string, line: number,
   *   where: string, what: string}[]}>}
   */
  importModel: (model, name, loops) =>
    request("POST", `${BASE}/import`, { text: model, name, loops }),
  /**
   * @returns {Promise<{languages: {name: string, suffix: string, about: string,
   *   solvers: {name: string, about: string}[]}[]}>}
   */
  languages: () => request("GET", `${BASE}/languages`),
  /** A program that runs a scene by itself, or its model in a format. @param {object} body */
  program: (body) =>
    text(`${BASE}/export`, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    }),
  /** One lesson as a tree of blocks. @param {string} id */
  lesson: (id) => request("GET", `${BASE}/lessons/${id}`),
  /** @param {string} id @param {string} src as the lesson names it */
  pictureAddress: (id, src) => `${BASE}/lessons/${id}/${src}`,
  /** All exercises in short. @returns {Promise<{problems: {id: string, title: string}[]}>} */
  problems: () => request("GET", `${BASE}/problems`),
  /** @param {string} id */
  problem: (id) => request("GET", `${BASE}/problems/${id}`),
  /** @param {string} id @param {number} number from 1 @returns {Promise<{text: string}>} */
  hint: (id, number) => request("GET", `${BASE}/problems/${id}?hint=${number}`),
  /** @param {string} problem @param {unknown} submission */
  grade: (problem, submission) => request("POST", `${BASE}/grade`, { problem, submission }),
};
