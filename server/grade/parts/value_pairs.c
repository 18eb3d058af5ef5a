// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_pairs.h"

#include "expr/construct.h"
#include "grade/parts/value_factor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_SINGLE = 1024, ///< single mistakes that are put together
    MAX_WHOLE = 24,    ///< terms, with the formula itself
    MAX_DEPTH = 12,    ///< of sums and products in one another
    MAX_FOUND = 32,    ///< explanations that are compared
    WORDS = 180        ///< of one mistake
};

/// A place where two mistakes may both stand: the formula, or one of its terms.
typedef struct whole {
    hn_ex e;
    double x[HN_DRAW_STATES];
} whole;

/// A single mistake in a whole: the formula that the whole becomes, and the change of its values.
typedef struct single {
    const whole *in;
    hn_ex e;
    const char *id;
    double share, by[HN_DRAW_STATES];
    char says[WORDS];
} single;

/// An explanation: two mistakes, or one and a wrong factor.
typedef struct explanation {
    const single *first, *second; ///< `second` is NULL where a factor is wrong
    hn_ex e;
    double share, likelihood; ///< the more the points, the smaller the mistakes
    bool everywhere;          ///< the factor is that of the formula, not of a term
    char factor[40];
} explanation;

typedef struct pairs {
    hn_value_search *f;
    single *singles;
    int n;
    whole wholes[MAX_WHOLE]; ///< the first is the formula
    int n_wholes;
    const whole *now;               ///< the whole whose mistakes are noted
    double missing[HN_DRAW_STATES]; ///< the answer less the right values
    explanation found[MAX_FOUND];
    int n_found;
} pairs;

static int count_states(const pairs *p) {
    return p->f->sheet->draw->n_states;
}

// ---- the formula and its terms ----

static void add_whole(pairs *p, hn_ex e) {
    whole *w = &p->wholes[p->n_wholes];
    if (p->n_wholes == MAX_WHOLE) {
        return;
    }
    for (int i = 0; i < p->n_wholes; i++) {
        if (p->wholes[i].e.n == e.n && p->wholes[i].e.c == e.c) {
            return;
        }
    }
    w->e = e;
    hn_draw_eval_all(p->f->sheet->draw, e, w->x);
    p->n_wholes++;
}

/// Adds the terms of `e`, a sum or a product with a sum in it, each times `factor`.
static void add_terms(pairs *p, hn_ex e, hn_ex factor, int depth) {
    hn_graph *g = p->f->sheet->draw->graph;
    const hn_op op = hn_graph_node(g, e.n).op;
    const int n = hn_graph_node(g, e.n).n_args;
    const hn_ex own = hn_scale(e.c, factor);
    for (int i = 0; i < n && depth < MAX_DEPTH; i++) {
        // the view's arguments may move when the graph grows
        const hn_ex arg = hn_graph_node(g, e.n).args[i];
        if (op == HN_OP_SUM) {
            add_whole(p, hn_mul(g, own, arg));
            add_terms(p, arg, own, depth + 1);
        } else if (op == HN_OP_MUL) {
            add_terms(p, arg, hn_mul(g, own, hn_graph_node(g, e.n).args[1 - i]), depth + 1);
        }
    }
}

// ---- the single mistakes ----

/// Returns whether the mistake is in the list already.
static bool is_noted(const pairs *p, hn_ex e) {
    for (int i = 0; i < p->n; i++) {
        const single *s = &p->singles[i];
        if (s->in == p->now && s->e.n == e.n && s->e.c == e.c) {
            return true;
        }
    }
    return false;
}

static void note(void *user, hn_ex e, const char *id, double share, const char *says) {
    pairs *p = user;
    single *s = &p->singles[p->n];
    if (p->n == MAX_SINGLE || share <= 0 || is_noted(p, e)) {
        return;
    }
    *s = (single){.in = p->now, .e = e, .id = id, .share = share};
    snprintf(s->says, sizeof s->says, "%s", says);

    // no use: without a value somewhere, the right ones everywhere, or 0
    double size = 0, change = 0, x[HN_DRAW_STATES];
    bool finite = true;
    hn_draw_eval_all(p->f->sheet->draw, e, x);
    for (int i = 0; i < count_states(p); i++) {
        s->by[i] = x[i] - p->now->x[i];
        change = fmax(change, fabs(s->by[i]));
        size = fmax(size, fabs(x[i]));
        finite &= isfinite(x[i]) != 0;
    }
    p->n += finite && fmin(change, size) > p->f->sheet->allowed[p->f->entry];
}

/// Notes the mistakes that `singles` tries on each whole, as if that were the right answer.
static hn_status find_singles(pairs *p, hn_value_singles *singles) {
    hn_value_sheet sheet = *p->f->sheet;
    hn_value_search noting = *p->f;
    noting.sheet = &sheet;
    noting.note = note;
    noting.notes = p;
    for (int i = 0; i < p->n_wholes; i++) {
        p->now = &p->wholes[i];
        sheet.reference.e[p->f->entry] = p->now->e;
        memcpy(sheet.reference.x[p->f->entry], p->now->x, sizeof p->now->x);
        HN_TRY(singles(&noting, i > 0));
    }
    return HN_OK;
}

// ---- two of them ----

/// Keeps an explanation; the likelier one goes first, else the one that was found first.
static void keep(pairs *p, const explanation *found) {
    int at = p->n_found < MAX_FOUND ? p->n_found++ : MAX_FOUND - 1;
    if (p->found[at].likelihood >= found->likelihood) {
        return;
    }
    for (; at > 0 && p->found[at - 1].likelihood < found->likelihood; at--) {
        p->found[at] = p->found[at - 1];
    }
    p->found[at] = *found;
}

/// Returns whether both mistakes give the answer: as factors of their whole, or added.
static bool explains(const pairs *p, const single *a, const single *b, bool factors) {
    const double allowed = p->f->sheet->allowed[p->f->entry];
    for (int i = 0; i < count_states(p); i++) {
        const double both = factors ? a->by[i] * b->by[i] / a->in->x[i] : 0;
        const double change = a->by[i] + b->by[i] + both;
        const double size = fmax(fabs(a->by[i]), fabs(b->by[i]));
        if (!(fabs(change - p->missing[i]) <= allowed + 1e-5 * fmax(size, fabs(change)))) {
            return false;
        }
    }
    return true;
}

/// A whole with two mistakes in different factors: the product of both, over the whole.
static hn_ex write_product(hn_graph *g, hn_ex a, hn_ex b, hn_ex w) {
    return a.n == w.n   ? hn_scale(a.c / w.c, b)
           : b.n == w.n ? hn_scale(b.c / w.c, a)
                        : hn_div(g, hn_mul(g, a, b), w);
}

static hn_ex write_both(const pairs *p, const single *a, const single *b, bool factors) {
    hn_graph *g = p->f->sheet->draw->graph;
    const hn_ex own = factors ? write_product(g, a->e, b->e, a->in->e)
                              : hn_sub(g, hn_add(g, a->e, b->e), a->in->e);
    return a->in == p->wholes ? own : hn_add(g, hn_sub(g, p->wholes[0].e, a->in->e), own);
}

/// Two mistakes in one whole. Those in different terms are added, and stand in the formula.
static void try_two(pairs *p, const single *a, const single *b) {
    for (int factors = a->in != p->wholes; factors < 2; factors++) {
        if (explains(p, a, b, factors)) {
            const double share = a->share * b->share;
            keep(p, &(explanation){.first = a,
                                   .second = b,
                                   .e = write_both(p, a, b, factors),
                                   .share = share,
                                   .likelihood = share});
            return;
        }
    }
}

// ---- one of them and a wrong number ----

/// A mistake and a whole with a wrong factor.
typedef struct factor {
    const single *a;
    const whole *w; ///< that of the mistake; or, of one in the formula, also a term
    bool over;      ///< the mistake is made to the whole formula, with the factor in it
} factor;

/// The factor that gives the answer together with the mistake; 0 where there is none, or none that
/// is a fraction.
static double find_factor(const pairs *p, const factor *m, char *text, size_t size) {
    bool fraction;
    double x[HN_DRAW_STATES];
    const double *right = p->wholes[0].x, *w = m->w->x, *by = m->a->by;
    for (int i = 0; i < count_states(p); i++) {
        const double given = right[i] + p->missing[i];
        x[i] = m->over            ? 1 + (given * right[i] / (right[i] + by[i]) - right[i]) / w[i]
               : m->w == m->a->in ? (p->missing[i] + w[i]) / (w[i] + by[i])
                                  : 1 + (p->missing[i] - by[i]) / w[i];
        if (!isfinite(x[i])) {
            return 0;
        }
    }
    const double k = hn_value_factor_name(x, count_states(p), text, size, &fraction);
    return fraction && hn_value_factor_is_constant(x, count_states(p)) ? k : 0;
}

static hn_ex write_factor(const pairs *p, const factor *m, double k) {
    hn_graph *g = p->f->sheet->draw->graph;
    const hn_ex right = p->wholes[0].e;
    if (m->over) {
        return write_product(g, hn_add(g, right, hn_scale(k - 1, m->w->e)), m->a->e, right);
    }
    if (m->w == m->a->in) {
        return hn_add(g, hn_sub(g, right, m->w->e), hn_scale(k, m->a->e));
    }
    return hn_add(g, m->a->e, hn_scale(k - 1, m->w->e));
}

static void try_factor(pairs *p, const factor *m) {
    explanation found = {.first = m->a, .everywhere = m->w == p->wholes};
    const double k = find_factor(p, m, found.factor, sizeof found.factor);
    if (k != 0 && k != 1 && (k != -1 || !found.everywhere)) {
        // people rarely turn a sign and miss a number in one term
        found.share = 0.25 * m->a->share;
        found.likelihood = k < 0 ? 0.2 * found.share : found.share;
        found.e = write_factor(p, m, k);
        keep(p, &found);
    }
}

// ---- all of them ----

static void find_explanations(pairs *p) {
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < i; j++) {
            if (p->singles[j].in == p->singles[i].in) {
                try_two(p, &p->singles[j], &p->singles[i]);
            }
        }
    }
    for (int i = 0; i < p->n; i++) {
        const single *a = &p->singles[i];
        try_factor(p, &(factor){a, a->in, false});
        for (int k = 1; k < p->n_wholes && a->in == p->wholes; k++) {
            try_factor(p, &(factor){a, &p->wholes[k], false});
            try_factor(p, &(factor){a, &p->wholes[k], true});
        }
    }
}

static void try_explanation(const pairs *p, const explanation *x) {
    hn_value_search *f = p->f;
    const char *where = x->first->in == p->wholes ? "at once" : "in one term";
    f->alone = x->first->share;
    if (x->second) {
        hn_value_search_try(f, x->e, 1, x->first->id, x->share, "two mistakes %s: %s; and %s",
                            where, x->first->says, x->second->says);
    } else {
        hn_value_search_try(f, x->e, 1, x->first->id, x->share,
                            "two mistakes %s: %s; and %s %s times as large as it must be", where,
                            x->first->says, x->everywhere ? "the formula is" : "one term is",
                            x->factor);
    }
    f->alone = 0;
}

hn_status hn_value_pairs_try(hn_value_search *f, hn_value_singles *singles) {
    if (!f->sheet->symbolic) {
        return HN_OK;
    }
    pairs p = {.f = f, .singles = calloc(MAX_SINGLE, sizeof(single))};
    add_whole(&p, f->sheet->reference.e[f->entry]);
    add_terms(&p, p.wholes[0].e, hn_num(1), 0);
    for (int i = 0; i < count_states(&p); i++) {
        p.missing[i] = f->given[i] - p.wholes[0].x[i];
    }
    const hn_status status = p.singles ? find_singles(&p, singles) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        find_explanations(&p);
    }
    for (int i = 0; i < p.n_found; i++) {
        try_explanation(&p, &p.found[i]);
    }
    free(p.singles);
    return status;
}
