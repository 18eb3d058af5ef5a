// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_search.h"

#include "expr/construct.h"
#include "expr/diff.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SHAKES = 4 };

/// Evidence of changed numbers for or against a candidate.
typedef enum evidence { EVIDENCE_AGAINST, EVIDENCE_NONE, EVIDENCE_FOR } evidence;

void hn_value_search_begin(hn_value_search *f, hn_value_sheet *sheet, int k, const double *given,
                           hn_ex formula, hn_part_result *r) {
    *f = (hn_value_search){
        .sheet = sheet, .entry = k, .given = given, .formula = formula, .result = r};
}

/// Returns whether further candidates cannot change the result: one is certain, or two agree as
/// closely as is told apart.
static bool is_done(const hn_value_search *f) {
    return (f->n_found == 2 && f->close == 2) || (f->n_found == 1 && !f->result->likely);
}

/// By how much a number of this size may differ: as finely as a right answer, relative to its size.
static double allowed_of(const hn_value_search *f, double size) {
    const hn_value_sheet *s = f->sheet;
    const double own = fabs(s->reference.x[f->entry][0]);
    return s->allowed[f->entry] * (own > 0 ? fmax(size, 1e-300) / own : 1);
}

/// Returns whether the values agree at all states, and how closely: as in hn_value_search.
static bool agrees(const hn_value_search *f, hn_ex e, double factor, int *close) {
    const hn_value_sheet *s = f->sheet;
    double worst = 0, size = 0, value[HN_DRAW_STATES];
    hn_draw_eval_all(s->draw, e, value);
    for (int i = 0; i < s->draw->n_states; i++) {
        const double x = factor * value[i];
        worst = fmax(worst, fabs(f->given[i] - x));
        size = fmax(size, fabs(x));
        if (!isfinite(f->given[i] - x)) {
            return false;
        }
    }

    // a mistake is told as finely as a right answer
    const double allowed = s->symbolic ? s->allowed[f->entry] + 1e-6 * size : allowed_of(f, size);
    *close = (worst <= 0.1 * allowed) + (worst <= 1e-3 * allowed);
    return worst <= allowed;
}

// ---- numbers of the variant, changed ----

/// The numbers of state `i`; those of the variant that `by` depends on (NULL: all) are changed.
static void shake(const hn_value_search *f, int i, const hn_ex *by, double x[HN_DRAW_NAMES]) {
    hn_draw *d = f->sheet->draw;
    memcpy(x, d->value[i % d->n_states], sizeof d->value[0]);
    for (int k = 0; k < d->n_outer; k++) {
        if (d->origin[k] == HN_DRAW_DRAWN && (!by || hn_depends_on(d->graph, *by, k))) {
            x[k] *= 0.7 + 0.7 * hn_draw_random(f->sheet->p->seed ^ 0x5bad, (uint64_t)(64 * i + k));
        }
    }
}

/// Returns whether two formulas have the same values at changed numbers; 0 and 1, or -1 when
/// neither has a finite value anywhere.
static int is_same(const hn_value_search *f, hn_ex a, double a_factor, hn_ex b, double b_factor,
                   const hn_ex *by) {
    hn_graph *g = f->sheet->draw->graph;
    double worst = 0, size = 0;
    int n = 0;
    for (int i = 0; i < SHAKES; i++) {
        double x[HN_DRAW_NAMES];
        shake(f, i, by, x);
        const double u = a_factor * hn_graph_eval(g, a, x), w = b_factor * hn_graph_eval(g, b, x);
        if (isfinite(u) && isfinite(w)) {
            worst = fmax(worst, fabs(u - w));
            size = fmax(size, fmax(fabs(u), fabs(w)));
            n++;
        }
    }
    // a constant that was typed with six digits is still the constant
    const hn_value_sheet *s = f->sheet;
    const double allowed = s->symbolic ? s->allowed[f->entry] : allowed_of(f, size);
    return n == 0 ? -1 : worst <= allowed + 1e-5 * size;
}

/// Returns what the changed numbers say. A number says nothing: it is the same whatever they are.
/// So does a candidate with a number of the variant that the answer does not name.
static evidence weigh(const hn_value_search *f, hn_ex e, double factor) {
    const hn_draw *d = f->sheet->draw;
    bool open = !f->sheet->symbolic, derived = false;
    for (int k = 0; k < d->n_outer; k++) {
        const bool mine = hn_depends_on(d->graph, e, k),
                   theirs = hn_depends_on(d->graph, f->formula, k);
        open |= d->origin[k] == HN_DRAW_DRAWN && mine && !theirs;
        derived |= d->origin[k] == HN_DRAW_DERIVED && (mine || theirs);
    }

    // a derived number cannot be changed by itself
    const int same = derived ? -1 : is_same(f, f->formula, 1, e, factor, &f->formula);
    return same == 0 ? EVIDENCE_AGAINST : open || same == -1 ? EVIDENCE_NONE : EVIDENCE_FOR;
}

// ---- the result ----

static void keep_first(hn_value_search *f, hn_ex e, double factor, int close, bool certain) {
    f->n_found = 1;
    f->first = e;
    f->first_factor = factor;
    f->close = close;
    f->result->likely = !certain;
}

/// A second explanation joins the first one's sentence; the answer gets the larger share.
static void add_second(hn_value_search *f, double share, const char *text) {
    hn_part_result *r = f->result;
    const size_t used = strlen(r->explanation);
    snprintf(r->explanation + used, sizeof r->explanation - used, "; or: %s", text);
    r->share = r->alone = fmax(r->share, share);
    f->n_found = 2;
}

const char *hn_value_search_stray_name(hn_value_sheet *sheet, int k, hn_ex formula) {
    hn_draw *d = sheet->draw;
    const hn_ex reference = sheet->reference.e[k];
    const hn_value_search f = {.sheet = sheet, .entry = k, .formula = formula};
    if (!sheet->symbolic || weigh(&f, reference, 1) != EVIDENCE_AGAINST) {
        return NULL;
    }
    for (int i = 0; i < d->n_outer; i++) {
        const hn_ex name = hn_graph_symbol_expr(d->graph, i);
        if (d->origin[i] == HN_DRAW_DRAWN && hn_depends_on(d->graph, formula, i) &&
            is_same(&f, formula, 1, reference, 1, &name) == 0) {
            return d->name[i];
        }
    }
    return NULL;
}

/// Returns whether a candidate is the right answer itself, which explains nothing.
static bool is_reference(const hn_value_search *f, hn_ex e, double factor) {
    double x[HN_DRAW_STATES];
    hn_draw_eval_all(f->sheet->draw, e, x);
    for (int i = 0; i < f->sheet->draw->n_states; i++) {
        x[i] *= factor;
    }
    return hn_value_is_right(f->sheet, f->entry, x);
}

bool hn_value_search_try(hn_value_search *f, hn_ex e, double factor, const char *id, double share,
                         const char *format, ...) {
    int close;
    char text[HN_PART_TEXT];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (f->note) {
        if (f->alone == 0) { // else it is a second mistake beside another
            f->note(f->notes, hn_scale(factor, e), id, share, text);
        }
        return false;
    }
    if (is_done(f) || !agrees(f, e, factor, &close) || is_reference(f, e, factor)) {
        return false;
    }
    if (close < f->closeness && !f->sheet->symbolic) {
        return false;
    }
    const evidence found = weigh(f, e, factor);
    if (found == EVIDENCE_AGAINST) {
        return false;
    }

    // the better of two, or both where they are equally good
    const bool better = close > f->close, proven = found == EVIDENCE_FOR && f->result->likely;
    if (f->n_found == 0 || better || (proven && f->n_found == 1)) {
        hn_part_wrong(f->result, id, share, "%s", text);
        f->result->alone = f->alone > 0 ? f->alone : share;
        keep_first(f, e, factor, close, found == EVIDENCE_FOR);
    } else if (f->n_found == 1 && close == f->close && strcmp(id, f->result->mistake) != 0 &&
               is_same(f, f->first, f->first_factor, e, factor, NULL) == 0) {
        add_second(f, share, text);
    }
    return true;
}
