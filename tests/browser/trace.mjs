// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the browser's own trace of a page.

/**
 * Computing time of the main thread of the page in a trace [ms]: other programs on the machine do
 * not lengthen it. The trace holds tasks where its category "toplevel" was asked for; without them
 * the time is 0.
 * @param {{name: string, pid: number, tid: number, args: object, tdur?: number}[]} events
 */
export function mainThreadTime(events) {
  const mains = new Set(
    events
      .filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain")
      .map(({ pid, tid }) => `${pid} ${tid}`),
  );
  return events
    .filter(({ name, pid, tid }) => name === "RunTask" && mains.has(`${pid} ${tid}`))
    .reduce((sum, { tdur = 0 }) => sum + tdur / 1000, 0);
}
