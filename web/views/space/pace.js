// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// How fine pictures in space are where they come late: without shadows and smooth edges first, then
// with fewer pixels while the mechanism moves. What stands still has all of its pixels.

const LATE = 1000 / 32; // [ms] a picture, on average: below 30 a second it is seen to jump
const COUNTED = 20; // pictures of an average
const REST = 500; // [ms] without a picture: what comes after it is another movement
const PIXELS = [1, 0.75, 0.5]; // of the canvas per pixel of the page, coarser and coarser

/** @param {boolean} coarse whether shadows and smooth edges are left out from the start */
export function createPace(coarse) {
  let last = -Infinity; // [ms] the picture before
  let sum = 0; // [ms] since the average began
  let count = 0;
  let step = 0; // among PIXELS

  const begin = () => {
    sum = 0;
    count = 0;
  };

  function goCoarser() {
    if (!coarse) {
      coarse = true;
    } else {
      step = Math.min(step + 1, PIXELS.length - 1);
    }
  }

  return {
    get coarse() {
      return coarse;
    },
    /** Pixels of the canvas per pixel of the page. @param {boolean} moves @param {number} fine */
    ratio: (moves, fine) => (!coarse ? fine : PIXELS[moves ? step : 0]),
    /**
     * A picture was drawn. Another movement begins a step finer: what kept the machine busy may
     * have ended.
     * @param {boolean} moves @param {number} now [ms]
     */
    drawn(moves, now) {
      const since = now - last;
      last = now;
      if (!moves || since > REST) {
        step = since > REST ? Math.max(0, step - 1) : step;
        begin();
        return;
      }
      sum += since;
      count++;
      if (count === COUNTED) {
        if (sum > LATE * COUNTED) {
          goCoarser();
        }
        begin();
      }
    },
  };
}
