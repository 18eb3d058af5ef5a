// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/crossing.h"

#include "dynamics/compile/coordinates.h"

#include "study/incidents/motion.h"
#include "study/incidents/pose.h"
#include "study/incidents/rank.h"
#include "study/incidents/report.h"

#include <math.h>
#include <string.h>

static const double BLOWN_UP = 100; // of the largest kinetic energy in regular configurations
static const double STRIDE = 0.1;   // of the length: sigma_min is probed as often along the way
// sigma_min changes by no more than this much of its largest on a way of one length: lever arms
// turn by an angle that large
static const double STEEP = 3;
// of the largest sigma_min: reported as a configuration that was passed. A cubic across a stride of
// half a length is off by about 1e-3 of it
static const double SINGULAR = 0.02;
static const double GOLDEN = 0.6180339887498949;
enum { MOST = 16, CUTS = 12 };

/// sigma_min where the share x of the step is over; leaves that configuration in `inside_q`.
static double sigma_at(hn_watch *w, double x) {
    const hn_stepping *s = w->run;
    hn_singular_record *r = &w->singular;
    const double h = s->now.t - s->before.t;
    const double end = x * x * (3 - 2 * x), v0 = h * x * (1 - x) * (1 - x),
                 v1 = h * x * x * (x - 1);
    for (int i = 0; i < s->info.nv; i++) {
        r->inside[i] = end * r->whole[i] + v0 * s->before.v[i] + v1 * s->now.v[i];
    }
    memcpy(r->inside_q, s->before.q, (size_t)s->info.nq * sizeof *r->inside_q);
    hn_system_move(s->sys, r->inside_q, r->inside);
    return hn_singularity_probe(r->monitor, s->before.t + x * h, r->inside_q);
}

/// Returns, of the ends and n probes evenly between them, the share of the step with the lowest
/// sigma_min.
static double find_lowest(hn_watch *w, int n, double *lowest, double *ends) {
    const double start = w->singular.info.sigma_min, end = sigma_at(w, 1);
    double at = start < end ? 0 : 1;
    *ends = *lowest = fmin(start, end);
    for (int k = 1; k <= n; k++) {
        const double x = (double)k / (n + 1), sigma = sigma_at(w, x);
        if (sigma < *lowest) {
            *lowest = sigma;
            at = x;
        }
    }
    return at;
}

/// Golden section for the lowest sigma_min in [low, high].
static double descend(hn_watch *w, double low, double high) {
    double x[2] = {high - GOLDEN * (high - low), low + GOLDEN * (high - low)};
    double sigma[2] = {sigma_at(w, x[0]), sigma_at(w, x[1])};
    for (int k = 0; k < CUTS; k++) {
        if (sigma[0] < sigma[1]) {
            high = x[1];
            x[1] = x[0];
            sigma[1] = sigma[0];
            x[0] = high - GOLDEN * (high - low);
            sigma[0] = sigma_at(w, x[0]);
        } else {
            low = x[0];
            x[0] = x[1];
            sigma[0] = sigma[1];
            x[1] = low + GOLDEN * (high - low);
            sigma[1] = sigma_at(w, x[1]);
        }
    }
    return sigma[0] < sigma[1] ? x[0] : x[1];
}

static void report(hn_watch *w, double x, double sigma) {
    const hn_stepping *s = w->run;
    const hn_singular_record *r = &w->singular;
    const double h = s->now.t - s->before.t, t = s->before.t + x * h;
    hn_incident *i = hn_incident_report(
        w, &hn_incident_near_singular, "sigma_min", sigma, SINGULAR * r->largest,
        "one step of %.3g s went across an almost singular configuration (J almost loses rank): "
        "the smallest singular value of J, sigma_min, is %.2g there, the largest %.2g",
        h, sigma, r->info.sigma_max);
    if (i) {
        i->t = t;
        hn_pose_describe(w, i, t, r->inside_q, sigma);
    }
}

void hn_crossing_check(hn_watch *w) {
    const hn_stepping *s = w->run;
    const hn_singular_record *r = &w->singular;
    if (s->info.nc == 0 || !s->has_step || hn_incident_holds(&w->log, HN_INCIDENT_NEAR_SINGULAR) ||
        hn_incident_holds(&w->log, HN_INCIDENT_RANK_LOSS)) {
        return;
    }
    const double way = hn_motion_way(w, s->before.q, w->singular.whole);
    if (!(r->info.sigma_min < STEEP * way * r->largest)) {
        return;
    }

    // the step of a run that blows up has no way along which the motion went
    if (r->kinetic > 0 && w->measure.kinetic > BLOWN_UP * r->kinetic) {
        return;
    }

    // probes along the way, then the lowest one more closely
    const int n = (int)fmin(MOST, ceil(way / STRIDE));
    const double stride = 1.0 / (n + 1);
    double lowest = 0, ends = 0;
    const double at = find_lowest(w, n, &lowest, &ends);
    if (!(lowest < STEEP * way * stride * r->largest)) {
        return;
    }
    const double x = descend(w, fmax(0, at - stride), fmin(1, at + stride));
    const double sigma = sigma_at(w, x);

    // lowest at an end: it is seen there, and may be on its way to the next step
    if (sigma < SINGULAR * r->largest && sigma < ends) {
        report(w, x, sigma);
    }
}
