// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LINALG_COMPRESSED_H
#define HN_LINALG_COMPRESSED_H
// A sparse matrix in compressed columns, filled entry by entry in a sequence that seldom changes:
// the first time the places are sorted, after that each value goes straight to its place.

#include "base/arena.h"
#include "base/status.h"

#include <stdbool.h>

typedef struct hn_compressed {
    int n_max, entries_max;
    int n;            ///< size of the matrix
    int *start, *row; ///< column j holds the rows row[start[j]] .. row[start[j + 1] - 1], rising
    // the sequence of puts
    int n_puts, n_known,
        n_sorted; // of this filling, of the sequence that is sorted, and the size of its matrix
    int changed;  // this filling differs from that sequence
    int *put_row, *put_col, *place;
    double *value; // two for each put
    int *next, *by_row;
} hn_compressed;

/// Matrices up to n_max with up to entries_max puts. Returns false when memory is out.
HN_MUST_CHECK bool hn_compressed_init(hn_compressed *c, hn_arena *arena, int n_max,
                                      int entries_max);
void hn_compressed_begin(hn_compressed *c, int n);
void hn_compressed_put(hn_compressed *c, int row, int col, double re, double im);
/// Sums what was put into `values` (`parts` for each of start[n] places: re, or re and im). Returns
/// Returns whether the places are those of the last time; false when they are new. Allocates
/// nothing.
bool hn_compressed_end(hn_compressed *c, int parts, double *values);
/// Copies the real parts of the entries put so far, as n x n row-major.
void hn_compressed_copy(const hn_compressed *c, double *out);

#endif
