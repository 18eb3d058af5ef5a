// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Files that are dropped on the page.

/** @param {HTMLElement} body @param {(files: File[]) => void} take */
export function acceptFiles(body, take) {
  /** @param {DragEvent} event */
  const holds = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  body.addEventListener("dragover", (event) => {
    if (holds(event)) {
      event.preventDefault();
    }
  });
  body.addEventListener("drop", (event) => {
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length) {
      event.preventDefault();
      take(files);
    }
  });
}
