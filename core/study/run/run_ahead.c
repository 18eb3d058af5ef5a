// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "study/run/run_internal.h"

#include "linalg/dense.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Singular poses on the way of a run: when the next one comes, what waits there, and whether the motion came out of it on the
// branch on which it went in.

static const double CLOSE =
    0.1; // of the largest sigma_min so far: headings are not taken from here
static const double RANGE = 0.35; // and from here on they are compared
static const double CHANGE =
    0.5; // a continuation that changes the heading by more than this says nothing
static const double INSIDE = 0.02; // of the largest sigma_min: an isolated pose is left at once
static const double WANDER = 0.3;  // of the length, in the loops' own displacement
static const double FAR = 0.1;     // ratio above which multipliers are those of a regular pose

static hn_run_ahead *ahead_of(hn_run *run) {
    return &run->watch.ahead;
}

hn_status hn_run_ahead_create(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    hn_run_heading *headings[] = {&a->older, &a->last, &a->now};
    for (int i = 0; i < 3; i++) {
        headings[i]->e = hn_arena_doubles(run->arena, (size_t)run->info.nv + 1);
    }
    a->entered = hn_arena_doubles(run->arena, (size_t)run->info.nq);
    a->smooth = hn_arena_doubles(run->arena, (size_t)run->info.nv + 1);
    return hn_arena_failed(run->arena) ? HN_ERR_MEMORY
                                       : hn_singularity_create(run->sys, run->arena, &a->radar);
}

void hn_run_ahead_free(hn_run *run) {
    hn_singularity_free(ahead_of(run)->radar);
}

void hn_run_ahead_start(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    hn_singularity_reset(a->radar);
    a->info = (hn_singularity_info){.ratio = 1, .ahead = HUGE_VAL};
    a->largest = a->multiplier = 0;
    a->n_headings = a->passing = a->inside = a->driven = 0;
    a->fastest = 0;
    a->fallbacks = 0;
}

int hn_run_is_near_singular(const hn_run *run) {
    const hn_run_ahead *a = &run->watch.ahead;
    return run->info.nc > 0 && a->info.sigma_min < CLOSE * a->largest;
}

int hn_run_passed_singular(const hn_run *run, double *t) {
    const hn_incident *incident = NULL;
    const int n = hn_run_incidents(run, &incident);
    for (int i = 0; i < n; i++) {
        if (incident[i].code == HN_INCIDENT_NEAR_SINGULAR ||
            incident[i].code == HN_INCIDENT_RANK_LOSS) {
            *t = incident[i].t;
            return 1;
        }
    }
    return 0;
}

void hn_run_explain_pose(hn_run *run) {
    const hn_run_ahead *a = ahead_of(run);
    char *reason = run->summary.reason;
    const size_t used = strlen(reason);
    if (run->info.nc > 0 && a->info.sigma_min < INSIDE * a->largest) {
        snprintf(reason + used, sizeof run->summary.reason - used,
                 "; J all but loses rank there (sigma_min %.2g of %.2g), and what the step has to "
                 "solve with it",
                 a->info.sigma_min, a->largest);
    }
}

// --- what waits there -----------------------------------------------------------------------------------------------

static void add(hn_incident *i, const char *format, ...) HN_PRINTF(2, 3);
static void add(hn_incident *i, const char *format, ...) {
    const size_t used = strlen(i->message);
    va_list args;
    va_start(args, format);
    vsnprintf(i->message + used, sizeof i->message - used, format, args);
    va_end(args);
}

static const char *body_name(const hn_run *run, int body) {
    return body >= 0 ? hn_system_scene(run->sys)->bodies[body].name : "ground";
}

static void add_rows(const hn_run *run, hn_incident *i, const hn_singularity_pose *pose) {
    for (int k = 0; k < pose->n_rows; k++) {
        add(i, "%s%s", k ? ", " : "; rows ", hn_system_row_name(run->sys, pose->rows[k]));
    }
    if (pose->n_rows == 0) {
        return;
    }
    const int loop = hn_system_row_loop(run->sys, pose->rows[0]);
    const int joint = loop >= 0 ? hn_system_loop_joint(run->sys, loop) : -1;
    if (joint >= 0) {
        const hn_joint *j = &hn_system_scene(run->sys)->joints[joint];
        add(i, " (between %s and %s)", body_name(run, j->parent), body_name(run, j->child));
    }
}

void hn_run_describe_pose(hn_run *run, hn_incident *i, double t, const double *q,
                          double sigma_min) {
    hn_run_ahead *a = ahead_of(run);
    hn_singularity_pose pose;
    hn_singularity_pose_at(a->radar, t, q, sigma_min, &pose);
    add_rows(run, i, &pose);
    if (pose.mobility > pose.mobility_before) {
        add(i, "; %d freedoms there instead of %d", pose.mobility, pose.mobility_before);
    }
    switch (pose.branches) {
    case HN_BRANCHES_CROSS:
        add(i, "; two branches of motion cross");
        break;
    case HN_BRANCHES_NONE:
        add(i, "; no motion leads through: it locks");
        break;
    case HN_BRANCHES_CUSP:
        add(i, "; two branches touch");
        break;
    case HN_BRANCHES_UNKNOWN:
        break;
    }
    a->passing = 1 + (int)(i - run->incidents);
}

// --- the heading ----------------------------------------------------------------------------------------------------
// With one freedom the direction of motion is a matter of the pose alone, and smooth on a branch; it is a line, since a motion
// may turn back. A mechanism without freedoms that is driven has its speeds by pose and time, whose direction belongs to it:
// there the heading has time as one more entry, as long as the fastest speeds seen, and it is an arrow.

static int freedoms(const hn_run *run) {
    return run->info.nv - run->watch.start_rank;
}

static int has_heading(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    a->driven |= hn_norm_max(run->info.nc, hn_eval_get(run->watch.eval, HN_TERM_PHI_T)) > 0;
    return freedoms(run) == (a->driven ? 0 : 1);
}

static double angle_between(const hn_run *run, const double *x, const double *y) {
    const int n = run->info.nv + 1;
    const double c = hn_dot(n, x, y) / (hn_norm2(n, x) * hn_norm2(n, y));
    return acos(fmin(1, fmax(-1, c)));
}

/// 0 when nothing moves.
static int take_heading(hn_run *run, hn_run_heading *h) {
    hn_run_ahead *a = ahead_of(run);
    const int n = run->info.nv;
    const double *scale = hn_singularity_scale(a->radar);
    h->t = run->now.t;
    for (int i = 0; i < n; i++) {
        h->e[i] = run->now.v[i] / scale[i];
    }
    a->fastest = fmax(a->fastest, hn_norm2(n, h->e));
    h->e[n] = freedoms(run) == 0 ? a->fastest : 0;
    const double size = hn_norm2(n + 1, h->e);
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

/// The heading that continues the last two smoothly to the present time, in `out`; returns how far it moved from the last.
static double continue_heading(const hn_run_ahead *a, int n, double *out) {
    const double s = (a->now.t - a->last.t) / (a->last.t - a->older.t);
    double change = 0;
    for (int i = 0; i < n; i++) {
        const double step = s * (a->last.e[i] - a->older.e[i]);
        out[i] = a->last.e[i] + step;
        change = hypot(change, step);
    }
    return change;
}

/// `angle` HUGE_VAL: the headings are too far apart to be compared.
static void finish_passing(hn_run *run, double angle) {
    hn_run_ahead *a = ahead_of(run);
    if (a->passing > 0 && a->passing <= run->n_incidents) {
        hn_incident *i = &run->incidents[a->passing - 1];
        if (angle == HUGE_VAL) {
            add(i, "; the steps are too long to say which way the run went on");
        } else if (angle > HN_RUN_WARN_TURN) {
            add(i, "; the run turned off there by %.2g rad", angle);
        } else {
            add(i, "; the run went straight on");
        }
        i->revision = ++run->revision;
    }
    a->passing = 0;
}

static void tell_branch(hn_run *run, double angle) {
    const hn_run_ahead *a = &run->watch.ahead;
    const int passed = a->passing || a->info.sigma_min < RANGE * a->largest;
    hn_incident *i = hn_run_tell(
        run, HN_INCIDENT_BRANCH_FLIP, "turn", angle, HN_RUN_WARN_TURN,
        passed
            ? "the run came out of a singular pose on another branch: its direction turned by "
              "%.2g rad from the smooth continuation"
            : "the last step jumped to another branch: its direction turned by %.2g rad from the "
              "smooth continuation, and its speeds do not explain how far it went",
        angle);
    if (i) {
        hn_run_remedy_robust(run, i->remedy[0]);
        hn_run_remedy_finer(run, 0.25, i->remedy[1]);
    }
}

double hn_run_way(hn_run *run, const double *from, double *step) {
    const double *J = hn_eval_get(run->watch.eval, HN_TERM_J);
    double most = 0;
    hn_system_difference(run->sys, from, run->now.q, step);
    for (int i = 0; i < run->info.nc; i++) {
        const double unit = hn_system_row_is_length(run->sys, i) ? run->length : 1;
        for (int j = 0; j < run->info.nv; j++) {
            most =
                fmax(most, fabs(J[(size_t)i * (size_t)run->info.nv + (size_t)j] * step[j]) / unit);
        }
    }
    return most;
}

// Poses where J loses rank lie apart on the way of a mechanism of one freedom. One that moves on and stays singular has turned off
// into a motion of which they are all that there is: some of its links folded onto each other.
static void look_at_stay(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    if (a->driven || freedoms(run) != 1 || !(a->info.sigma_min < INSIDE * a->largest)) {
        a->inside = 0;
        return;
    }
    if (!a->inside) {
        a->inside = 1;
        memcpy(a->entered, run->now.q, (size_t)run->info.nq * sizeof *a->entered);
        return;
    }
    const double way = a->inside == 1 ? hn_run_way(run, a->entered, run->watch.a) : 0;
    if (!(way > WANDER)) {
        return;
    }
    a->inside = 2;
    hn_incident *i = hn_run_tell(
        run, HN_INCIDENT_BRANCH_FLIP, "way", way, WANDER,
        "the run moves on and J stays without its rank (sigma_min is %.2g of %.2g at most): it "
        "turned off at a singular pose into a motion that has some links folded onto each other",
        a->info.sigma_min, a->largest);
    if (i) {
        hn_run_remedy_robust(run, i->remedy[0]);
        hn_run_remedy_finer(run, 0.25, i->remedy[1]);
    }
}

/// Whether the heading may be compared with its continuation: past a singular pose, or when the step itself looks like a jump.
static int is_suspect(const hn_run *run) {
    const hn_run_ahead *a = &run->watch.ahead;
    // where a motion turns back it hardly moves, and half of that is no jump: one goes as far as a step does elsewhere
    const double way = run->watch.swiftest * (run->now.t - run->before.t);
    return a->passing || a->info.sigma_min < RANGE * a->largest ||
           hn_run_unexplained_motion(run, way) > HN_RUN_WARN_JUMP;
}

static void look_at_heading(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    const int n = run->info.nv + 1;
    if (!has_heading(run) || a->info.sigma_min < CLOSE * a->largest ||
        !take_heading(run, &a->now)) {
        return;
    }
    if (a->n_headings > 0 && freedoms(run) == 1) {
        align(n, a->last.e, a->now.e);
    }
    if (a->n_headings == 2 && is_suspect(run)) {
        const double change = continue_heading(a, n, a->smooth);
        if (freedoms(run) == 1) {
            align(n, a->now.e, a->smooth);
        }
        const double angle = change < CHANGE ? angle_between(run, a->smooth, a->now.e) : HUGE_VAL;
        if (angle < HUGE_VAL && angle > HN_RUN_WARN_TURN) {
            tell_branch(run, angle);
        } else {
            hn_run_over(run, HN_INCIDENT_BRANCH_FLIP);
        }
        finish_passing(run, angle);
    }
    const hn_run_heading spare = a->older;
    a->older = a->last;
    a->last = a->now;
    a->now = spare;
    a->n_headings += a->n_headings < 2;
}

// --- the look ---------------------------------------------------------------------------------------------------------

static void look_at_prediction(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    if (!(a->info.ahead < HUGE_VAL)) {
        if (a->info.sigma_min > RANGE * a->largest) {
            hn_run_over(run, HN_INCIDENT_RANK_AHEAD);
        }
        return;
    }
    hn_incident *i = hn_run_tell(run, HN_INCIDENT_RANK_AHEAD, "time to go", a->info.ahead, 0,
                                 "J loses rank in %.3g s, at t = %.4g s, if the motion goes on as "
                                 "now: sigma_min is %.2g of %.2g and falls to zero there",
                                 a->info.ahead, run->now.t + a->info.ahead, a->info.sigma_min,
                                 a->info.sigma_max);
    if (i) {
        hn_run_remedy_robust(run, i->remedy[0]);
    }
}

static void look_at_multipliers(hn_run *run, const double *lambda) {
    hn_run_ahead *a = ahead_of(run);
    const double size = lambda ? hn_norm_max(run->info.nc, lambda) : 0;
    if (a->info.ratio > FAR || a->multiplier == 0) {
        a->multiplier = fmax(a->multiplier, size);
        hn_run_over(run, HN_INCIDENT_MULTIPLIERS);
        return;
    }
    if (size > HN_RUN_WARN_MULTIPLIERS * a->multiplier) {
        hn_run_tell(run, HN_INCIDENT_MULTIPLIERS, "|lambda|", size,
                    HN_RUN_WARN_MULTIPLIERS * a->multiplier,
                    "the multipliers grew to %.3g, %.2g times what they were away from singular "
                    "poses",
                    size, size / a->multiplier);
    }
}

// the condition of K grows as the square of what sigma loses; it is estimated only where it can matter
static void look_at_condition(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    double kappa = 0;
    if (a->info.ratio * a->info.ratio * HN_RUN_WARN_CONDITION > 1) {
        hn_run_over(run, HN_INCIDENT_ILL_CONDITIONED);
        return;
    }
    if (run->watch.active & (1u << HN_INCIDENT_ILL_CONDITIONED) ||
        hn_accel_condition(run->watch.accel, run->now.t, run->now.q, run->now.v, &kappa) != HN_OK ||
        !(kappa > HN_RUN_WARN_CONDITION)) {
        return;
    }
    const double digits = fmax(0, -log10(DBL_EPSILON) - log10(kappa));
    hn_run_tell(run, HN_INCIDENT_ILL_CONDITIONED, "condition", kappa, HN_RUN_WARN_CONDITION,
                kappa > HN_CONDITION_LOST
                    ? "the condition number is %.2g: no digit of the multipliers is left (%.0f)"
                    : "the condition number is %.2g: about %.0f digits of the multipliers are left",
                kappa, digits);
}

static void look_at_fallbacks(hn_run *run) {
    hn_run_ahead *a = ahead_of(run);
    const long long now = run->summary.cost.fallbacks, more = now - a->fallbacks;
    a->fallbacks = now;
    if (more == 0 || run->watch.start_rank < run->info.nc) {
        hn_run_over(run,
                    HN_INCIDENT_SOLVER); // rows that always depend on others have been told as such
        return;
    }
    hn_run_tell(
        run, HN_INCIDENT_SOLVER, "dense solves", (double)more, 0,
        "the sparse LDL' of the tape lost a pivot or a row; the dense least-norm solve, the "
        "next rung, answered in its place, %lld times so far",
        now);
}

void hn_run_ahead_look(hn_run *run, const double *lambda) {
    hn_run_ahead *a = ahead_of(run);
    if (run->info.nc == 0) {
        return;
    }
    hn_singularity_check(a->radar, run->now.t, run->now.q, &a->info);
    a->largest = fmax(a->largest, a->info.sigma_min);
    look_at_prediction(run);
    look_at_multipliers(run, lambda);
    look_at_condition(run);
    look_at_fallbacks(run);
    look_at_heading(run);
    look_at_stay(run);
}
