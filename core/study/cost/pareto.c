// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cost/pareto.h"

#include "base/strbuf.h"
#include "base/units.h"
#include "base/word_list.h"
#include "study/run/timing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const char *const cost_names[HN_COST_COUNT] = {"time", "operations", "evaluations"};
static const char *const cost_units[HN_COST_COUNT] = {"s", "op", ""};

const char *hn_cost_name(hn_cost_kind kind) {
    HN_ASSERT((int)kind >= 0 && kind < HN_COST_COUNT);
    return cost_names[kind];
}

static const char *const ranking_names[] = {
#define HN_RANKING_ROW(code, name) name,
    HN_RANKING_LIST(HN_RANKING_ROW)
#undef HN_RANKING_ROW
};

const char *hn_ranking_name(hn_ranking ranking) {
    HN_ASSERT((size_t)ranking < sizeof ranking_names / sizeof *ranking_names);
    return ranking_names[ranking];
}

double hn_wp_cost(const hn_wp_point *p, hn_cost_kind kind) {
    switch (kind) {
    case HN_COST_TIME:
        return p->median;
    case HN_COST_OPS:
        return p->cost.ops;
    default:
        return (double)p->cost.evals;
    }
}

hn_error_kind hn_wp_ranked_error(const hn_wp *wp) {
    return hn_wp_is_beyond_horizon(wp) ? HN_ERROR_ENERGY : HN_ERROR_Q;
}

double hn_wp_claimed(const hn_wp *wp, const hn_wp_point *p, hn_error_kind error) {
    return fmax(p->worst[error], HN_WP_ABOVE_REFERENCE * wp->ref->error[error]);
}

static bool takes_part(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                       hn_cost_kind cost, int m, int k) {
    const hn_wp_point *p = &wp->methods[m].point[k];
    return classes[m].kind != HN_CLASS_ELSEWHERE && p->state == HN_WP_DONE &&
           hn_wp_cost(p, cost) > 0 && isfinite(p->worst[error]);
}

/// y at x on the straight line in the logarithms through (x0, y0) and (x1, y1).
static double between(double x, double x0, double y0, double x1, double y1) {
    const double share = log(x / x0) / log(x1 / x0);
    return exp(log(y0) + share * (log(y1) - log(y0)));
}

hn_place hn_wp_reach(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                     hn_cost_kind kind, int m, double accuracy) {
    hn_place best = {m, -1, -1, 0};
    int before = -1;
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (!takes_part(wp, classes, error, kind, m, k)) {
            continue;
        }

        const double e = hn_wp_claimed(wp, p, error);
        hn_place here = {m, k, -1, hn_wp_cost(p, kind)};

        // accurate enough: the cost of just reaching it lies between this point and the coarser one
        if (e <= accuracy) {
            const hn_wp_point *coarser = before >= 0 ? &wp->methods[m].point[before] : NULL;
            if (coarser && e < accuracy && hn_wp_claimed(wp, coarser, error) > accuracy &&
                hn_wp_cost(coarser, kind) < here.cost) {
                here.from = before;
                here.cost = between(accuracy, hn_wp_claimed(wp, coarser, error),
                                    hn_wp_cost(coarser, kind), e, here.cost);
            }
            if (best.level < 0 || here.cost < best.cost) {
                best = here;
            }
        }

        before = k;
    }
    return best;
}

// ---- how reliable times are ----

/// Widens [low, high] by the smallest and the largest time of a point over its median; quartiles
/// and medians of the halves count.
static void widen(const hn_wp_point *p, double *low, double *high) {
    *low = fmin(*low, fmin(p->low, fmin(p->half[0], p->half[1])) / p->median);
    *high = fmax(*high, fmax(p->high, fmax(p->half[0], p->half[1])) / p->median);
}

/// Returns the range of the time at a place [s], from the one or two points that it comes from.
static void range_of(const hn_wp *wp, hn_place place, double *low, double *high) {
    const hn_wp_point *points = wp->methods[place.method].point;
    *low = *high = 1;
    widen(&points[place.level], low, high);
    if (place.from >= 0) {
        widen(&points[place.from], low, high);
    }
    *low *= place.cost;
    *high *= place.cost;
}

/// Returns 1 if two costs do not differ significantly: counts are exact, times are not.
static bool too_close(const hn_wp *wp, hn_place a, hn_place b, hn_cost_kind cost) {
    double low, high, unused;
    if (cost != HN_COST_TIME) {
        return b.cost <= a.cost;
    }
    range_of(wp, a, &unused, &high);
    range_of(wp, b, &low, &unused);
    return b.cost < HN_PARETO_CLOSE * a.cost || low <= high;
}

/// The point of a place whose halves are further apart than `apart`, which is raised to theirs.
static void find_unsteady(const hn_wp *wp, hn_place place, double *apart, hn_place *out) {
    const int levels[2] = {place.from, place.level};
    for (int i = 0; i < 2 && place.level >= 0; i++) {
        const double here =
            levels[i] >= 0 ? hn_wp_point_halves_apart(&wp->methods[place.method].point[levels[i]])
                           : 1;
        if (!(here <= *apart)) {
            *apart = here;
            *out = (hn_place){place.method, levels[i], -1, place.cost};
        }
    }
}

static void judge(const hn_wp *wp, hn_cost_kind cost, hn_band *band) {
    double apart = HN_PARETO_STEADY;
    band->unsteady.level = -1;
    band->ranking = band->n_close > 0 ? HN_RANKING_CLOSE : HN_RANKING_CLEAR;
    if (cost != HN_COST_TIME || band->n_close > 0) {
        return;
    }
    find_unsteady(wp, band->best, &apart, &band->unsteady);
    find_unsteady(wp, band->next, &apart, &band->unsteady);
    band->ranking = band->unsteady.level >= 0 ? HN_RANKING_UNSTEADY : HN_RANKING_CLEAR;
}

void hn_wp_band(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                double accuracy, hn_band *band) {
    hn_place place[HN_WP_METHODS];
    *band = (hn_band){.accuracy = accuracy};
    band->best = band->next = (hn_place){-1, -1, -1, 0};

    // the cheapest method and the next one
    for (int m = 0; m < wp->n_methods; m++) {
        place[m] = hn_wp_reach(wp, classes, error, cost, m, band->accuracy);
        if (place[m].level < 0) {
            continue;
        }
        if (band->best.level < 0 || place[m].cost < band->best.cost) {
            band->next = band->best;
            band->best = place[m];
        } else if (band->next.level < 0 || place[m].cost < band->next.cost) {
            band->next = place[m];
        }
    }

    // their ratio, and the methods that do not differ significantly from the cheapest
    if (band->next.level >= 0) {
        band->ratio = band->next.cost / band->best.cost;
    }
    for (int m = 0; m < wp->n_methods && band->best.level >= 0; m++) {
        if (m != band->best.method && place[m].level >= 0 &&
            too_close(wp, band->best, place[m], cost)) {
            band->close[band->n_close++] = place[m];
        }
    }

    judge(wp, cost, band);
}

static bool is_timed_too_seldom(const hn_wp *wp) {
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state == HN_WP_DONE && p->n_samples < HN_WP_ENOUGH) {
                return true;
            }
        }
    }
    return false;
}

void hn_wp_pareto(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                  hn_pareto *out) {
    const int timed = cost == HN_COST_TIME;
    *out = (hn_pareto){.cost = cost,
                       .error = error,
                       .few = timed && is_timed_too_seldom(wp),
                       .clocks_differ = timed && !(wp->clocks_apart <= HN_PARETO_STEADY),
                       .beyond_horizon = error <= HN_ERROR_REACTION && hn_wp_is_beyond_horizon(wp)};
    for (int d = 1; d <= HN_PARETO_BANDS && !out->beyond_horizon; d++) {
        hn_band band, counted = {.accuracy = pow(10, -d)};
        hn_wp_band(wp, classes, error, cost, pow(10, -d), &band);
        if (band.best.level < 0) {
            return;
        }
        if (timed) {
            hn_wp_band(wp, classes, error, HN_COST_OPS, pow(10, -d), &counted);
        }
        out->counted[out->n_bands] = counted;
        out->band[out->n_bands++] = band;
    }
}

// ---- the race ----

/// The error at a cost; *is_bound when the cost is more than any point's.
static double error_at(const hn_wp *wp, const hn_class *classes, hn_error_kind error, int m,
                       double cost, int *is_bound) {
    const hn_wp_point *before = NULL;
    double smallest = HUGE_VAL;
    *is_bound = 0;
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (!takes_part(wp, classes, error, HN_COST_OPS, m, k)) {
            continue;
        }
        if (p->cost.ops >= cost) {
            return before ? between(cost, before->cost.ops, hn_wp_claimed(wp, before, error),
                                    p->cost.ops, hn_wp_claimed(wp, p, error))
                          : (double)NAN;
        }
        smallest = fmin(smallest, hn_wp_claimed(wp, p, error));
        before = p;
    }
    *is_bound = before != NULL;
    return before ? smallest : (double)NAN;
}

/// Rounds to two digits.
static double round_2(double x) {
    const double unit = pow(10, floor(log10(x)) - 1);
    return round(x / unit) * unit;
}

/// Costs at which most methods have points: between the median of their cheapest points and that of
/// their dearest.
static int race_costs(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                      double cost[HN_RACE_COSTS]) {
    double low[HN_WP_METHODS], high[HN_WP_METHODS];
    int n = 0;

    // the cheapest and the dearest point of every method
    for (int m = 0; m < wp->n_methods; m++) {
        double lo = HUGE_VAL, hi = 0;
        for (int k = 0; k < wp->n_levels; k++) {
            if (takes_part(wp, classes, error, HN_COST_OPS, m, k)) {
                lo = fmin(lo, wp->methods[m].point[k].cost.ops);
                hi = fmax(hi, wp->methods[m].point[k].cost.ops);
            }
        }
        if (hi > lo) {
            low[n] = lo;
            high[n++] = hi;
        }
    }

    if (n == 0) {
        return 0;
    }

    // costs in equal ratios between the two medians
    hn_timing_sort(low, n);
    hn_timing_sort(high, n);
    const double a = low[n / 2], b = high[n / 2];
    for (int i = 0; i < HN_RACE_COSTS; i++) {
        cost[i] = round_2(a * pow(b / a, (i + 0.5) / HN_RACE_COSTS));
    }
    return HN_RACE_COSTS;
}

void hn_wp_race(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_race *out) {
    *out = (hn_race){0};
    out->n = race_costs(wp, classes, error, out->cost);
    for (int i = 0; i < out->n; i++) {
        for (int m = 0; m < wp->n_methods; m++) {
            out->error[i][m] = error_at(wp, classes, error, m, out->cost[i], &out->is_bound[i][m]);
        }
    }
}

// ---- words ----

/// Returns the methods that share the first place, one bit each.
static unsigned winners(const hn_band *band) {
    unsigned set = 1u << band->best.method;
    for (int i = 0; i < band->n_close; i++) {
        set |= 1u << band->close[i].method;
    }
    return set;
}

/// Returns 1 if two bands get the same sentence.
static bool say_the_same(const hn_pareto *p, int i, int j) {
    const hn_band *a = &p->band[i], *b = &p->band[j];
    if (a->ranking != b->ranking || winners(a) != winners(b)) {
        return false;
    }
    return a->ranking == HN_RANKING_CLEAR || p->cost != HN_COST_TIME ||
           (a->unsteady.method == b->unsteady.method &&
            winners(&p->counted[i]) == winners(&p->counted[j]));
}

/// "606 thousand operations", "1.1 million operations": a count has no prefix.
static void put_operations(hn_strbuf *b, double count) {
    static const char *const words[] = {"", " thousand", " million", " billion"};
    int i = 0;
    for (; count >= 999.5 && i < 3; i++) {
        count /= 1000;
    }
    char text[HN_SI_TEXT];
    hn_si_format(count, "", i > 0 ? 2 : 1, text);
    hn_strbuf_printf(b, "%s%s operations", text, words[i]);
}

static void put_amount(hn_strbuf *b, double cost, hn_cost_kind kind) {
    char text[HN_SI_TEXT];
    if (kind == HN_COST_OPS) {
        put_operations(b, cost);
        return;
    }
    hn_si_format(cost, cost_units[kind], 2, text);
    hn_strbuf_printf(b, "%s%s", text, kind == HN_COST_EVALS ? " evaluations" : "");
}

static const char *spelling_of(const hn_wp *wp, hn_place place) {
    return wp->methods[place.method].spelling;
}

/// "A, 1.0 s to 4.0 s; next B at 2 times that": who is cheapest from one band to another, and by
/// how much at the finer one.
static void put_ranking(hn_strbuf *b, const hn_wp *wp, const hn_band *coarse, const hn_band *fine,
                        hn_cost_kind cost) {
    hn_strbuf_add(b, spelling_of(wp, coarse->best));
    for (int i = 0; i < coarse->n_close; i++) {
        hn_strbuf_add(b, hn_word_joint(i + 1, coarse->n_close + 1, " and "));
        hn_strbuf_add(b, spelling_of(wp, coarse->close[i]));
    }
    hn_strbuf_add(b, coarse->n_close ? " alike, " : ", ");
    put_amount(b, coarse->best.cost, cost);
    if (fine->best.cost != coarse->best.cost) {
        hn_strbuf_add(b, " to ");
        put_amount(b, fine->best.cost, cost);
    }
    if (fine->next.level < 0) {
        hn_strbuf_add(b, wp->n_methods > 1 ? "; no other run of this study is as accurate" : "");
    } else if (coarse->n_close == 0) {
        hn_strbuf_add(b, "; next");
        if (fine->accuracy < coarse->accuracy) {
            hn_strbuf_printf(b, ", for %.0e,", fine->accuracy);
        }
        hn_strbuf_printf(b, " %s at %.3g times that", spelling_of(wp, fine->next), fine->ratio);
    }
}

/// Why times are not ranked there, with the numbers at the finer band.
static void put_doubt(hn_strbuf *b, const hn_wp *wp, const hn_band *fine) {
    if (fine->ranking == HN_RANKING_UNSTEADY) {
        const hn_wp_point *p = &wp->methods[fine->unsteady.method].point[fine->unsteady.level];
        hn_strbuf_printf(b, "the two halves of the timing of %s differ by %.0f %%, ",
                         spelling_of(wp, fine->unsteady), 100 * (hn_wp_point_halves_apart(p) - 1));
        put_amount(b, p->half[0], HN_COST_TIME);
        hn_strbuf_add(b, " and ");
        put_amount(b, p->half[1], HN_COST_TIME);
        return;
    }
    hn_strbuf_printf(b, "%s ", spelling_of(wp, fine->best));
    put_amount(b, fine->best.cost, HN_COST_TIME);
    for (int i = 0; i < fine->n_close; i++) {
        hn_strbuf_printf(b, "%s%s ", hn_word_joint(i + 1, fine->n_close + 1, " and "),
                         spelling_of(wp, fine->close[i]));
        put_amount(b, fine->close[i].cost, HN_COST_TIME);
    }
    hn_strbuf_add(b, " are too close to rank");
}

static void put_sentence(hn_strbuf *b, const hn_wp *wp, const hn_pareto *p, int first, int last) {
    const hn_band *coarse = &p->band[first], *fine = &p->band[last];
    if (first == last) {
        hn_strbuf_printf(b, "Error of %.0e: ", coarse->accuracy);
    } else {
        hn_strbuf_printf(b, "Errors of %.0e to %.0e: ", coarse->accuracy, fine->accuracy);
    }
    if (p->cost == HN_COST_TIME && fine->ranking != HN_RANKING_CLEAR) {
        hn_strbuf_add(b, "not ranked by time: ");
        put_doubt(b, wp, fine);
        hn_strbuf_add(b, "; by operations: ");
        put_ranking(b, wp, &p->counted[first], &p->counted[last], HN_COST_OPS);
    } else {
        put_ranking(b, wp, coarse, fine, p->cost);
    }
    hn_strbuf_add(b, ".\n");
}

static void put_clocks(hn_strbuf *b, const hn_wp *wp) {
    hn_strbuf_add(b, "Not ranked by time: ");
    if (isfinite(wp->clocks_apart)) {
        hn_strbuf_printf(b, "the same run took %.0f %% longer in one part than in another.\n",
                         100 * (wp->clocks_apart - 1));
    } else {
        hn_strbuf_add(b, "the parts have no run in common, so it is not known whether their "
                         "computers are equally fast.\n");
    }
}

void hn_pareto_sentences(hn_strbuf *b, const hn_wp *wp, const hn_pareto *p) {
    // reasons why nothing is ranked
    if (p->beyond_horizon) {
        hn_strbuf_printf(b,
                         "Not ranked: the motion is chaotic, and after t = %.3g s, before the end "
                         "at %.4g s, this error does not measure the quality of a method; the "
                         "error of the energy still does.\n",
                         wp->horizon, wp->ref->T);
        return;
    }
    if (p->few) {
        hn_strbuf_printf(b, "Not ranked by time: some points were timed fewer than %d times.\n",
                         HN_WP_ENOUGH);
        return;
    }
    if (p->clocks_differ) {
        put_clocks(b, wp);
        return;
    }

    // one sentence for neighbouring bands with the same answer
    for (int i = 0; i < p->n_bands;) {
        int last = i;
        while (last + 1 < p->n_bands && say_the_same(p, i, last + 1)) {
            last++;
        }
        put_sentence(b, wp, p, i, last);
        i = last + 1;
    }
}
