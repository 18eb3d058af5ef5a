// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/reference.h"

#include "study/truth/precise.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define SMALLEST 1e-300 // a scale that would be 0 is 1 instead
#define MOST_DIGITS 16.0

/// In the order they are tried; any two have nothing but the scene's equations in common, or differ
/// in formulation and integrator.
typedef struct mean {
    int precise; ///< 1: in extended precision, `kind`
    hn_precise_kind kind;
    const char *spelling; ///< of a method otherwise
} mean;
static const mean MEANS[] = {
    {1, HN_PRECISE_SADDLE, NULL},           {1, HN_PRECISE_NULLSPACE, NULL},
    {0, 0, "projection@dop853:rtol=1e-13"}, {0, 0, "nullspace@gsl-rk8pd:rtol=1e-13"},
    {0, 0, "ggl@radau5:rtol=1e-12"},
};
enum { N_MEANS = sizeof MEANS / sizeof *MEANS };
// of the computing time that each computation may take: what the first leave is for those in double
static const double PRECISE_SHARE = 0.4;

static const char *name_of(const mean *m) {
    return m->precise ? hn_precise_name(m->kind) : m->spelling;
}

hn_ref_opts hn_ref_opts_default(void) {
    return (hn_ref_opts){.n = HN_REF_TIMES};
}

hn_ref *hn_ref_blank(uint64_t scene, double T, int n, int n_user, int nc) {
    hn_arena *arena = hn_arena_create(0);
    hn_ref *ref = arena ? hn_arena_get(arena, sizeof *ref) : NULL;
    if (!ref) {
        hn_arena_free(arena);
        return NULL;
    }
    *ref = (hn_ref){.arena = arena, .scene = scene, .T = T, .n = n, .n_user = n_user, .nc = nc};
    const size_t rows = (size_t)n + 1;
    ref->q = hn_arena_doubles(arena, rows * (size_t)n_user);
    ref->v = hn_arena_doubles(arena, rows * (size_t)n_user);
    ref->lambda = hn_arena_doubles(arena, rows * (size_t)nc);
    ref->energy = hn_arena_doubles(arena, rows);
    ref->between = hn_arena_doubles(arena, rows * HN_ERROR_COUNT);
    if (hn_arena_failed(arena)) {
        hn_arena_free(arena);
        return NULL;
    }
    return ref;
}

void hn_ref_free(hn_ref *ref) {
    if (ref) {
        hn_arena_free(ref->arena);
    }
}

hn_state_seen hn_ref_at(const hn_ref *ref, int k) {
    return (hn_state_seen){.t = k == ref->n ? ref->T : ref->T * k / ref->n,
                           .q = ref->q + (size_t)k * (size_t)ref->n_user,
                           .v = ref->v + (size_t)k * (size_t)ref->n_user,
                           .lambda = ref->lambda + (size_t)k * (size_t)ref->nc,
                           .energy = ref->energy[k]};
}

double hn_ref_digits(const hn_ref *ref) {
    const double e = ref->error[HN_ERROR_Q];
    return e > 0 ? fmin(MOST_DIGITS, -log10(e)) : MOST_DIGITS;
}

/// The result of one computation, and the data for scales.
typedef struct recorder {
    hn_ref *ref;
    const hn_ref_opts *opts;
    int found;                 ///< computations that came to the end before this one
    double kinetic, low, high; ///< largest kinetic energy; range of the potential
} recorder;

static int record(void *user, int k, const hn_sample *s) {
    recorder *r = user;
    hn_ref *ref = r->ref;
    const size_t nu = (size_t)ref->n_user, nc = (size_t)ref->nc;

    // the sample into the reference
    memcpy(ref->q + (size_t)k * nu, s->q, nu * sizeof(double));
    memcpy(ref->v + (size_t)k * nu, s->v, nu * sizeof(double));
    if (nc > 0) {
        memcpy(ref->lambda + (size_t)k * nc, s->lambda, nc * sizeof(double));
    }
    ref->energy[k] = s->energy;

    if (r->opts->progress) {
        r->opts->progress(r->opts->user, (r->found + (double)k / ref->n) / HN_REF_MEANS);
    }

    // ranges that energies are judged by
    r->kinetic = k == 0 ? s->kinetic : fmax(r->kinetic, s->kinetic);
    r->low = k == 0 ? s->potential : fmin(r->low, s->potential);
    r->high = k == 0 ? s->potential : fmax(r->high, s->potential);

    // a motion that is not finite ends here
    for (size_t i = 0; i < nu; i++) {
        if (!isfinite(s->q[i]) || !isfinite(s->v[i])) {
            return 0;
        }
    }
    return 1;
}

/// One computation in double into `ref`. HN_ERR_STOPPED and the like with the reason in diag.
static hn_status compute_double(const hn_system *sys, const char *spelling, const double *q,
                                const double *v, const hn_walk_limits *limits, recorder *r,
                                hn_walk_end *end, hn_diag *diag) {
    hn_method_spec spec;
    hn_run *run = NULL;
    hn_sample start;
    *end = HN_WALK_FAILED;
    hn_status status = hn_method_parse(spelling, &spec, diag);
    HN_THEN(status, hn_run_create(sys, &spec, q, v, NULL, &run, diag));
    if (status != HN_OK) {
        return status;
    }
    hn_run_watch(run, 0);
    if (hn_run_sample(run, 0, &start) == HN_OK && record(r, 0, &start)) {
        *end = hn_walk(run, r->ref->T, r->ref->n, limits, record, r);
    }
    const hn_run_summary s = hn_run_get_summary(run);
    if (*end == HN_WALK_OVER) {
        status = hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "takes more than %g s of computing",
                             limits->seconds);
    } else if (*end != HN_WALK_DONE) {
        status =
            hn_diag_set(diag, s.status == HN_OK ? HN_ERR_DIVERGED : s.status, NULL, NULL,
                        "at t = %.6g s: %s", s.t, s.reason[0] ? s.reason : "values are not finite");
    }
    hn_run_free(run);
    return status;
}

static hn_status compute(const hn_system *sys, const mean *m, const double *q, const double *v,
                         const hn_walk_limits *limits, recorder *r, hn_walk_end *end,
                         hn_diag *diag) {
    hn_walk_limits part = *limits;
    if (!m->precise) {
        return compute_double(sys, m->spelling, q, v, limits, r, end, diag);
    }
    part.seconds *= PRECISE_SHARE;
    return hn_precise_walk(m->kind, sys, q, v, r->ref->T, r->ref->n, &part, record, r, end, diag);
}

static double or_one(double scale) {
    return scale > SMALLEST && isfinite(scale) ? scale : 1;
}

static void set_scales(hn_ref *ref, hn_errors *errors, const hn_system *sys, const recorder *r) {
    double rate = 0, reaction = 0;
    for (int k = 0; k <= ref->n; k++) {
        const hn_state_seen at = hn_ref_at(ref, k);
        rate = fmax(rate, hn_errors_rate(errors, at.v));
        reaction = fmax(reaction, hn_errors_reaction(errors, &at, at.lambda));
    }
    reaction = fmax(reaction, hn_errors_least_reaction(errors, rate));
    ref->scales = (hn_scales){.length = or_one(hn_system_length(sys)),
                              .rate = or_one(rate),
                              .reaction = or_one(reaction),
                              .energy = or_one(r->kinetic + r->high - r->low)};
}

/// The largest of both; a number that is missing counts as an error of its own.
static double worse(double a, double b) {
    return isnan(a) || isnan(b) ? (double)NAN : fmax(a, b);
}

/// The error of storing numbers as doubles: smaller differences cannot be told apart.
static double rounding(const hn_ref *ref, int k, hn_error_kind kind) {
    double most = 1;
    for (int i = 0; kind == HN_ERROR_Q && i < ref->n_user; i++) {
        most = fmax(most, fabs(ref->q[(size_t)k * (size_t)ref->n_user + (size_t)i]));
    }
    return DBL_EPSILON / 2 * most;
}

static void compare(hn_ref *ref, const hn_ref *other, hn_errors *errors) {
    for (int k = 0; k <= ref->n; k++) {
        const hn_state_seen a = hn_ref_at(ref, k), b = hn_ref_at(other, k);
        double *e = ref->between + (size_t)k * HN_ERROR_COUNT;
        hn_errors_calc(errors, &b, &a, &ref->scales, e);
        e[HN_ERROR_GAP] = e[HN_ERROR_VELOCITY_GAP] = 0; // gaps are measured, not compared
        for (int i = 0; i < HN_ERROR_COUNT; i++) {
            if (i != HN_ERROR_GAP && i != HN_ERROR_VELOCITY_GAP) {
                e[i] = worse(e[i], rounding(ref, k, (hn_error_kind)i));
            }
            ref->error[i] = worse(ref->error[i], e[i]);
        }
    }
}

/// Adds why a means gave none; one that does not fit whole is left out.
static void note_refusal(char refused[320], const char *means, const hn_diag *diag) {
    const size_t used = strlen(refused);
    const int n =
        snprintf(refused + used, 320 - used, "%s%s %.110s", used ? "; " : "", means, diag->message);
    if (n < 0 || (size_t)n >= 320 - used) {
        refused[used] = '\0';
    }
}

/// The first two computations that come to the end, kept[0] and kept[1].
static hn_status find_two(const hn_system *sys, const double *q, const double *v, double T, int n,
                          const hn_ref_opts *opts, hn_ref *kept[2], recorder seen[2],
                          char refused[320], hn_diag *diag) {
    const hn_system_info info = hn_system_get_info(sys);
    int found = 0;
    for (int i = 0; i < N_MEANS && found < HN_REF_MEANS; i++) {
        hn_walk_end end;
        if (opts->skip_precise && MEANS[i].precise) {
            continue;
        }
        if (!kept[found]) {
            kept[found] = hn_ref_blank(hn_system_scene(sys)->hash, T, n, info.n_user, info.nc);
        }
        if (!kept[found]) {
            return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
        }
        seen[found] = (recorder){.ref = kept[found], .opts = opts, .found = found};
        const hn_status status =
            compute(sys, &MEANS[i], q, v, &opts->limits, &seen[found], &end, diag);
        if (status == HN_OK) {
            snprintf(kept[found]->means[0], HN_SPEC_MAX, "%s", name_of(&MEANS[i]));
            found++;
        } else if (status == HN_ERR_MEMORY || end == HN_WALK_STOPPED) {
            return end == HN_WALK_STOPPED
                       ? hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL, "stopped on request")
                       : status;
        } else {
            note_refusal(refused, name_of(&MEANS[i]), diag);
        }
    }
    return found == HN_REF_MEANS
               ? HN_OK
               : hn_diag_set(diag, HN_ERR_NO_CONVERGENCE, NULL,
                             "take a shorter time; errors cannot be measured without a reference",
                             "no reference solution could be computed to t = %g s: %s", T, refused);
}

hn_status hn_ref_create(const hn_system *sys, const double *q, const double *v, double T,
                        const hn_ref_opts *opts, hn_ref **out, hn_diag *diag) {
    const hn_ref_opts o = opts ? *opts : hn_ref_opts_default();
    hn_ref *kept[HN_REF_MEANS] = {NULL, NULL};
    recorder seen[HN_REF_MEANS];
    char refused[320] = "";

    if (!(T > 0) || !isfinite(T)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/time", NULL,
                           "the end time is %g s; it must be above 0", T);
    }

    // two independent solutions
    hn_arena *arena = hn_arena_create(0);
    hn_errors *errors = NULL;
    hn_status status = arena ? hn_errors_create(sys, arena, &errors) : HN_ERR_MEMORY;
    HN_THEN(status,
            find_two(sys, q, v, T, o.n > 0 ? o.n : HN_REF_TIMES, &o, kept, seen, refused, diag));
    status = hn_system_stopped(sys, status, diag);
    if (status == HN_OK) {
        // their difference is the error of the first
        set_scales(kept[0], errors, sys, &seen[0]);
        compare(kept[0], kept[1], errors);
        memcpy(kept[0]->means[1], kept[1]->means[0], HN_SPEC_MAX);
        memcpy(kept[0]->refused, refused, sizeof refused);
        *out = kept[0];
        kept[0] = NULL;
    }

    hn_ref_free(kept[0]);
    hn_ref_free(kept[1]);
    hn_errors_free(errors);
    hn_arena_free(arena);
    return status;
}
