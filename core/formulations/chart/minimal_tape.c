// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulations/chart/minimal_tape.h"

#include "formulations/chart/chart_follow.h"

#include <math.h>
#include <string.h>

enum { MOST_RUNS = 6 }; // of the tape for one configuration; more is for the careful way

static hn_status make(hn_minimal_tape *w, const hn_chart *chart, hn_arena *arena) {
    const hn_reduced_split split = {.rank = chart->rank,
                                    .r = chart->r,
                                    .dep = chart->dep,
                                    .ind = chart->ind,
                                    .J = chart->here.J,
                                    .closed = HN_CHART_TOL_FINE * chart->length};
    w->was_made = true;
    w->y = hn_arena_doubles(arena, 2 * (size_t)chart->nv);
    w->q = hn_arena_doubles(arena, (size_t)chart->nq);
    w->predicted = hn_arena_doubles(arena, (size_t)chart->nq);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY
                                  : hn_reduced_tape_create(chart->sys, &split, arena, &w->tape);
}

hn_status hn_minimal_tape_begin(hn_minimal_tape *w, const hn_chart *chart, hn_arena *arena) {
    HN_ASSERT(chart->here.valid && !chart->here.is_bare);
    w->valid = w->serves = false;
    if (!w->was_made) {
        HN_TRY(make(w, chart, arena));
    }
    if (!w->tape || !hn_reduced_tape_is_for(w->tape, chart->dep, chart->rank)) {
        return HN_OK;
    }

    // pivots here are the measure of later ones; velocities do not enter them
    w->unit = 1;
    for (int k = 0; k < chart->rank; k++) {
        w->unit *= chart->scale[chart->dep[k]];
    }
    memset(w->y, 0, 2 * (size_t)chart->r * sizeof *w->y);
    hn_reduced_tape_run(w->tape, chart->here.t, chart->here.q, w->y);
    hn_reduced_tape_take_measure(w->tape);
    w->serves = hn_reduced_tape_is_sure(w->tape);
    return HN_OK;
}

void hn_minimal_tape_free(hn_minimal_tape *w) {
    hn_reduced_tape_free(w->tape);
    w->tape = NULL;
}

static void count_run(const hn_minimal_tape *w, hn_chart *chart) {
    enum { FACTORS = 3 }; // J_d at the prediction and at the corrected configuration, the mass
    hn_cost *cost = &chart->cost;
    cost->newton++;
    cost->factorisations += FACTORS;
    cost->solves += chart->r + 2;
    cost->ops += hn_reduced_tape_info(w->tape).ops;
}

/// Returns whether the last run led to a regular configuration in the same assembly mode.
static bool is_regular(const hn_minimal_tape *w, const hn_chart *chart) {
    return hn_reduced_tape_is_sure(w->tape) &&
           chart->base.sign * hn_reduced_tape_determinant(w->tape) > 0;
}

/// Runs the tape from w->q until the gap is small.
static bool iterate(hn_minimal_tape *w, hn_chart *chart, double t, const double *u, double tol) {
    double last = HUGE_VAL;
    for (int i = 0; i < MOST_RUNS; i++) {
        hn_reduced_tape_run(w->tape, t, w->q, u);
        count_run(w, chart);
        w->gap = hn_reduced_tape_gap(w->tape);
        if (!is_regular(w, chart)) {
            return false;
        }
        hn_reduced_tape_get_position(w->tape, w->q);
        if (hn_chart_is_closed(chart, w->gap, last, tol)) {
            return true;
        }
        if (!(w->gap < last)) {
            return false;
        }
        last = w->gap;
    }
    return false;
}

static bool is_last(const hn_minimal_tape *w, const hn_chart *chart, double t, const double *y) {
    bool same = w->t == t;
    for (int j = 0; j < 2 * chart->r; j++) {
        same &= w->y[j] == y[j];
    }
    return same;
}

/// As hn_chart_predict(), for a system without balls: every velocity is the rate of the position of
/// its number.
static void predict(hn_minimal_tape *w, const hn_chart *chart, double t, const double *y) {
    const hn_chart_point *from = &chart->base;
    const int r = chart->r;
    const double h = t - from->t;
    for (int k = 0; k < chart->rank; k++) {
        const int i = chart->dep[k];
        double step = from->s[i] * h;
        for (int j = 0; j < r; j++) {
            step += from->N[i * r + j] * (y[j] - from->q[chart->ind[j]]);
        }
        w->q[i] = w->predicted[i] = from->q[i] + step;
    }
    for (int j = 0; j < r; j++) {
        w->q[chart->ind[j]] = w->predicted[chart->ind[j]] = y[j];
    }
}

bool hn_minimal_tape_close(hn_minimal_tape *w, hn_chart *chart, double t, const double *y,
                           double tol) {
    if (!w->serves || chart->dyads || !chart->base.valid) {
        return false;
    }

    // the same state again; a hand may pull at it differently
    const bool may_differ = hn_system_pulls(chart->sys) != NULL;
    if (w->valid && !may_differ && w->gap <= tol * chart->length && is_last(w, chart, t, y)) {
        return true;
    }

    // from the tangent at the last accepted state
    w->valid = false;
    predict(w, chart, t, y);
    w->valid =
        iterate(w, chart, t, y + chart->r, tol) && hn_chart_is_near(chart, w->predicted, w->q);
    w->t = t;
    for (int j = 0; j < 2 * chart->r; j++) {
        w->y[j] = y[j];
    }
    return w->valid;
}

bool hn_minimal_tape_get_accelerations(const hn_minimal_tape *w, double *u_dot) {
    return hn_reduced_tape_get_accelerations(w->tape, u_dot);
}

void hn_minimal_tape_put(const hn_minimal_tape *w, hn_chart *chart) {
    HN_ASSERT(w->valid);
    hn_chart_point *p = &chart->here;
    const double det = hn_reduced_tape_determinant(w->tape);
    memcpy(p->q, w->q, (size_t)chart->nq * sizeof *p->q);
    hn_reduced_tape_get_basis(w->tape, p->N, p->s);
    p->t = w->t;
    p->gap = w->gap;
    p->tol = 0;
    p->sign = det > 0 ? 1 : -1;
    p->volume = fabs(det) * w->unit;
    p->is_bare = true;
    p->valid = true;
}
