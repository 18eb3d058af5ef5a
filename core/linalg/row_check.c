// SPDX-License-Identifier: GPL-3.0-or-later
#include "linalg/row_check.h"

#include "linalg/gram.h"
#include "linalg/newton_matrix.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

struct hn_row_check {
    int nc, nv, n_entries;
    const int *row, *col;
    double *entry, *size;
    hn_gram *gram;
    double ops;
};

hn_status hn_row_check_create(hn_arena *arena, int nc, int nv, int n_entries, const int *row,
                              const int *col, hn_row_check **out) {
    *out = NULL;
    if (!hn_newton_matrix_wants_sparse(nc + nv, 2LL * n_entries)) {
        return HN_OK;
    }

    hn_row_check *c = hn_arena_get(arena, sizeof *c);
    if (!c) {
        return HN_ERR_MEMORY;
    }
    *c = (hn_row_check){.nc = nc, .nv = nv, .n_entries = n_entries, .row = row, .col = col};
    c->entry = hn_arena_doubles(arena, (size_t)n_entries);
    c->size = hn_arena_doubles(arena, (size_t)nc);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_gram_create(arena, nc, nv, n_entries, row, col, &c->gram));
    *out = c->gram ? c : NULL;
    return HN_OK;
}

/// The entries in c->entry, row by row to length 1.
static bool check_entries(hn_row_check *c) {
    memset(c->size, 0, (size_t)c->nc * sizeof *c->size);
    for (int k = 0; k < c->n_entries; k++) {
        c->size[c->row[k]] += c->entry[k] * c->entry[k];
    }
    for (int i = 0; i < c->nc; i++) {
        c->size[i] = c->size[i] > 0 ? 1 / sqrt(c->size[i]) : 0;
    }
    for (int k = 0; k < c->n_entries; k++) {
        c->entry[k] *= c->size[c->row[k]];
    }
    hn_gram_fill(c->gram, c->entry);
    c->ops += 3.0 * c->n_entries + 2.0 * c->nc + hn_gram_factor_ops(c->gram);
    return hn_gram_factor(c->gram, 0, HN_ROW_CHECK_DISTANCE * HN_ROW_CHECK_DISTANCE) == HN_OK;
}

bool hn_row_check_run(hn_row_check *c, const double *J, const double *unit) {
    for (int k = 0; k < c->n_entries; k++) {
        c->entry[k] =
            J[(size_t)c->row[k] * (size_t)c->nv + (size_t)c->col[k]] * (unit ? unit[c->col[k]] : 1);
    }
    return check_entries(c);
}

bool hn_row_check_run_list(hn_row_check *c, const double *list, const double *unit) {
    for (int k = 0; k < c->n_entries; k++) {
        c->entry[k] = list[k] * (unit ? unit[c->col[k]] : 1);
    }
    return check_entries(c);
}

double hn_row_check_ops(const hn_row_check *c) {
    return c->ops;
}
