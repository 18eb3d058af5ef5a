// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/heading.h"

#include "linalg/dense.h"
#include "study/incidents/motion.h"

#include <math.h>
#include <string.h>

// With one degree of freedom the direction of motion is a line, since a motion may turn back. A
// mechanism without degrees of freedom that is driven has its velocities by configuration and time,
// whose direction belongs to it: there the heading has time as one more entry, as long as the
// fastest velocities seen, and it is an arrow.

static const double CLOSE =
    0.1; // of the largest sigma_min so far: headings are not taken from here
static const double RANGE = 0.35; // and from here on they are compared
static const double CHANGE = 0.5; // a continuation that changes the heading by more says nothing
static const double INSIDE =
    0.02; // of the largest sigma_min: an isolated configuration is left at once
enum { PILOT_FINER = 8, PILOT_MOST = 400 }; // steps of the pilot run: in one of the run, in all
static const double ACROSS = 0.5;           // of HN_RUN_WARN_TURN, see is_across()
static const double WANDER = 0.3;           // of the length, in the loops' own displacement

hn_status hn_heading_create(hn_watch *w) {
    hn_heading_record *r = &w->heading;
    hn_arena *arena = w->run->arena;
    hn_heading *headings[] = {&r->older, &r->last, &r->now};
    for (int i = 0; i < 3; i++) {
        headings[i]->e = hn_arena_doubles(arena, (size_t)w->run->info.nv + 1);
    }
    r->entered = hn_arena_doubles(arena, (size_t)w->run->info.nq);
    r->outside.q = hn_arena_doubles(arena, (size_t)w->run->info.nq);
    r->outside.v = hn_arena_doubles(arena, (size_t)w->run->info.nv);
    r->smooth = hn_arena_doubles(arena, (size_t)w->run->info.nv + 1);
    return hn_arena_failed(arena) ? HN_ERR_MEMORY : HN_OK;
}

void hn_heading_start(hn_watch *w) {
    hn_heading_record *r = &w->heading;
    r->n = r->inside = 0;
    r->driven = false;
    r->fastest = 0;
}

static bool has_heading(hn_watch *w) {
    hn_heading_record *r = &w->heading;
    r->driven |= hn_norm_max(w->run->info.nc, w->phi_t) > 0;
    return hn_motion_dof(w) == (r->driven ? 0 : 1);
}

static double angle_between(int n, const double *x, const double *y) {
    const double c = hn_dot(n, x, y) / (hn_norm2(n, x) * hn_norm2(n, y));
    return acos(fmin(1, fmax(-1, c)));
}

/// Returns false when nothing moves.
static bool take_heading(hn_watch *w, hn_heading *h) {
    hn_heading_record *r = &w->heading;
    const int n = w->run->info.nv;
    const double *scale = hn_singularity_scale(w->singular.monitor);
    h->t = w->run->now.t;
    for (int i = 0; i < n; i++) {
        h->e[i] = w->run->now.v[i] / scale[i];
    }
    const double speed = hn_norm2(n, h->e);
    r->fastest = fmax(r->fastest, speed);
    h->e[n] = hn_motion_dof(w) == 0 ? r->fastest : 0;

    const double size = h->e[n] == 0 ? speed : hn_norm2(n + 1, h->e);
    for (int i = 0; i <= n && size > 0; i++) {
        h->e[i] /= size;
    }
    return size > 0;
}

static void align(int n, const double *with, double *e) {
    const double sign = hn_dot(n, with, e) < 0 ? -1 : 1;
    for (int i = 0; i < n; i++) {
        e[i] *= sign;
    }
}

/// The heading that continues the last two smoothly to the present time, in `smooth`; returns how
/// far it moved from the last.
static double continue_heading(hn_heading_record *r, int n) {
    const double share = (r->now.t - r->last.t) / (r->last.t - r->older.t);
    double change = 0;
    for (int i = 0; i < n; i++) {
        const double step = share * (r->last.e[i] - r->older.e[i]);
        r->smooth[i] = r->last.e[i] + step;
        change = hypot(change, step);
    }
    return change;
}

/// The longest way that a step of this size goes. Near a turning point the steps are short, and
/// half of one is no jump: a jump is as long as a step elsewhere.
static double way_of_step(const hn_watch *w) {
    return w->swiftest * (w->run->now.t - w->run->before.t);
}

/// Returns whether the heading is to be compared: past a singular configuration, or when the step
/// itself looks like a jump.
static bool is_suspect(const hn_watch *w) {
    const hn_singular_record *s = &w->singular;
    return s->passing || s->info.sigma_min < RANGE * s->largest ||
           hn_motion_unexplained(w, way_of_step(w)) > HN_RUN_WARN_JUMP;
}

// Loops that stand open by g lead past a singular configuration like links of other lengths do, at
// a distance of about the root of g. There a pilot run proves nothing, unless they are closed to
// rounding or sigma_min stays well above that, and above the share of its largest that short steps
// can miss.
static const double CLOSED = 1e-12, ABOVE = 5, REGULAR = 0.1;

/// Links that all but line up turn fast without leaving their branch. A pilot run with finer steps
/// from where the last direction was taken tells that from a jump: it arrives at the present one.
static bool is_explained(hn_watch *w) {
    hn_heading_record *r = &w->heading;
    const double gap = w->measure.gap / w->length, regular = REGULAR * w->singular.largest;
    double lowest = 0;
    const hn_pilot *pilot = hn_motion_pilot(w, &r->outside, w->run->now.t, &lowest);
    const double *scale = hn_singularity_scale(w->singular.monitor);
    const int n = w->run->info.nv;
    double *e = r->smooth;
    for (int i = 0; pilot && i < n; i++) {
        e[i] = hn_pilot_v(pilot)[i] / scale[i];
    }
    if (!pilot || !(hn_norm2(n, e) > 0)) {
        return false;
    }

    // branches meet at singular configurations alone: a step elsewhere may be wrong, but not so
    if (!w->singular.passing && lowest > regular &&
        hn_motion_unexplained(w, way_of_step(w)) < HN_RUN_WARN_JUMP) {
        return true;
    }
    align(n, r->now.e, e);
    return lowest >= (gap < CLOSED ? 0 : fmax(regular, ABOVE * sqrt(gap))) &&
           angle_between(n, e, r->now.e) < HN_RUN_WARN_TURN;
}

static void keep_outside(hn_watch *w) {
    const hn_stepping *s = w->run;
    w->heading.outside.t = s->now.t;
    memcpy(w->heading.outside.q, s->now.q, (size_t)s->info.nq * sizeof(double));
    memcpy(w->heading.outside.v, s->now.v, (size_t)s->info.nv * sizeof(double));
}

// Velocities that violate the constraints by g are off those that the loops allow by up to g /
// sigma_min: a penalty's springs swing across the motion where links nearly line up. A direction
// that may be off by a good part of what is reported says nothing about the branch.
static bool is_across(const hn_watch *w) {
    const double *scale = hn_singularity_scale(w->singular.monitor);
    double speed = 0;
    for (int i = 0; i < w->run->info.nv; i++) {
        speed = hypot(speed, w->run->now.v[i] / scale[i]);
    }
    const double across = w->measure.velocity_gap / (w->length * w->singular.info.sigma_min);
    return across > ACROSS * HN_RUN_WARN_TURN * speed;
}

double hn_heading_check(hn_watch *w) {
    hn_heading_record *r = &w->heading;
    const int n = w->run->info.nv + 1;
    const bool is_line = hn_motion_dof(w) == 1;
    double angle = -1;
    if (!has_heading(w) || w->singular.info.sigma_min < CLOSE * w->singular.largest ||
        !take_heading(w, &r->now)) {
        return angle;
    }
    if (is_across(w)) {
        r->n = 0; // begins anew where the velocities follow the loops again
        return HUGE_VAL;
    }
    if (r->n > 0 && is_line) {
        align(n, r->last.e, r->now.e);
    }
    if (r->n == 2 && is_suspect(w)) {
        const double change = continue_heading(r, n);
        if (is_line) {
            align(n, r->now.e, r->smooth);
        }
        angle = change < CHANGE ? angle_between(n, r->smooth, r->now.e) : HUGE_VAL;
    }
    r->explained =
        angle > HN_RUN_WARN_TURN && isfinite(angle) &&
        (is_line ? is_explained(w) : hn_motion_is_followed(w, &r->outside, &w->run->now));

    // the present one becomes the last
    const hn_heading spare = r->older;
    r->older = r->last;
    r->last = r->now;
    r->now = spare;
    r->n += r->n < 2;
    keep_outside(w);
    return angle;
}

// Configurations where J loses rank lie apart on the way of a mechanism of one degree of freedom.
// One that moves on and stays singular has turned off into a motion that consists of them: some of
// its links folded onto each other.
bool hn_heading_stays_singular(hn_watch *w, double *way) {
    hn_heading_record *r = &w->heading;
    if (r->driven || hn_motion_dof(w) != 1 ||
        !(w->singular.info.sigma_min < INSIDE * w->singular.largest)) {
        r->inside = 0;
        return false;
    }
    if (!r->inside) {
        r->inside = 1;
        memcpy(r->entered, w->run->now.q, (size_t)w->run->info.nq * sizeof *r->entered);
        return false;
    }
    *way = r->inside == 1 ? hn_motion_way(w, r->entered, w->scratch) : 0;
    if (!(*way > WANDER)) {
        return false;
    }
    r->inside = 2;
    return true;
}
