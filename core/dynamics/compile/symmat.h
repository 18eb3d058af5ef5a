// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_SYMMAT_H
#define HN_DYNAMICS_SYMMAT_H
// A sparse symmetric matrix of expressions that fills in while it is eliminated: entries by hash,
// neighbours by list.

#include "expr/graph.h"

#include <stdbool.h>

typedef struct hn_symmat hn_symmat;

hn_symmat *hn_symmat_create(int n); ///< returns owned; NULL when memory is out
/// NULL is legal.
void hn_symmat_free(hn_symmat *m);
bool hn_symmat_failed(const hn_symmat *m); ///< memory ran out on the way
/// Entry (i, j), which is entry (j, i); zero where nothing was set.
hn_ex hn_symmat_get(const hn_symmat *m, int i, int j);
void hn_symmat_set(hn_symmat *m, int i, int j, hn_ex e);
/// Unknowns that share an entry with i (i itself not among them), zero or not; in the order they
/// came.
int hn_symmat_neighbours(const hn_symmat *m, int i, const int **list);
#endif
