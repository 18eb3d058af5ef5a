// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/workprecision.h"

#include "study/cost/shards.h"
#include "study/run/timing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_LEVELS = 7 };
static const double FIRST_RTOL = 3, LAST_RTOL = 12; // powers of ten
static const double COARSER = 4;                    // first step over the scene's

static const char *const state_names[] = {"pending", "done", "failed", "skipped"};

const char *hn_wp_state_name(hn_wp_state state) {
    HN_ASSERT((int)state >= 0 && state < HN_WP_STATES);
    return state_names[state];
}

static const char *size_key(const hn_wp_method *m) {
    return m->adaptive ? "rtol" : "h";
}

/// "index1@rk4:h=0.1,x=2" -> "index1@rk4:x=2": the ladder sets the step sizes.
static void strip_size(char *spelling, const char *key) {
    char token[16];
    char *at = strchr(spelling, '@');
    snprintf(token, sizeof token, "%s=", key);
    for (char *p = at; p && *p; p++) {
        if ((*p == ':' || *p == ',') && strncmp(p + 1, token, strlen(token)) == 0) {
            char *end = p + 1 + strcspn(p + 1, ",");
            if (*end) { // the next one takes its separator
                p++;
                end++;
            }
            memmove(p, end, strlen(end) + 1);
            return;
        }
    }
}

hn_method_spec hn_wp_spec(const hn_wp *wp, int m, double size) {
    hn_method_spec spec = wp->methods[m].spec;
    *hn_method_find_option(&spec, size_key(&wp->methods[m]), NULL) = size;
    return spec;
}

void hn_wp_spelling(const hn_wp *wp, int m, int k, char out[HN_SPEC_MAX]) {
    const hn_method_spec spec = hn_wp_spec(wp, m, wp->methods[m].point[k].size);
    hn_method_format(&spec, out);
}

bool hn_wp_is_resolved(const hn_wp *wp, hn_error_kind kind, double error) {
    return isfinite(error) && error > HN_WP_ABOVE_REFERENCE * wp->ref->error[kind];
}

bool hn_wp_is_beyond_horizon(const hn_wp *wp) {
    return wp->horizon > 0 && wp->horizon < wp->ref->T;
}

/// Size number k: steps divide the reference's intervals and halve, tolerances fall evenly.
static double size_at(const hn_wp *wp, const hn_wp_method *m, int k) {
    if (m->adaptive) {
        return pow(10, -(FIRST_RTOL + (LAST_RTOL - FIRST_RTOL) * k / (wp->n_levels - 1)));
    }
    const double between = wp->ref->T / wp->ref->n;
    const double parts = ceil(between / wp->opts.step * (1 - 1e-12));
    return wp->ref->T / (wp->ref->n * fmax(1, parts) * ldexp(1, k));
}

static hn_status set_up_method(hn_wp *wp, const hn_method_spec *spec, int i, hn_diag *diag) {
    hn_wp_method *m = &wp->methods[i];
    m->spec = *spec;
    m->adaptive = hn_method_is_adaptive(spec);
    hn_method_format(spec, m->spelling);
    if (!hn_method_find_option(&m->spec, size_key(m), NULL)) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "%s has neither a step nor a tolerance to vary", m->spelling);
    }
    strip_size(m->spelling, size_key(m));
    for (int k = 0; k < wp->n_levels; k++) {
        m->point[k].size = size_at(wp, m, k);
        m->point[k].own = (double)NAN;
        m->point[k].median = m->point[k].spread = (double)NAN;
        m->point[k].low = m->point[k].high = (double)NAN;
        m->point[k].half[0] = m->point[k].half[1] = (double)NAN;
        m->point[k].end_q = hn_arena_doubles(wp->arena, (size_t)wp->ref->n_user);
    }
    return HN_OK;
}

static hn_status check_opts(hn_wp_opts *o, int n, const hn_system *sys, hn_diag *diag) {
    o->n_levels = o->n_levels == 0 ? DEFAULT_LEVELS : o->n_levels;
    o->n_samples = o->n_samples == 0 ? HN_WP_SAMPLES : o->n_samples;
    o->step = o->step == 0 ? COARSER * hn_system_scene(sys)->step : o->step;

    // numbers of methods, sizes and samples
    if (n < 1 || n > HN_WP_METHODS) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/methods", NULL,
                           "%d methods were given; a study takes 1 to %d", n, HN_WP_METHODS);
    }
    if (o->n_levels < 2 || o->n_levels > HN_WP_LEVELS) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/levels", NULL,
                           "%d sizes were asked for; a study takes 2 to %d", o->n_levels,
                           HN_WP_LEVELS);
    }
    if (o->n_samples > HN_WP_SAMPLES) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/samples", NULL,
                           "more samples of time were asked for than the %d that a study takes",
                           HN_WP_SAMPLES);
    }

    // step and time limit
    if (!(o->step > 0) || !(o->time_limit >= 0)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "a study takes a step above 0 and a time limit that is not negative");
    }

    // part of a divided study
    if (o->n_shards < 0 || o->n_shards > HN_WP_SHARDS || o->shard > o->n_shards ||
        o->shard < (o->n_shards > 0)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/shard", "as 2/4: the second of four",
                           "part %d of %d was asked for; a study has 1 to %d parts", o->shard,
                           o->n_shards, HN_WP_SHARDS);
    }
    return HN_OK;
}

hn_status hn_wp_create(const hn_system *sys, const double *q, const double *v, const hn_ref *ref,
                       const hn_method_spec *specs, int n, const hn_wp_opts *opts, hn_wp **out,
                       hn_diag *diag) {
    hn_wp_opts o = opts ? *opts : (hn_wp_opts){0};
    HN_TRY(check_opts(&o, n, sys, diag));
    hn_arena *arena = hn_arena_create(0);
    hn_wp *wp = arena ? hn_arena_get(arena, sizeof *wp) : NULL;
    if (!wp) {
        hn_arena_free(arena);
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    *wp = (hn_wp){.arena = arena,
                  .sys = sys,
                  .q = q,
                  .v = v,
                  .ref = ref,
                  .opts = o,
                  .n_methods = n,
                  .n_levels = o.n_levels,
                  .clocks_apart = 1};
    wp->methods = hn_arena_get(arena, (size_t)n * sizeof *wp->methods);
    wp->runs = hn_arena_get(arena, (size_t)(n * o.n_levels) * sizeof *wp->runs);
    wp->shard = hn_arena_ints(arena, (size_t)(n * o.n_levels));
    hn_status status =
        hn_arena_failed(arena) ? HN_ERR_MEMORY : hn_errors_create(sys, arena, &wp->errors);
    for (int i = 0; i < n && status == HN_OK; i++) {
        status = set_up_method(wp, &specs[i], i, diag);
    }
    if (status == HN_OK && hn_arena_failed(arena)) {
        status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (status != HN_OK) {
        hn_wp_free(wp);
        return status;
    }
    hn_wp_split(wp, o.n_shards > 0 ? o.n_shards : 1, wp->shard);
    *out = wp;
    return HN_OK;
}

bool hn_wp_is_mine(const hn_wp *wp, int m, int k) {
    return wp->opts.n_shards == 0 || wp->shard[m * wp->n_levels + k] == wp->opts.shard;
}

void hn_wp_drop_run(hn_wp *wp, int m, int k) {
    hn_run_free(wp->runs[m * wp->n_levels + k]);
    wp->runs[m * wp->n_levels + k] = NULL;
}

void hn_wp_drop_runs(hn_wp *wp) {
    for (int i = 0; wp->methods && wp->runs && i < wp->n_methods * wp->n_levels; i++) {
        hn_wp_drop_run(wp, i / wp->n_levels, i % wp->n_levels);
    }
    hn_run_free(wp->yardstick_run);
    wp->yardstick_run = NULL;
}

void hn_wp_free(hn_wp *wp) {
    if (wp) {
        hn_wp_drop_runs(wp);
        hn_errors_free(wp->errors);
        hn_arena_free(wp->arena);
    }
}

void hn_wp_compare_ends(hn_wp *wp) {
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_wp_point *coarser = NULL;
        for (int k = 0; k < wp->n_levels; k++) {
            hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state == HN_WP_DONE) {
                p->own =
                    coarser ? hn_errors_between(wp->errors, p->end_q, coarser->end_q) : (double)NAN;
                coarser = p;
            }
        }
    }
}

/// Sorts the list in ascending order and returns its median.
static double sort_and_halve(double *list, int n) {
    hn_timing_sort(list, n);
    return hn_timing_quantile(list, n, 0.5);
}

void hn_wp_point_statistics(hn_wp_point *p) {
    double sorted[HN_WP_SAMPLES];
    const int n = p->n_samples, half = (n + 1) / 2;
    p->half[0] = p->half[1] = (double)NAN;
    if (n < 1) {
        return;
    }
    if (n >= HN_WP_ENOUGH) {
        memcpy(sorted, p->sample, (size_t)n * sizeof *sorted);
        p->half[0] = sort_and_halve(sorted, half);
        p->half[1] = sort_and_halve(sorted + half, n - half);
    }
    memcpy(sorted, p->sample, (size_t)n * sizeof *sorted);
    p->median = sort_and_halve(sorted, n);
    p->low = hn_timing_quantile(sorted, n, 0.25);
    p->high = hn_timing_quantile(sorted, n, 0.75);
    p->spread = p->median > 0 ? (p->high - p->low) / p->median : 0;
}

double hn_wp_point_halves_apart(const hn_wp_point *p) {
    return fmax(p->half[0], p->half[1]) / fmin(p->half[0], p->half[1]);
}
