// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A file that is dropped on the page.

/** @param {HTMLElement} body @param {(file: File) => void} take */
export function acceptFiles(body, take) {
  /** @param {DragEvent} event */
  const holds = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  body.addEventListener("dragover", (event) => {
    if (holds(event)) {
      event.preventDefault();
    }
  });
  body.addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (file) {
      event.preventDefault();
      take(file);
    }
  });
}
