// SPDX-License-Identifier: GPL-3.0-or-later

#include "dynamics/assembly/assemble.h"

#include "dynamics/assembly/assemble_explain.h"
#include "dynamics/assembly/assemble_mode.h"
#include "dynamics/assembly/assemble_pose.h"
#include "dynamics/assembly/assemble_position.h"
#include "dynamics/assembly/assemble_rates.h"
#include "dynamics/assembly/assemble_rows.h"
#include "dynamics/assembly/mode.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/mass_scales.h"
#include "linalg/dense.h"
#include "linalg/gram.h"
#include "linalg/qr.h"
#include "linalg/row_check.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// rank of J D for the report, as in linalg/saddle.h
static const double RANK_TOL = 1e-10;

static const hn_coordinate *user_coordinate(const hn_assembler *s, int i) {
    return &s->scene->coordinates[hn_system_user_coordinate(s->sys, i)];
}

// ---- setting up ----

/// A pin or a guess on a joint that closes a loop has no coordinate to hold or to begin from, so it
/// is refused.
static hn_status check_pins(const hn_assembler *s) {
    hn_status status = HN_OK;
    for (int i = 0; i < s->scene->n_coordinates; i++) {
        const hn_coordinate *c = &s->scene->coordinates[i];
        if (c->joint < 0 || !hn_system_joint_is_cut(s->sys, c->joint)) {
            continue;
        }
        if (c->q0_given || c->v0_given) {
            const int pinned = c->q0_pinned || c->v0_pinned;
            status = hn_diags_add(
                s->diags, HN_ERR_UNSUPPORTED, c->q0_given ? c->q0_pointer : c->v0_pointer,
                pinned ? "give the value of another coordinate, or write \"cut\": true at another "
                         "joint of the loop"
                       : "give the guess of another coordinate, or write \"cut\": true at another "
                         "joint of the loop",
                "%s cannot have a '%s': its joint closes a loop, and it follows from the others",
                c->name, pinned ? "value" : "guess");
        }
    }
    return status;
}

/// An orientation is pinned as a whole: one entry of its rotation vector alone cannot be held.
static hn_status check_orientations(const hn_assembler *s) {
    for (int i = 0; i + 2 < s->n; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        if (s->turn[i] == 0 &&
            (c[0].q0_pinned != c[1].q0_pinned || c[1].q0_pinned != c[2].q0_pinned)) {
            const hn_coordinate *pinned = &c[c[0].q0_pinned ? 0 : c[1].q0_pinned ? 1 : 2];
            return hn_diags_add(
                s->diags, HN_ERR_INPUT, pinned->q0_pointer,
                "give 'value' for all three entries, or 'guess' for all three",
                "%s, %s and %s are the entries of one orientation: %s alone cannot have a 'value'",
                c[0].name, c[1].name, c[2].name, pinned->name);
        }
    }
    return HN_OK;
}

static hn_status start(hn_assembler *s) {
    size_t n = (size_t)s->n, nc = (size_t)s->nc;
    s->x = hn_arena_doubles(s->arena, n);
    s->guess = hn_arena_doubles(s->arena, n);
    s->q = hn_arena_doubles(s->arena, (size_t)s->nq);
    s->turn = hn_arena_ints(s->arena, n);
    s->rest = hn_arena_doubles(s->arena, n);
    s->reach = hn_arena_doubles(s->arena, n);
    s->free = hn_arena_ints(s->arena, n);
    s->row_scale = hn_arena_doubles(s->arena, nc);
    s->residual = hn_arena_doubles(s->arena, nc);
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }

    // start values, and which coordinates may move
    for (int i = 0, at = 0; i < s->n; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        s->turn[i] = hn_system_position_of(s->sys, i) < 0 ? at++ % 3 : -1;
        s->x[i] = s->guess[i] = c->q0;
        s->reach[i] = c->kind == HN_LENGTH ? s->length : 1;
        if (!c->q0_pinned) {
            s->free[s->n_free++] = i;
        }
    }

    // what the stages need
    for (int i = 0; i < s->nc; i++) {
        s->row_scale[i] = 1 / hn_system_row_unit(s->sys, i);
    }
    HN_TRY(check_orientations(s));
    HN_TRY(hn_rate_tree_init(&s->rates, s->sys, s->arena));
    unsigned terms = HN_TERM_M | HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_ENERGY;
    s->M = hn_arena_doubles(s->arena, n * n);
    s->J = hn_arena_doubles(s->arena, nc * n);
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }
    return hn_eval_create_listed(s->sys, terms, s->arena, &s->eval);
}

// ---- pose ----

static int find_worst_loop(const hn_assembler *s) {
    int worst = -1;
    double largest = -1;
    for (int i = 0; i < s->nc; i++) {
        int loop = hn_system_row_loop(s->sys, i);
        double gap = hn_assemble_gap(s, loop);
        if (gap > largest) {
            largest = gap;
            worst = loop;
        }
    }
    return worst;
}

static hn_status find_pose(hn_assembler *s, hn_assembly *report) {
    int finite = hn_assemble_evaluate(s);
    report->gap_before = hn_assemble_gap(s, -1);
    hn_status status = finite ? hn_assemble_position(s) : HN_ERR_DIVERGED;

    // the pose, then the assembly mode that the scene asks for
    const int closed = status == HN_OK;
    if (closed) {
        status = hn_assemble_mode(s);
    }

    report->gap = hn_assemble_gap(s, -1);
    report->iterations = s->iterations;
    report->route = s->route;
    for (int i = 0; i < s->n; i++) {
        report->moved = fmax(report->moved, hn_assemble_moved(s, i));
    }

    // say why there is none
    if (status == HN_ERR_UNREACHABLE && !closed) {
        const int flipped = hn_assemble_flipped(s);
        report->worst_loop = flipped >= 0 ? flipped : find_worst_loop(s);
        hn_assemble_explain(s, report->worst_loop);
    } else if (status == HN_ERR_DIVERGED) {
        hn_diags_add(s->diags, status, NULL, NULL,
                     "the closure equations have no finite value at the start values");
    }
    return status;
}

// ---- accelerations and the report ----

static hn_status find_accelerations(hn_assembler *s, const double *v, double *a, double *lambda) {
    hn_accel *accel = NULL;
    hn_accel_opts opts = {.want_lambda = 1};
    hn_status status = hn_accel_create(s->sys, &opts, s->arena, &accel);
    double *a_out = hn_arena_doubles(s->arena, (size_t)s->n),
           *l_out = hn_arena_doubles(s->arena, (size_t)s->nc);

    if (status == HN_OK && (!a_out || !l_out)) {
        status = HN_ERR_MEMORY;
    }

    // solve, and say so where that fails
    if (status == HN_OK) {
        hn_accel_info info;
        status = hn_accel_eval(accel, s->t, s->q, v, 0, 0, a_out, l_out, &info);
        if (status != HN_OK) {
            hn_diags_add(s->diags, status, NULL, NULL,
                         "the accelerations at the start are not determined: %s",
                         hn_status_text(status));
        }
    }

    // outputs stay untouched on failure
    if (status == HN_OK && a) {
        memcpy(a, a_out, (size_t)s->n * sizeof *a);
    }
    if (status == HN_OK && lambda) {
        memcpy(lambda, l_out, (size_t)s->nc * sizeof *lambda);
    }
    hn_accel_free(accel);
    return status;
}

/// Entries of J D, rows brought to length 1 or as they are.
static void scale_entries(const hn_assembler *s, const double *d, bool unit_rows, double *entry) {
    const double *J = hn_eval_list(s->eval, HN_TERM_J);
    const int *row, *col, n = hn_eval_pattern(s->eval, HN_TERM_J, &row, &col);
    double *square = s->residual; // nc, not needed any more
    memset(square, 0, (size_t)s->nc * sizeof *square);
    for (int k = 0; k < n; k++) {
        entry[k] = J[k] * d[col[k]];
        square[row[k]] += entry[k] * entry[k];
    }
    for (int k = 0; k < n && unit_rows; k++) {
        entry[k] = square[row[k]] > 0 ? entry[k] / sqrt(square[row[k]]) : 0;
    }
}

/// Solves entry by entry for a large mechanism whose rows stand well apart. *found = 0: they may
/// not.
static hn_status find_sigma_sparse(const hn_assembler *s, const double *d, hn_assembly *report,
                                   int *found) {
    const int *row, *col, n = hn_eval_pattern(s->eval, HN_TERM_J, &row, &col);
    hn_gram *gram;
    double *entry = hn_arena_doubles(s->arena, (size_t)n);
    *found = 0;
    if (!entry) {
        return HN_ERR_MEMORY;
    }
    HN_TRY(hn_gram_create(s->arena, s->nc, s->n, n, row, col, &gram));
    if (!gram) {
        return HN_OK;
    }

    // whether every row counts
    scale_entries(s, d, true, entry);
    hn_gram_fill(gram, entry);
    if (hn_gram_factor(gram, 0, HN_ROW_CHECK_DISTANCE * HN_ROW_CHECK_DISTANCE) != HN_OK) {
        return HN_OK;
    }

    // the singular values; squared, they lose what is below 1e-6 of the largest
    scale_entries(s, d, false, entry);
    hn_gram_fill(gram, entry);
    if (hn_gram_factor(gram, 0, 0) == HN_OK) {
        hn_gram_sigma(gram, &report->sigma_min, &report->sigma_max);
        *found = report->sigma_min > 1e-6 * report->sigma_max;
    }
    return HN_OK;
}

static hn_status find_sigma_dense(const hn_assembler *s, const double *d, hn_assembly *report,
                                  int *rank) {
    const double *J = hn_assemble_dense(s, HN_TERM_J);
    const int n = s->n;
    hn_qr qr;
    if (!hn_qr_init(&qr, s->arena, n, s->nc)) {
        return HN_ERR_MEMORY;
    }
    for (int i = 0; i < s->nc; i++) {
        for (int k = 0; k < n; k++) {
            qr.a[(size_t)i * n + k] = J[(size_t)i * n + k] * d[k];
        }
    }
    hn_qr_factor(&qr, n, s->nc, RANK_TOL);
    hn_qr_sigma(&qr, &report->sigma_min, &report->sigma_max);
    *rank = qr.rank;
    return HN_OK;
}

/// Rank and singular values of J D with D = diag(M)^-1/2: independent of the units of the
/// coordinates.
static hn_status report_rank(hn_assembler *s, hn_assembly *report) {
    double *d = hn_arena_doubles(s->arena, (size_t)s->n);
    int found = 0, rank = s->nc;
    if (!d) {
        return HN_ERR_MEMORY;
    }
    hn_mass_scales(s->sys, s->eval, d);
    if (hn_assemble_is_large(s)) {
        HN_TRY(find_sigma_sparse(s, d, report, &found));
    }
    if (!found) {
        HN_TRY(find_sigma_dense(s, d, report, &rank));
    }
    report->rank = rank;
    report->freedoms = s->n - rank;
    report->redundant = s->nc - rank;
    return HN_OK;
}

static hn_status report_mode(hn_assembler *s, hn_assembly *report) {
    hn_mode_watch *watch = NULL;
    int four_bar = 0;
    hn_status status = hn_mode_watch_create(s->sys, s->arena, &watch);
    if (status != HN_OK) {
        return status;
    }

    // the sign of every loop
    const int n = hn_mode_watch_count(watch);
    double *values = hn_arena_doubles(s->arena, (size_t)n + 1);
    if (values) {
        hn_mode_watch_values(watch, s->t, s->q, values);
        report->mode = hn_mode_sign(values[0]);
    }
    for (int k = 0; values && k < n && k < (int)sizeof report->modes - 1; k++) {
        const int sign = hn_mode_sign(values[k]);
        report->modes[k] = sign > 0 ? '+' : (sign < 0 ? '-' : '0');
    }

    hn_mode_watch_free(watch);
    if (!values) {
        return HN_ERR_MEMORY;
    }

    // a four-bar's modes have names
    status = hn_mode_is_four_bar(s->sys, s->arena, &four_bar);
    if (report->mode != 0) {
        const char *positive = four_bar ? "open" : "+", *negative = four_bar ? "crossed" : "-";
        report->mode_name = report->mode > 0 ? positive : negative;
    }
    return status;
}

static hn_status fill_report(hn_assembler *s, hn_assembly *report) {
    const double *energy = hn_eval_get(s->eval, HN_TERM_ENERGY);
    report->energy = energy[0] + energy[1];
    HN_TRY(report_mode(s, report));
    return report_rank(s, report);
}

static hn_status run_stages(hn_assembler *s, double *q, double *v, double *a, double *lambda,
                            hn_assembly *report) {
    memset(q, 0, (size_t)s->nq * sizeof *q);
    memset(v, 0, (size_t)s->n * sizeof *v);

    // what holds before anything moves
    HN_TRY(check_pins(s));
    HN_TRY(start(s));

    // pose, velocities, accelerations
    hn_status status = find_pose(s, report);
    memcpy(q, s->q, (size_t)s->nq * sizeof *q);
    HN_THEN(status, hn_assemble_rates(s, v, report));
    if (status == HN_OK && (a || lambda)) {
        status = find_accelerations(s, v, a, lambda);
    }

    // the report, also of what was reached on failure
    hn_eval_run(s->eval, s->t, s->q, v);
    const hn_status reported = fill_report(s, report);
    return status != HN_OK ? status : reported;
}

hn_status hn_assemble(const hn_system *sys, double t, double *q, double *v, double *a,
                      double *lambda, hn_assembly *report, hn_diags *diags) {
    hn_system_info info = hn_system_get_info(sys);
    HN_ASSERT(info.n_user == info.nv);
    hn_assembly local;

    // what is reported when nothing was reached
    report = report ? report : &local;
    *report = (hn_assembly){.worst_loop = -1, .mode_name = "none", .route = "already closed"};

    hn_assembler s = {.sys = sys,
                      .scene = hn_system_scene(sys),
                      .arena = hn_arena_create(0),
                      .diags = diags,
                      .t = t,
                      .n = info.nv,
                      .nq = info.nq,
                      .nc = info.nc,
                      .length = hn_system_length(sys),
                      .route = "already closed"};

    if (!s.arena) {
        return HN_ERR_MEMORY;
    }
    hn_status status = run_stages(&s, q, v, a, lambda, report);
    report->ok = status == HN_OK;
    hn_eval_free(s.eval);
    hn_arena_free(s.arena);
    return status;
}
