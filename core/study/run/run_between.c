// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "study/run/run_internal.h"

#include <math.h>
#include <string.h>

// Singular poses that a long step has gone across: neither of its ends is near them, and the looks at its ends see nothing. Between
// the ends the motion is a cubic through both states, in the coordinates that move the first to the second.

static const double STRIDE = 0.1; // of the length: sigma_min is looked at as often along the way
// sigma_min changes by no more than this much of its largest on a way of one length: lever arms turn by an angle that large
static const double STEEP = 3;
// of the largest sigma_min: told as a pose that was passed. A cubic across a stride of half a length is off by about 1e-3 of it
static const double SINGULAR = 0.02;
static const double GOLDEN = 0.6180339887498949;
enum { MOST = 16, CUTS = 12 };

hn_status hn_run_between_create(hn_run *run) {
    hn_run_between *b = &run->watch.between;
    b->q = hn_arena_doubles(run->arena, (size_t)run->info.nq);
    b->step = hn_arena_doubles(run->arena, (size_t)run->info.nv);
    b->part = hn_arena_doubles(run->arena, (size_t)run->info.nv);
    return hn_arena_failed(run->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// sigma_min where the share s of the step is over; leaves that pose in `q`.
static double sigma_at(hn_run *run, double s) {
    hn_run_between *b = &run->watch.between;
    const double h = run->now.t - run->before.t;
    const double end = s * s * (3 - 2 * s), v0 = h * s * (1 - s) * (1 - s),
                 v1 = h * s * s * (s - 1);
    for (int i = 0; i < run->info.nv; i++) {
        b->part[i] = end * b->step[i] + v0 * run->before.v[i] + v1 * run->now.v[i];
    }
    memcpy(b->q, run->before.q, (size_t)run->info.nq * sizeof *b->q);
    hn_system_move(run->sys, b->q, b->part);
    return hn_singularity_probe(run->watch.ahead.radar, run->before.t + s * h, b->q);
}

/// Of the ends and n looks between them, evenly apart: the share of the step with the lowest sigma_min.
static double find_lowest(hn_run *run, int n, double *lowest, double *ends) {
    const double start = run->watch.ahead.info.sigma_min, end = sigma_at(run, 1);
    double at = start < end ? 0 : 1;
    *ends = *lowest = fmin(start, end);
    for (int k = 1; k <= n; k++) {
        const double s = (double)k / (n + 1), sigma = sigma_at(run, s);
        if (sigma < *lowest) {
            *lowest = sigma;
            at = s;
        }
    }
    return at;
}

/// Golden section for the lowest sigma_min in [low, high].
static double descend(hn_run *run, double low, double high) {
    double x[2] = {high - GOLDEN * (high - low), low + GOLDEN * (high - low)};
    double sigma[2] = {sigma_at(run, x[0]), sigma_at(run, x[1])};
    for (int k = 0; k < CUTS; k++) {
        if (sigma[0] < sigma[1]) {
            high = x[1];
            x[1] = x[0];
            sigma[1] = sigma[0];
            x[0] = high - GOLDEN * (high - low);
            sigma[0] = sigma_at(run, x[0]);
        } else {
            low = x[0];
            x[0] = x[1];
            sigma[0] = sigma[1];
            x[1] = low + GOLDEN * (high - low);
            sigma[1] = sigma_at(run, x[1]);
        }
    }
    return sigma[0] < sigma[1] ? x[0] : x[1];
}

static void tell(hn_run *run, double s, double sigma) {
    const hn_run_ahead *a = &run->watch.ahead;
    const double t = run->before.t + s * (run->now.t - run->before.t);
    hn_incident *i =
        hn_run_tell(run, HN_INCIDENT_NEAR_SINGULAR, "sigma_min", sigma, SINGULAR * a->largest,
                    "one step of %.3g s went across a pose in which J all but loses rank, at about "
                    "t = %.4g s: sigma_min is %.2g of %.2g there",
                    run->now.t - run->before.t, t, sigma, a->info.sigma_max);
    if (i) {
        i->t = t;
        hn_run_remedy_robust(run, i->remedy[0]);
        hn_run_remedy_finer(run, 0.01, i->remedy[1]);
        hn_run_describe_pose(run, i, t, run->watch.between.q, sigma);
    }
}

void hn_run_look_between(hn_run *run) {
    hn_run_watch_state *w = &run->watch;
    const unsigned known = 1u << HN_INCIDENT_NEAR_SINGULAR | 1u << HN_INCIDENT_RANK_LOSS;
    if (run->info.nc == 0 || !run->has_step || w->active & known) {
        return;
    }
    const double way = hn_run_way(run, run->before.q, w->between.step);
    const double largest = w->ahead.largest;
    if (!(w->ahead.info.sigma_min < STEEP * way * largest)) {
        return;
    }
    const int n = (int)fmin(MOST, ceil(way / STRIDE));
    const double stride = 1.0 / (n + 1);
    double lowest = 0, ends = 0;
    const double at = find_lowest(run, n, &lowest, &ends);
    if (!(lowest < STEEP * way * stride * largest)) {
        return;
    }
    const double s = descend(run, fmax(0, at - stride), fmin(1, at + stride));
    const double sigma = sigma_at(run, s);
    // lowest at an end: it is seen there, and may be on its way to the next step
    if (sigma < SINGULAR * largest && sigma < ends) {
        tell(run, s, sigma);
    }
}
