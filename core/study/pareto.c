#include "study/pareto.h"

#include "base/strbuf.h"
#include "base/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const cost_names[HN_COST_COUNT] = {"time", "operations", "evaluations"};
static const char *const cost_units[HN_COST_COUNT] = {"s", "op", ""};

const char *hn_cost_name(hn_cost_kind kind) {
    HN_ASSERT((int)kind >= 0 && kind < HN_COST_COUNT);
    return cost_names[kind];
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

/// The error as it may be claimed.
static double claimed(const hn_wp *wp, const hn_wp_point *p, hn_error_kind error) {
    return fmax(p->worst[error], HN_WP_ABOVE_REFERENCE * wp->ref->error[error]);
}

static int takes_part(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
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

/// Where a method reaches the accuracy for the least, or level -1.
static hn_place cheapest(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                         hn_cost_kind kind, int m, double accuracy) {
    hn_place best = {m, -1, 0};
    const hn_wp_point *before = NULL;
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (!takes_part(wp, classes, error, kind, m, k)) {
            continue;
        }
        const double e = claimed(wp, p, error);
        double cost = hn_wp_cost(p, kind);
        if (e <= accuracy) {
            if (before && claimed(wp, before, error) > accuracy &&
                hn_wp_cost(before, kind) < cost) {
                cost = between(accuracy, claimed(wp, before, error), hn_wp_cost(before, kind), e,
                               cost);
            }
            if (best.level < 0 || cost < best.cost) {
                best = (hn_place){m, k, cost};
            }
        }
        before = p;
    }
    return best;
}

static const hn_wp_point *at(const hn_wp *wp, hn_place place) {
    return &wp->methods[place.method].point[place.level];
}

/// 1 if the second cannot be told from the first: counts are exact, times are not.
static int too_close(const hn_wp *wp, hn_place a, hn_place b, hn_cost_kind cost) {
    if (cost != HN_COST_TIME) {
        return b.cost <= a.cost;
    }
    const hn_wp_point *p = at(wp, a), *r = at(wp, b);
    return b.cost < HN_PARETO_CLOSE * a.cost ||
           b.cost * r->low / r->median <= a.cost * p->high / p->median;
}

static void fill_band(const hn_wp *wp, const hn_class *classes, const hn_pareto *p, hn_band *band) {
    hn_place place[HN_WP_METHODS];
    band->best = band->next = (hn_place){-1, -1, 0};
    for (int m = 0; m < wp->n_methods; m++) {
        place[m] = cheapest(wp, classes, p->error, p->cost, m, band->accuracy);
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
    if (band->next.level >= 0) {
        band->ratio = band->next.cost / band->best.cost;
    }
    for (int m = 0; m < wp->n_methods && band->best.level >= 0; m++) {
        if (m != band->best.method && place[m].level >= 0 &&
            too_close(wp, band->best, place[m], p->cost)) {
            band->close[band->n_close++] = m;
        }
    }
}

static int is_timed_too_seldom(const hn_wp *wp) {
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state == HN_WP_DONE && p->n_samples < HN_WP_ENOUGH) {
                return 1;
            }
        }
    }
    return 0;
}

void hn_wp_pareto(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                  hn_pareto *out) {
    *out = (hn_pareto){
        .cost = cost, .error = error, .few = cost == HN_COST_TIME && is_timed_too_seldom(wp)};
    for (int d = 1; d <= HN_PARETO_BANDS; d++) {
        hn_band band = {.accuracy = pow(10, -d)};
        fill_band(wp, classes, out, &band);
        if (band.best.level < 0) {
            return;
        }
        out->band[out->n_bands++] = band;
    }
}

int hn_wp_on_front(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                   int m, int k) {
    const hn_wp_point *p = &wp->methods[m].point[k];
    if (!takes_part(wp, classes, error, cost, m, k)) {
        return 0;
    }
    for (int i = 0; i < wp->n_methods; i++) {
        for (int j = 0; j < wp->n_levels; j++) {
            const hn_wp_point *other = &wp->methods[i].point[j];
            if (takes_part(wp, classes, error, cost, i, j) &&
                hn_wp_cost(other, cost) <= hn_wp_cost(p, cost) &&
                claimed(wp, other, error) <= claimed(wp, p, error) &&
                (hn_wp_cost(other, cost) < hn_wp_cost(p, cost) ||
                 claimed(wp, other, error) < claimed(wp, p, error))) {
                return 0;
            }
        }
    }
    return 1;
}

// the race -------------------------------------------------------------------------------------------------------

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
            return before ? between(cost, before->cost.ops, claimed(wp, before, error), p->cost.ops,
                                    claimed(wp, p, error))
                          : (double)NAN;
        }
        smallest = fmin(smallest, claimed(wp, p, error));
        before = p;
    }
    *is_bound = before != NULL;
    return before ? smallest : (double)NAN;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// To two digits.
static double round_2(double x) {
    const double unit = pow(10, floor(log10(x)) - 1);
    return round(x / unit) * unit;
}

/// Costs at which most methods have points: between the median of their cheapest points and that of their dearest.
static int race_costs(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                      double cost[HN_RACE_COSTS]) {
    double low[HN_WP_METHODS], high[HN_WP_METHODS];
    int n = 0;
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
    qsort(low, (size_t)n, sizeof *low, ascending);
    qsort(high, (size_t)n, sizeof *high, ascending);
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

// words ----------------------------------------------------------------------------------------------------------

/// The methods that share the first place, a bit each.
static unsigned winners(const hn_band *band) {
    unsigned set = 1u << band->best.method;
    for (int i = 0; i < band->n_close; i++) {
        set |= 1u << band->close[i];
    }
    return set;
}

static void put_amount(hn_strbuf *b, double cost, hn_cost_kind kind) {
    char text[HN_SI_TEXT];
    hn_si_format(cost, cost_units[kind], 2, text);
    hn_strbuf_printf(b, "%s%s", text, kind == HN_COST_EVALS ? " evaluations" : "");
}

static void put_sentence(hn_strbuf *b, const hn_wp *wp, const hn_pareto *p, int first, int last) {
    const hn_band *coarse = &p->band[first], *fine = &p->band[last];
    if (first == last) {
        hn_strbuf_printf(b, "Error of %.0e: ", coarse->accuracy);
    } else {
        hn_strbuf_printf(b, "Errors of %.0e to %.0e: ", coarse->accuracy, fine->accuracy);
    }
    hn_strbuf_add(b, wp->methods[coarse->best.method].spelling);
    for (int i = 0; i < coarse->n_close; i++) {
        hn_strbuf_printf(b, "%s%s", i + 1 < coarse->n_close ? ", " : " and ",
                         wp->methods[coarse->close[i]].spelling);
    }
    hn_strbuf_add(b, coarse->n_close ? ", too close to rank: from " : ", ");
    put_amount(b, coarse->best.cost, p->cost);
    if (first != last) {
        hn_strbuf_add(b, " to ");
        put_amount(b, fine->best.cost, p->cost);
    }
    if (coarse->n_close == 0 && fine->next.level >= 0) {
        hn_strbuf_printf(b, "; next %s at %.3g times that", wp->methods[fine->next.method].spelling,
                         fine->ratio);
    } else if (fine->next.level < 0) {
        hn_strbuf_add(b, "; no other method gets there");
    }
    hn_strbuf_add(b, ".\n");
}

void hn_pareto_sentences(hn_strbuf *b, const hn_wp *wp, const hn_pareto *p) {
    if (p->few) {
        hn_strbuf_printf(b, "Some points were timed fewer than %d times: times are not ranked.\n",
                         HN_WP_ENOUGH);
        return;
    }
    for (int i = 0; i < p->n_bands;) {
        int last = i;
        while (last + 1 < p->n_bands && winners(&p->band[i]) == winners(&p->band[last + 1])) {
            last++;
        }
        put_sentence(b, wp, p, i, last);
        i = last + 1;
    }
}
