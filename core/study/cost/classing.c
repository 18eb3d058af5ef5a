// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/classing.h"

#include "base/units.h"
#include "study/cost/convergence.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

enum { FITTED = 4 };                 // points: three halvings
static const double SATURATED = 0.5; // errors of the motion's own size have no slope
static const double FLAT = 0.35;     // of theory's order: slopes below it belong to a floor
static const double ABOVE_FLOOR = 3; // times the floor, for a point that is fitted
static const double WANDER =
    0.1; // errors at a floor differ by less than this factor from the first there
// no error below it is trusted to have a slope: what thousands of steps in double add up to
static const double ROUNDING = 1e-13;
// errors below it may be near what rounding adds up to over a long motion
static const double BENDS_BELOW = 1e-8;
static const double SAME_ORDER = 0.3;  // orders that differ by less belong to one error
static const double LEAST_ORDER = 0.5; // below it nothing converges

static const char *const names[HN_CLASS_COUNT] = {
#define HN_CLASS_ROW(code, name) name,
    HN_CLASS_LIST(HN_CLASS_ROW)
#undef HN_CLASS_ROW
};

const char *hn_class_name(hn_class_kind kind) {
    HN_ASSERT((int)kind >= 0 && kind < HN_CLASS_COUNT);
    return names[kind];
}

/// The finished points of a method, coarse ones first.
typedef struct ladder {
    int n, level[HN_WP_LEVELS];
    double x[HN_WP_LEVELS]; ///< T / steps: the mean step [s]
    double e[HN_WP_LEVELS], end[HN_WP_LEVELS], own[HN_WP_LEVELS];
    double energy[HN_WP_LEVELS]; ///< error of the energy
} ladder;

static ladder collect(const hn_wp *wp, int m) {
    ladder l = {0};
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (p->state == HN_WP_DONE && p->steps > 0) {
            l.level[l.n] = k;
            l.x[l.n] = wp->ref->T / (double)p->steps;
            l.e[l.n] = p->worst[HN_ERROR_Q];
            l.end[l.n] = p->end[HN_ERROR_Q];
            l.energy[l.n] = p->worst[HN_ERROR_ENERGY];
            l.own[l.n++] = p->own;
        }
    }
    return l;
}

/// Slope between point i - 1 and point i; 0 where the step did not fall.
static double slope(const ladder *l, int i) {
    const double dx = log(l->x[i - 1] / l->x[i]);
    return dx > 1e-3 && l->e[i] > 0 && l->e[i - 1] > 0 ? log(l->e[i - 1] / l->e[i]) / dx : 0;
}

/// Returns 1 and fills `c` where the finest points agree with each other but not with the
/// reference. Points with the same steps (a tolerance that has no effect) prove nothing.
static bool goes_elsewhere(const hn_wp *wp, const ladder *l, hn_class *c) {
    if (l->n < 3) {
        return false;
    }
    const int last = l->n - 1;
    const double own = fmax(l->own[last], l->own[last - 1]), far = l->end[last];
    const double known = HN_WP_ABOVE_REFERENCE * wp->ref->error[HN_ERROR_Q];
    if (far > HN_CLASS_OFFSET && far > known && far > HN_CLASS_APART * own &&
        l->x[last] < l->x[0]) {
        c->kind = HN_CLASS_ELSEWHERE;
        c->offset = far;
        c->own = l->own[last];
        return true;
    }
    return false;
}

/// First point of the flat end, below which errors only wander. l->n when there is none.
static int find_floor(const ladder *l, double theory, double known) {
    const double sure = fmax(known, ROUNDING);
    const double flat = FLAT * (isnan(theory) ? 1 : theory);
    for (int i = 0; i < l->n; i++) {
        if (l->e[i] > sure && (i == 0 || slope(l, i) >= flat || l->e[i] > HN_CLASS_OFFSET)) {
            // still falling, or too large for a floor: the method is not yet convergent
            continue;
        }
        int stays = 1;
        for (int j = i + 1; j < l->n; j++) {
            stays &= l->e[j] >= WANDER * l->e[i] || l->e[j] <= sure;
        }
        if (stays) {
            return i;
        }
    }
    return l->n;
}

/// Puts the order of points first..last, and the slopes between neighbours, into c.
static void fit_points(const ladder *l, int first, int last, hn_class *c) {
    double x[HN_WP_LEVELS] = {0}, e[HN_WP_LEVELS] = {0}, energy[HN_WP_LEVELS] = {0};
    bool energy_seen = true;
    c->first = l->level[first];
    c->last = l->level[last];
    c->low = HUGE_VAL;
    c->high = -HUGE_VAL;
    for (int i = first; i <= last; i++) {
        x[i - first] = l->x[i];
        e[i - first] = l->e[i];
        energy[i - first] = l->energy[i];
        energy_seen &= l->energy[i] > ROUNDING;
        if (i > first) {
            c->low = fmin(c->low, slope(l, i));
            c->high = fmax(c->high, slope(l, i));
        }
    }
    const int n = last - first + 1;
    c->order = hn_fit_order(n, x, e);
    c->energy_order = energy_seen ? hn_fit_order(n, x, energy) : (double)NAN;
    c->finest = slope(l, last);
}

/// Returns the first of at most `most` points up to `last` that have a slope.
static int first_of(const ladder *l, int last, int most) {
    int first = last + 1;
    for (int used = 0; first > 0 && used < most && l->e[first - 1] < SATURATED; used++) {
        first--;
    }
    return first;
}

/// Fits the finest straight part of the ladder above the sizes where rounding flattens the slope.
/// That part counts only if its errors are so small that rounding can follow, and if all finer
/// slopes are flatter; otherwise c stays as it is.
static void fit_above_rounding(const ladder *l, int last, int most, hn_class *c) {
    const hn_class bent = *c;
    double steepest = -HUGE_VAL;
    for (int end = last - 1; end >= 2 && l->e[end] < BENDS_BELOW; end--) {
        const int first = first_of(l, end, most);
        steepest = fmax(steepest, slope(l, end + 1));
        if (end - first < 2) {
            break;
        }
        fit_points(l, first, end, c);
        if (c->high - c->low <= HN_CLASS_SPREAD && steepest < c->low) {
            c->rounding = l->level[end + 1];
            return;
        }
    }
    *c = bent;
}

/// The finest points above the floor that have a slope.
static void fit(const ladder *l, int n, int most, hn_class *c) {
    const double lowest = isnan(c->floor) ? ROUNDING : fmax(ROUNDING, ABOVE_FLOOR * c->floor);
    int last = n - 1;
    while (last >= 0 && l->e[last] <= lowest) {
        last--;
    }
    const int first = first_of(l, last, most);
    if (last - first < 1) {
        return;
    }
    fit_points(l, first, last, c);
    if (c->high - c->low > HN_CLASS_SPREAD) {
        fit_above_rounding(l, last, most, c);
    }
}

/// Why slopes are not those of an order, and a run to try: over a tenth of the time, errors grow
/// less and their leading terms hold from longer steps on.
static void why_unsettled(const hn_class *c, double T, char out[200]) {
    const bool above = c->high > c->theory + HN_CLASS_SPREAD,
               below = c->low < c->theory - HN_CLASS_SPREAD;
    const char *why = above && below ? "the leading terms of the error cancel at some of these "
                                       "sizes"
                      : above        ? "the errors still fall faster than theory, so the steps do "
                                       "not resolve the motion yet"
                      : below        ? "the errors fall more slowly than theory"
                                     : "the slopes change from size to size";
    snprintf(out, 200, ": %s; try a shorter time, %.3g s", why, T / 10);
}

/// Sizes that are still to be run.
static int count_pending(const hn_wp *wp, int m) {
    int n = 0;
    for (int k = 0; k < wp->n_levels; k++) {
        n += wp->methods[m].point[k].state == HN_WP_PENDING;
    }
    return n;
}

static void describe_failure(const hn_wp *wp, int m, const ladder *l, hn_class *c) {
    const hn_wp_point *p = &wp->methods[m].point[0];
    for (int k = 0; k < wp->n_levels; k++) {
        if (wp->methods[m].point[k].state == HN_WP_FAILED) {
            p = &wp->methods[m].point[k];
        }
    }
    snprintf(c->text, sizeof c->text, "%d of %d sizes reached the end%s%.180s", l->n, wp->n_levels,
             p->reason[0] ? ": " : "", p->reason);
}

/// Why a straight ladder has another order than its integrator; "" where nothing says why.
static void explain_order(const hn_class *c, char out[140]) {
    out[0] = '\0';
    if (c->order > c->theory && fabs(c->order - c->energy_order) <= SAME_ORDER) {
        snprintf(out, 140,
                 ": the coordinates follow the error of the energy, which falls with order %.2f "
                 "at these sizes",
                 c->energy_order);
    } else if (c->order < c->theory && c->finest > c->order && c->finest <= c->theory) {
        snprintf(out, 140, ": the slope rises, to %.2f at the finest of these sizes", c->finest);
    }
}

/// The fine end of the ladder: a floor, or rounding; "" where neither shows.
static void describe_fine_end(const hn_wp *wp, int m, const hn_class *c, char floor[120]) {
    char size[HN_SI_TEXT];
    floor[0] = '\0';
    if (!isnan(c->floor)) {
        hn_si_format(c->floor_size, wp->methods[m].adaptive ? "" : "s", 2, size);
        if (wp->methods[m].adaptive) {
            snprintf(size, sizeof size, "%.0e", c->floor_size);
        }
        snprintf(floor, 120, "; the error stays at %.1e from %s = %s on", c->floor,
                 wp->methods[m].adaptive ? "rtol" : "h", size);
    }
    if (c->rounding >= 0) {
        hn_si_format(wp->methods[m].point[c->rounding].size, "s", 2, size);
        snprintf(floor, 120, "; from h = %s on rounding adds to the error", size);
    }
}

/// The observed order, or why there is none.
static void describe_order(const hn_wp *wp, int m, hn_class *c) {
    char floor[120], theory[48] = "";
    describe_fine_end(wp, m, c, floor);
    if (!isnan(c->theory)) {
        snprintf(theory, sizeof theory, " (theory %g)", c->theory);
    }
    if (c->kind == HN_CLASS_CONVERGES && (c->as_theory || isnan(c->theory))) {
        snprintf(c->text, sizeof c->text, "converges with order %.2f%s%s", c->order, theory, floor);
    } else if (c->kind == HN_CLASS_CONVERGES) {
        char why[140];
        explain_order(c, why);
        snprintf(c->text, sizeof c->text,
                 "converges with order %.2f, where its integrator has %g%s%s", c->order, c->theory,
                 why, floor);
    } else if (c->kind == HN_CLASS_FLOOR) {
        snprintf(c->text, sizeof c->text,
                 "the error does not fall with the size: it is %.1e from the coarsest size on",
                 c->floor);
    } else if (c->first >= 0 && c->last - c->first < 2) {
        snprintf(c->text, sizeof c->text,
                 "not in the asymptotic range: only two points have an error between 0.5 and "
                 "rounding, with a slope of %.1f%s%s",
                 c->order, theory, floor);
    } else if (c->first >= 0) {
        char why[200];
        why_unsettled(c, wp->ref->T, why);
        snprintf(c->text, sizeof c->text,
                 "not in the asymptotic range: slopes from %.1f to %.1f%s%s%s", c->low, c->high,
                 theory, why, floor);
    } else {
        snprintf(c->text, sizeof c->text,
                 "not in the asymptotic range: fewer than two points have an error between 0.5 and "
                 "rounding");
    }
}

/// Gives a method the class of those that have no order, and the reason: too few points, a chaotic
/// motion, another limit. Returns 0 where the method has none of these.
static bool has_no_order(const hn_wp *wp, int m, const ladder *l, hn_class *out) {
    // too few points, so far or for good
    const int pending = l->n < 2 ? count_pending(wp, m) : 0;
    if (pending > 0) {
        out->kind = HN_CLASS_UNSETTLED;
        snprintf(out->text, sizeof out->text, "not known yet: %d of %d sizes are still to be run",
                 pending, wp->n_levels);
        return true;
    }
    if (l->n < 2) {
        out->kind = HN_CLASS_FAILED;
        describe_failure(wp, m, l, out);
        return true;
    }

    // a chaotic motion
    if (hn_wp_is_beyond_horizon(wp)) {
        snprintf(out->text, sizeof out->text,
                 "not classed: the motion is chaotic, and after t = %.3g s, before the end, the "
                 "error of the coordinates does not measure the quality of a method",
                 wp->horizon);
        return true;
    }

    // another limit
    if (goes_elsewhere(wp, l, out)) {
        snprintf(out->text, sizeof out->text,
                 "converges to another motion: %.1e away from the reference, while its finest "
                 "sizes differ by %.0e",
                 out->offset, out->own);
        return true;
    }
    return false;
}

void hn_wp_classify(const hn_wp *wp, int m, hn_class *out) {
    const ladder l = collect(wp, m);
    const hn_wp_method *method = &wp->methods[m];
    const double known = HN_WP_ABOVE_REFERENCE * wp->ref->error[HN_ERROR_Q];
    const int order = method->spec.stepper->order;
    *out = (hn_class){.kind = HN_CLASS_UNSETTLED,
                      .theory = order > 0 ? order : (double)NAN,
                      .order = (double)NAN,
                      .floor = (double)NAN,
                      .first = -1,
                      .last = -1,
                      .rounding = -1};
    if (has_no_order(wp, m, &l, out)) {
        return;
    }

    // the floor: its size and the largest error there
    const int floor = find_floor(&l, out->theory, known);
    if (floor < l.n) {
        out->floor_size = method->point[l.level[floor]].size;
        out->floor = known;
        for (int i = floor; i < l.n; i++) {
            out->floor = fmax(out->floor, l.e[i]);
        }
    }

    // the order: adaptive steps do not halve evenly, so all points are fitted and not the last few
    fit(&l, floor, method->adaptive ? HN_WP_LEVELS : FITTED, out);

    // the verdict
    const double allowed =
        method->adaptive ? HN_CLASS_FROM_THEORY_ADAPTIVE * out->theory : HN_CLASS_FROM_THEORY_FIXED;
    out->as_theory = fabs(out->order - out->theory) <= allowed;
    const int fitted = out->first >= 0 ? out->last - out->first + 1 : 0;
    if (fitted >= 3 && out->order > LEAST_ORDER &&
        ((method->adaptive && out->as_theory) || out->high - out->low <= HN_CLASS_SPREAD)) {
        out->kind = HN_CLASS_CONVERGES;
    } else if (floor < l.n && fitted < 3) {
        out->kind = HN_CLASS_FLOOR;
    }
    describe_order(wp, m, out);
}
