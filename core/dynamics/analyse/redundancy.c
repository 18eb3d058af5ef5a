// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/redundancy.h"

#include "dynamics/analyse/singularity_monitor.h"
#include "dynamics/compile/system_impl.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/mass_scales.h"
#include "linalg/dense.h"
#include "linalg/row_check.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// The rest of a row below this part of it is rounding: rows are known to about 1e-14, a
/// combination of tens of them to 1e-12.
static const double FOLLOWS = 1e-9;
/// A row is part of a combination when it brings more than this of its length; also well above
/// rounding.
static const double TAKES_PART = 1e-7;

/// From so many velocities on a sparse check comes first.
enum { LARGE = 100 };

typedef struct basis {
    int n, nc;
    int n_kept;
    int *kept;        ///< rows that follow from no others
    double *row;      ///< n: the present row, then the part of it outside the span of e
    double *length;   ///< nc: of the rows
    double *e;        ///< n_kept x n orthonormal
    double *R;        ///< nc x nc: kept row k = sum R[k][j] e_j, j <= k
    double *combined; ///< nc: the row in terms of e, then of the kept rows
} basis;

static hn_status basis_init(basis *s, const hn_system *sys, hn_arena *arena) {
    const size_t n = (size_t)sys->nv, m = (size_t)sys->nc;
    const size_t most = n < m ? n : m;
    *s = (basis){.n = sys->nv, .nc = sys->nc};
    s->kept = hn_arena_ints(arena, most);
    s->row = hn_arena_doubles(arena, n);
    s->length = hn_arena_doubles(arena, m);
    s->e = hn_arena_doubles(arena, most * n);
    s->R = hn_arena_doubles(arena, most * most);
    s->combined = hn_arena_doubles(arena, most);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

static int most_kept(const basis *s) {
    return s->n < s->nc ? s->n : s->nc;
}

/// Splits s->row into its part along e (s->combined) and the rest, twice: once leaves the rounding
/// of a long row behind.
static void split(basis *s) {
    for (int k = 0; k < s->n_kept; k++) {
        s->combined[k] = 0;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < s->n_kept; k++) {
            const double *e = s->e + (size_t)k * s->n;
            const double part = hn_dot(s->n, e, s->row);
            hn_axpy(s->n, -part, e, s->row);
            s->combined[k] += part;
        }
    }
}

static void keep(basis *s, int row, double left) {
    const int k = s->n_kept++;
    double *e = s->e + (size_t)k * s->n, *R = s->R + (size_t)k * most_kept(s);
    s->kept[k] = row;
    for (int j = 0; j < s->n; j++) {
        e[j] = s->row[j] / left;
    }
    for (int j = 0; j < k; j++) {
        R[j] = s->combined[j];
    }
    R[k] = left;
}

/// s->combined from terms of e to terms of the kept rows.
static void combine_rows(basis *s) {
    for (int k = s->n_kept - 1; k >= 0; k--) {
        const double *R = s->R + (size_t)k * most_kept(s);
        s->combined[k] /= R[k];
        for (int j = 0; j < k; j++) {
            s->combined[j] -= s->combined[k] * R[j];
        }
    }
}

static void put_follower(hn_strbuf *b, const hn_system *sys, basis *s, int row) {
    hn_json_object(b);
    hn_json_put_string(b, "row", hn_system_row_name(sys, row));
    hn_json_key(b, "from");
    hn_json_array(b);
    if (s->length[row] > 0) {
        combine_rows(s);
    }
    for (int k = 0; k < s->n_kept; k++) {
        const double brings = fabs(s->combined[k]) * s->length[s->kept[k]];
        if (s->length[row] > 0 && brings > TAKES_PART * s->length[row]) {
            hn_json_string(b, hn_system_row_name(sys, s->kept[k]));
        }
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

/// Returns whether every row of a large mechanism stands well apart from the others, so that none
/// follows.
static hn_status rows_stand_apart(const hn_system *sys, const hn_eval *eval, const double *d,
                                  hn_arena *arena, bool *yes) {
    const int *row, *col, n = hn_eval_pattern(eval, HN_TERM_J, &row, &col);
    hn_row_check *check = NULL;
    *yes = false;
    if (sys->nv >= LARGE) {
        HN_TRY(hn_row_check_create(arena, sys->nc, sys->nv, n, row, col, &check));
    }
    *yes = check && hn_row_check_run_list(check, hn_eval_list(eval, HN_TERM_J), d);
    return HN_OK;
}

/// Row by row: what is left of it beside the rows kept before. Sets *n_follow to their number.
static hn_status split_rows(hn_strbuf *b, const hn_system *sys, const hn_eval *eval,
                            const double *d, hn_arena *arena, int *n_follow) {
    basis s;
    const double *J = hn_eval_list(eval, HN_TERM_J);
    const int *row, *col, n = hn_eval_pattern(eval, HN_TERM_J, &row, &col);
    double longest = 0;
    HN_TRY(basis_init(&s, sys, arena));
    for (int i = 0, k = 0; i < s.nc; i++) {
        memset(s.row, 0, (size_t)s.n * sizeof *s.row);
        for (; k < n && row[k] == i; k++) {
            s.row[col[k]] = J[k] * d[col[k]];
        }
        s.length[i] = hn_norm2(s.n, s.row);
        longest = fmax(longest, s.length[i]);
        split(&s);

        const double left = hn_norm2(s.n, s.row);

        // a row that is zero here follows from nothing
        if (s.length[i] <= FOLLOWS * longest) {
            s.length[i] = 0;
        }
        if (s.n_kept < most_kept(&s) && left > FOLLOWS * s.length[i] && s.length[i] > 0) {
            keep(&s, i, left);
        } else {
            put_follower(b, sys, &s, i);
            ++*n_follow;
        }
    }
    return HN_OK;
}

static hn_status put_followers(hn_strbuf *b, const hn_system *sys, double t, const double *q,
                               hn_arena *arena, int *n_follow) {
    hn_eval *eval = NULL;
    bool apart;
    double *d = hn_arena_doubles(arena, (size_t)sys->nv);
    if (!d) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_eval_create_listed(sys, HN_TERM_M | HN_TERM_J, arena, &eval));

    // rows measured by diag(M)^-1/2
    hn_eval_run(eval, t, q, NULL);
    hn_mass_scales(sys, eval, d);
    hn_status status = rows_stand_apart(sys, eval, d, arena, &apart);
    if (status == HN_OK && !apart) {
        status = split_rows(b, sys, eval, d, arena, n_follow);
    }
    hn_eval_free(eval);
    return status;
}

/// Finds whether rows that follow from others at q do so only there: *only.
static hn_status follow_only_here(const hn_system *sys, double t, const double *q, hn_arena *arena,
                                  bool *only) {
    hn_singularity *monitor = NULL;
    hn_singularity_info info;
    const double *rest = hn_arena_doubles(arena, (size_t)sys->nv);
    if (!rest) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_singularity_create(sys, arena, &monitor));
    hn_singularity_check(monitor, t, q, rest, &info);
    *only = hn_singularity_is_local(monitor, t, q);
    hn_singularity_free(monitor);
    return HN_OK;
}

hn_status hn_system_redundancy_put(hn_strbuf *b, const hn_system *sys, double t, const double *q) {
    int n_follow = 0;
    bool only = false;
    hn_arena *arena = hn_arena_create(0);
    hn_json_key(b, "redundant_rows");
    hn_json_object(b);
    hn_json_key(b, "vanish");
    hn_json_array(b);
    for (int i = 0; i < sys->info.rows_dropped; i++) {
        hn_json_string(b, sys->dropped[i]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "follow");
    hn_json_array(b);
    hn_status status = arena ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK && sys->nc > 0) {
        status = put_followers(b, sys, t, q, arena, &n_follow);
    }
    hn_json_end_array(b);
    if (status == HN_OK && n_follow > 0 && sys->nv < LARGE) {
        status = follow_only_here(sys, t, q, arena, &only);
        hn_json_put_bool(b, "singular", only);
    }
    hn_json_end_object(b);
    hn_arena_free(arena);
    return status == HN_OK && b->failed ? HN_ERR_MEMORY : status;
}
