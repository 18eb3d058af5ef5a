// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The recording as text: CSV and NDJSON, one row per kept frame and method, numbers with 17 digits.
import { COLUMNS } from "./history.js";

/** Numbers as they are; what is not finite is left empty. @param {number} value */
const number = (value) => (Number.isFinite(value) ? value : null);

/** Names of the columns after "t" and "method". @param {import("./store.js").Data} data */
export function columnNames({ scene }) {
  return [
    ...scene.coordinates.map(({ name }) => name),
    ...scene.coordinates.map(({ rate }) => rate),
    ...COLUMNS,
  ];
}

/**
 * One row per frame and method, in the order of time.
 * @param {import("./store.js").Data} data
 * @returns {{t: number, method: string, values: (number | null)[]}[]}
 */
export function rowsOf({ history, methods }) {
  return Array.from({ length: history.count }, (_, i) =>
    methods.flatMap(({ spelling }, m) => {
      if (history.ended[m] < history.t[i]) {
        return []; // it has stopped: there is nothing to report of this time
      }
      const { q, v } = history.stateAt(m, i);
      const values = [...q, ...v, ...COLUMNS.map((name) => history.columns[m][name][i])];
      return [{ t: history.t[i], method: spelling, values: values.map(number) }];
    }),
  ).flat();
}

/** @param {string} text */
const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** @param {import("./store.js").Data} data */
export function toCsv(data) {
  const head = ["t", "method", ...columnNames(data)].map(quoted).join(",");
  const lines = rowsOf(data).map(({ t, method, values }) =>
    [t, quoted(method), ...values.map((value) => value ?? "")].join(","),
  );
  return `${[head, ...lines].join("\n")}\n`;
}

/** @param {import("./store.js").Data} data */
export function toNdjson(data) {
  const names = columnNames(data);
  const lines = rowsOf(data).map(({ t, method, values }) =>
    JSON.stringify({
      t,
      method,
      ...Object.fromEntries(names.map((name, k) => [name, values[k]])),
    }),
  );
  return `${lines.join("\n")}\n`;
}
