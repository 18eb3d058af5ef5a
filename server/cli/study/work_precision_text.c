// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/work_precision_text.h"

#include "base/units.h"
#include "cli/shell/args.h"
#include "cli/shell/table.h"
#include "render/look.h"
#include "terminal/cost_plot.h"
#include "terminal/width.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Writes the error that may be claimed: "< 1e-12" where the reference is no more accurate.
static void put_error(hn_table *t, const hn_wp *wp, hn_error_kind kind, double error) {
    const double bound = HN_WP_ABOVE_REFERENCE * wp->ref->error[kind];
    if (!isfinite(error)) {
        hn_table_cell(t, "-");
    } else if (error < bound) {
        hn_table_cell(t, "< %.0e", bound);
    } else {
        hn_table_cell(t, "%.1e", error);
    }
}

static double claimed(const hn_wp *wp, const hn_wp_point *p) {
    const hn_error_kind kind = hn_wp_ranked_error(wp);
    return fmax(p->worst[kind], HN_WP_ABOVE_REFERENCE * wp->ref->error[kind]);
}

/// The coarsest point with the smallest ranked error that can be claimed, or -1.
static int best_point(const hn_wp *wp, int m) {
    int best = -1;
    for (int k = 0; k < wp->n_levels; k++) {
        const hn_wp_point *p = &wp->methods[m].point[k];
        if (p->state == HN_WP_DONE &&
            (best < 0 || claimed(wp, p) < claimed(wp, &wp->methods[m].point[best]))) {
            best = k;
        }
    }
    return best;
}

static void put_best(hn_table *t, const hn_wp *wp, int m) {
    const int k = best_point(wp, m);
    if (k < 0) {
        for (int i = 0; i < 7; i++) {
            hn_table_cell(t, "-");
        }
        return;
    }
    const hn_wp_point *p = &wp->methods[m].point[k];
    hn_table_cell(t, "%s=%.3g", wp->methods[m].adaptive ? "rtol" : "h", p->size);
    put_error(t, wp, HN_ERROR_Q, p->worst[HN_ERROR_Q]);
    put_error(t, wp, HN_ERROR_REACTION, p->worst[HN_ERROR_REACTION]);
    put_error(t, wp, HN_ERROR_GAP, p->worst[HN_ERROR_GAP]);
    put_error(t, wp, HN_ERROR_ENERGY, p->worst[HN_ERROR_ENERGY]);
    hn_table_quantity(t, p->median, "s");
    hn_table_quantity(t, hn_cost_known_ops(&p->cost), "op");
}

static int count(const hn_wp *wp, int m, hn_wp_state state) {
    int n = 0;
    for (int k = 0; k < wp->n_levels; k++) {
        n += wp->methods[m].point[k].state == state;
    }
    return n;
}

static void put_methods(hn_strbuf *b, const hn_wp *wp) {
    static const char *const heads[] = {"",         "method", "done",   "most accurate", "error q",
                                        "reaction", "gap",    "energy", "CPU",           "ops"};
    hn_table t;
    hn_table_init(&t);
    for (int i = 0; i < 10; i++) {
        hn_table_column(&t, heads[i], i > 1);
    }
    for (int m = 0; m < wp->n_methods; m++) {
        hn_table_cell(&t, "%s", hn_look_glyph(m));
        hn_table_cell(&t, "%s", wp->methods[m].spelling);
        hn_table_cell(&t, "%d/%d", count(wp, m, HN_WP_DONE), wp->n_levels);
        put_best(&t, wp, m);
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static void put_verdicts(hn_strbuf *b, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    hn_strbuf_add(b, "\nVerdict on each method, from all its sizes of step or tolerance\n");
    for (int m = 0; m < wp->n_methods; m++) {
        hn_strbuf_printf(b, "  %s %-28s %s\n", hn_look_glyph(m), wp->methods[m].spelling,
                         hn_study_classes(study)[m].text);
    }
}

// the plot ----

static void put_plot(hn_strbuf *b, const hn_wp *wp, bool legend) {
    hn_cost_plot *plot = malloc(sizeof *plot);
    if (!plot) {
        b->failed = 1;
        return;
    }
    hn_cost_plot_take(plot, wp, hn_cost_plot_has_times(wp));
    hn_cost_plot_text(b, plot, hn_terminal_columns(), legend, hn_terminal_colours());
    free(plot);
}

// answers ----

static void put_sentences(hn_strbuf *b, const hn_wp *wp, const hn_pareto *p) {
    const size_t before = b->n;
    hn_pareto_sentences(b, wp, p);
    if (b->n == before) {
        hn_strbuf_add(b, "Nothing to rank: no run has an error of 0.1 or less.\n");
    }
}

/// The cheapest methods by one kind of cost.
static void put_front_of(hn_strbuf *b, const hn_study *study, hn_cost_kind cost) {
    const hn_wp *wp = hn_study_wp(study);
    const hn_error_kind error = hn_wp_ranked_error(wp);
    hn_pareto p;
    hn_wp_pareto(wp, hn_study_classes(study), error, cost, &p);
    hn_strbuf_printf(b, "Cheapest by %s, for %s up to t = %.4g s\n", hn_cost_name(cost),
                     error == HN_ERROR_Q ? "errors" : "the error of the energy", wp->ref->T);
    put_sentences(b, wp, &p);
}

static void put_front(hn_strbuf *b, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    const hn_error_kind error = hn_wp_ranked_error(wp);
    hn_pareto p;
    const int first = hn_cost_plot_has_times(wp) ? HN_COST_TIME : HN_COST_OPS;
    for (int cost = first; cost <= HN_COST_OPS; cost++) {
        hn_strbuf_add(b, cost > first ? "\n" : "");
        put_front_of(b, study, (hn_cost_kind)cost);
    }
    if (error != HN_ERROR_Q) {
        hn_wp_pareto(wp, hn_study_classes(study), HN_ERROR_Q, HN_COST_OPS, &p);
        hn_strbuf_add(b, "\nFor the error of the coordinates\n");
        put_sentences(b, wp, &p);
    }
}

static void put_race(hn_strbuf *b, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    static const char *const heads[HN_RACE_COSTS] = {"error", "error", "error"};
    const hn_error_kind kind = hn_wp_ranked_error(wp);
    hn_race race;
    hn_table t;
    hn_wp_race(wp, hn_study_classes(study), kind, &race);

    // no cost at which the methods can be compared: no table
    if (race.n == 0) {
        return;
    }

    // columns: the costs at which the methods are compared
    hn_table_init(&t);
    hn_table_column(&t, "", 0);
    hn_table_column(&t, "for as many operations", 0);
    for (int i = 0; i < race.n; i++) {
        hn_table_column(&t, heads[i], 1);
    }

    // the first line gives these costs
    hn_table_cell(&t, "%s", "");
    hn_table_cell(&t, "%s", "");
    for (int i = 0; i < race.n; i++) {
        hn_table_quantity(&t, race.cost[i], "op");
    }

    // the error of each method at each cost
    for (int m = 0; m < wp->n_methods; m++) {
        hn_table_cell(&t, "%s", hn_look_glyph(m));
        hn_table_cell(&t, "%s", wp->methods[m].spelling);
        for (int i = 0; i < race.n; i++) {
            if (race.is_bound[i][m]) {
                hn_table_cell(&t, "\xe2\x89\xa4 %.1e", race.error[i][m]);
            } else {
                put_error(&t, wp, kind, race.error[i][m]);
            }
        }
    }

    // the heading, then the table
    hn_strbuf_printf(b,
                     "\nError of the %s for the same cost, interpolated between measured points "
                     "(\xe2\x89\xa4: a cheaper run has this error; -: every run costs more)\n",
                     hn_error_title(kind));
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static bool is_alike(const hn_wp_point *a, const hn_wp_point *b) {
    return a->state == b->state && a->t_reached == b->t_reached &&
           strcmp(a->reason, b->reason) == 0;
}

static int count_alike(const hn_wp *wp, int m, int k) {
    const hn_wp_point *point = wp->methods[m].point;
    int n = 0;
    for (int i = 0; i < wp->n_levels; i++) {
        n += is_alike(&point[i], &point[k]);
    }
    return n;
}

static int told_before(const hn_wp *wp, int m, int k) {
    const hn_wp_point *point = wp->methods[m].point;
    int told = 0;
    for (int i = 0; i < k; i++) {
        told |= is_alike(&point[i], &point[k]);
    }
    return told;
}

/// "...h=0.003955696202531646": the size that ends a spelling, in as many digits as are read.
static void shorten_size(char spelling[HN_SPEC_MAX]) {
    char *size = strrchr(spelling, '=');
    double value;
    if (size && hn_number_parse(size + 1, &value)) {
        const size_t room = HN_SPEC_MAX - (size_t)(size + 1 - spelling);
        snprintf(size + 1, room, "%.4g", value);
    }
}

/// Writes every run that did not reach the end, with its reason; runs of a method that never began,
/// all for one reason, share a line.
static void put_failures(hn_strbuf *b, const hn_wp *wp) {
    int any = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            // only runs that failed or were skipped; a repeated reason is written once
            const hn_wp_point *p = &wp->methods[m].point[k];
            if (p->state != HN_WP_FAILED && p->state != HN_WP_SKIPPED) {
                continue;
            }
            if (p->t_reached == 0 && told_before(wp, m, k)) {
                continue;
            }

            // the method with its size
            char spelling[HN_SPEC_MAX];
            hn_wp_spelling(wp, m, k, spelling);
            shorten_size(spelling);
            hn_strbuf_printf(b, "%s  %s %s", any++ ? "" : "\nRuns that did not reach the end\n",
                             hn_look_glyph(m), spelling);

            // how far it came, and how many others share the reason
            if (p->t_reached > 0) {
                hn_strbuf_printf(b, " ended at t = %.4g s", p->t_reached);
            }
            const int others = p->t_reached == 0 ? count_alike(wp, m, k) - 1 : 0;
            if (others > 0) {
                hn_strbuf_printf(b, " and %d other size%s", others, others == 1 ? "" : "s");
            }

            hn_strbuf_printf(b, ": %s\n", p->reason);
        }
    }
}

/// Writes how well the two reference solutions agree, and what cannot be measured for it.
static void put_reference(hn_strbuf *b, const hn_wp *wp) {
    const hn_ref *ref = wp->ref;
    const double digits = hn_ref_digits(ref);
    if (digits >= 1) {
        hn_strbuf_printf(
            b, "Reference: %s and %s agree to %.1f digits; errors below %.0e cannot be measured.\n",
            ref->means[0], ref->means[1], digits, HN_WP_ABOVE_REFERENCE * ref->error[HN_ERROR_Q]);
        return;
    }
    hn_strbuf_printf(b, "Reference: none of the coordinates: %s and %s share no digit at t = %g s.",
                     ref->means[0], ref->means[1], ref->T);
    if (hn_wp_is_beyond_horizon(wp)) {
        hn_strbuf_printf(b, " They agree up to about t = %.2g s: try --time %.2g.", wp->horizon,
                         wp->horizon);
    }
    hn_strbuf_add(b, "\n");
}

static void put_head(hn_strbuf *b, const hn_study *study) {
    const hn_scene *scene = hn_model_scene(hn_study_model(study));
    const hn_wp *wp = hn_study_wp(study);
    hn_strbuf_printf(b, "%s, to t = %g s\n", scene->title ? scene->title : scene->id, wp->ref->T);
    put_reference(b, wp);
    hn_strbuf_add(b, "Times: ");
    hn_study_put_times(b, study);
    hn_strbuf_printf(b, ".\nChaos: %s.\n\n", hn_study_chaos(study)->why);
}

void hn_study_text(hn_strbuf *b, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    put_head(b, study);
    put_methods(b, wp);
    put_verdicts(b, study);
    hn_strbuf_add(b, "\n");
    put_plot(b, wp, false);
    hn_strbuf_add(b, "\n");
    put_front(b, study);
    put_race(b, study);
    put_failures(b, wp);
}

void hn_study_plot_text(hn_strbuf *b, const hn_study *study) {
    put_front(b, study);
    hn_strbuf_add(b, "\n");
    put_plot(b, hn_study_wp(study), true);
}
