// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/wanted.h"

#include "base/units.h"
#include "session/model/model.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- reading ----

typedef struct unit {
    const char *name;
    double factor;
    bool is_length; ///< else a share, or an angle: both are errors as they are
} unit;

static const unit UNITS[] = {{"", 1, false},     {"%", 1e-2, false},
                             {"rad", 1, false},  {"mrad", 1e-3, false},
                             {"deg", 0, false},  {"m", 1, true},
                             {"cm", 1e-2, true}, {"mm", 1e-3, true},
                             {"um", 1e-6, true}, {"\xc2\xb5m", 1e-6, true},
                             {"nm", 1e-9, true}};
enum { N_UNITS = sizeof UNITS / sizeof *UNITS };

static const unit *find_unit(const char *text) {
    for (int i = 0; i < N_UNITS; i++) {
        if (strcmp(UNITS[i].name, text) == 0) {
            return &UNITS[i];
        }
    }
    return NULL;
}

bool hn_wanted_read(const char *text, double length, hn_wanted *out) {
    char copy[64], size[HN_SI_TEXT];
    snprintf(copy, sizeof copy, "%s", text);
    for (size_t n = strlen(copy); n > 0 && copy[n - 1] == ' '; n--) {
        copy[n - 1] = '\0';
    }
    for (char *c = copy; *c; c++) {
        *c = *c == ',' ? '.' : *c;
    }
    char *end;
    const double value = strtod(copy, &end);
    const unit *u = end == copy ? NULL : find_unit(end + strspn(end, " "));
    if (!u || !(value > 0) || !isfinite(value)) {
        return false;
    }
    const double factor = u->factor > 0 ? u->factor : acos(-1.0) / 180;
    out->error = value * factor / (u->is_length ? length : 1);
    if (u->is_length) {
        hn_si_format(length, "m", 3, size);
        snprintf(out->words, sizeof out->words,
                 "an error of %.20s at the end of a bar of %.30s (%.3g of its length)", copy, size,
                 out->error);
    } else {
        snprintf(out->words, sizeof out->words, "an error of %.3g", out->error);
    }
    return true;
}

// ---- the answer ----

/// A size of a method to run with, and what a run with that size costs.
typedef struct choice {
    int method; ///< -1: none
    double size, ops;
    bool measured; ///< a point of the study, else read off between two
    bool coarsest; ///< no coarser one was accurate enough or tried: a larger size may do as well
} choice;

/// The size at a place, between its point and the coarser one. The point itself is measured, so no
/// smaller size is ever needed.
static choice choose(const hn_wp *wp, const hn_place *place, hn_error_kind error, double wanted) {
    const hn_wp_point *points = wp->methods[place->method].point;
    const hn_wp_point *fine = &points[place->level];
    if (place->from < 0) {
        return (choice){place->method, fine->size, fine->cost.ops, true, true};
    }
    const hn_wp_point *coarse = &points[place->from];
    const double least = hn_wp_claimed(wp, fine, error);
    const double share = fmax(0, log(HN_WANTED_MARGIN * wanted / least) /
                                     log(hn_wp_claimed(wp, coarse, error) / least));
    if (share == 0) {
        return (choice){place->method, fine->size, fine->cost.ops, true, false};
    }
    const double size = fine->size * pow(coarse->size / fine->size, share);

    // two digits, and not larger than what was found
    const double digit = pow(10, floor(log10(size)) - 1);
    return (choice){place->method, floor(size / digit) * digit,
                    fine->cost.ops * pow(coarse->cost.ops / fine->cost.ops, share), false, false};
}

/// The cheapest choice and that of the next method, both by the cost of a run with the size that is
/// told.
static void rank(const hn_wp *wp, const hn_class *classes, hn_error_kind error, double wanted,
                 choice *best, choice *next) {
    *best = *next = (choice){.method = -1, .ops = HUGE_VAL};
    for (int m = 0; m < wp->n_methods; m++) {
        const hn_place place = hn_wp_reach(wp, classes, error, HN_COST_OPS, m, wanted);
        if (place.level < 0) {
            continue;
        }
        const choice here = choose(wp, &place, error, wanted);
        if (here.ops < best->ops) {
            *next = *best;
            *best = here;
        } else if (here.ops < next->ops) {
            *next = here;
        }
    }
}

/// "baumgarte@rk4 with h = 0.014 s"; `spelling`: the same as one spelling.
static void put_method(hn_strbuf *b, const hn_wp_method *m, const choice *best,
                       char spelling[HN_SPEC_MAX]) {
    hn_method_spec spec = m->spec;
    double *option = hn_method_find_option(&spec, m->adaptive ? "rtol" : "h", NULL);
    if (option) {
        char text[32];
        snprintf(text, sizeof text, "%.2g", best->size);
        *option = best->measured ? best->size : strtod(text, NULL);
    }
    hn_method_format(&spec, spelling);
    hn_strbuf_printf(b, "%s with %s = %.3g%s", m->spelling, m->adaptive ? "rtol" : "h", best->size,
                     m->adaptive ? "" : " s");
}

/// "0.14 million operations.", "817 operations."
static void put_operations(hn_strbuf *b, double ops) {
    if (ops >= 1e5) {
        hn_strbuf_printf(b, "%.2g million operations.", ops / 1e6);
    } else {
        hn_strbuf_printf(b, "%.0f operations.", ops);
    }
}

/// The methods that reach the error nowhere.
static void put_others(hn_strbuf *b, const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                       double wanted) {
    int n = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        if (hn_wp_reach(wp, classes, error, HN_COST_OPS, m, wanted).level < 0) {
            hn_strbuf_printf(b, "%s%s", n++ ? ", " : " ", wp->methods[m].spelling);
        }
    }
    hn_strbuf_add(b, n ? ": not reached in this study." : "");
}

void hn_wanted_text(hn_strbuf *b, const hn_study *study, const hn_wanted *wanted,
                    char spelling[HN_SPEC_MAX]) {
    const hn_wp *wp = hn_study_wp(study);
    const hn_class *classes = hn_study_classes(study);
    const hn_error_kind error = hn_wp_ranked_error(wp);
    choice best, next;
    spelling[0] = '\0';
    rank(wp, classes, error, wanted->error, &best, &next);
    if (best.method < 0) {
        hn_strbuf_printf(b, "For %s: no run of this study is accurate enough.", wanted->words);
        return;
    }

    // the cheapest, the next, and who does not get there
    const double whole = hn_model_scene(hn_study_model(study))->duration;
    hn_strbuf_printf(b, "For %s up to t = %.4g s", wanted->words, wp->ref->T);
    if (whole > wp->ref->T) {
        hn_strbuf_printf(b, " of the scene's %.4g s", whole);
    }
    hn_strbuf_add(b, ": ");
    put_method(b, &wp->methods[best.method], &best, spelling);
    hn_strbuf_printf(b, " is the cheapest, %s",
                     best.coarsest   ? "at most "
                     : best.measured ? ""
                                     : "about ");
    put_operations(b, best.ops);
    if (next.method >= 0) {
        hn_strbuf_printf(b, " Next: %s, %.3g times that.", wp->methods[next.method].spelling,
                         next.ops / best.ops);
    }
    put_others(b, wp, classes, error, wanted->error);
    hn_strbuf_add(b, " In this study ");
    hn_study_put_times(b, study);
    hn_strbuf_add(b, ".");
}
