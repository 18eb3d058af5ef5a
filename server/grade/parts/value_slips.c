// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/value_slips.h"

#include "expr/construct.h"
#include "grade/parts/value_places.h"

#include <math.h>
#include <stdbool.h>

enum {
    /// Candidates for a number. Each agrees by chance with one number of a thousand near it (a
    /// tenth of 0.5 % on both sides), or, where they are more, with one of a hundred thousand.
    FEW = 36,
    MANY = 400,
    MAX_PLACES = 8 ///< of one node in an expression
};

/// Slips that may happen at one place. Marked `numbers`: looked for in numbers too.
typedef enum kind {
    TERM_MISSING,
    TERM_SIGN,
    TERM_TWICE,
    TERM_HALF,
    SINE,
    ROOT,
    SQUARE,
    FACTOR,
    NO_SINE,
    // rarer ones
    SINE_TURNED, ///< with the sign that the graph has drawn out of an odd function
    POWER,
    DIVISOR,
    WHOLE_DIVISOR, ///< with its number, as of 2 a b
    ONE_TERM
} kind;
enum { FIRST_RARE = SINE_TURNED };
static const struct slip_row {
    const char *id, *says;
    double share;
    bool numbers;
} ROWS[] = {
    [TERM_MISSING] = {"missing-term", "one term is missing", 0.25, true},
    [TERM_SIGN] = {"sign-term", "one term has the wrong sign", 0.5, true},
    [TERM_TWICE] = {"double-term", "one term is twice as large: a factor 1/2 is missing in it", 0.5,
                    true},
    [TERM_HALF] = {"half-term", "one term is half as large: a factor 2 is missing in it", 0.5,
                   true},
    [SINE] = {"sine", "sine and cosine are exchanged at one place", 0.25, true},
    [ROOT] = {"no-root", "a square root is missing", 0.25, true},
    [SQUARE] = {"not-squared", "a square is missing", 0.25, true},
    [FACTOR] = {"missing-name", "a factor is missing at one place", 0.25, false},
    [NO_SINE] = {"no-sine", "a sine or cosine is missing", 0.25, false},
    [SINE_TURNED] = {"sine", "sine and cosine are exchanged at one place", 0.25, true},
    [POWER] = {"no-power", "an exponent is missing", 0.25, true},
    [DIVISOR] = {"no-divisor", "a divisor is missing", 0.25, true},
    [WHOLE_DIVISOR] = {"no-divisor", "a divisor is missing", 0.25, true},
    [ONE_TERM] = {"missing-term", "only one term of a sum is there", 0.1, true},
};
enum { N_KINDS = sizeof ROWS / sizeof *ROWS };

/// A slip: what happens at which argument of which node.
typedef struct slip {
    kind kind;
    int32_t node;
    int arg;
    int place; ///< of the places where the node stands, from 1; 0: at all of them
} slip;

/// Returns whether a product has the factor already: all products have two, of which the first may
/// be another product.
static bool has_factor(const hn_graph *g, int32_t product, int32_t factor) {
    for (int depth = 0; depth < HN_VALUE_DEPTH; depth++) {
        const hn_node_view view = hn_graph_node(g, product);
        if (product == factor || view.op != HN_OP_MUL) {
            return product == factor;
        }
        if (view.args[1].n == factor) {
            return true;
        }
        product = view.args[0].n;
    }
    return false;
}

/// Returns whether the slip can happen there.
static bool can_happen(const hn_graph *g, const slip *s) {
    const hn_node_view view = hn_graph_node(g, s->node);
    switch (s->kind) {
    case TERM_MISSING:
    case TERM_SIGN:
    case TERM_TWICE:
    case TERM_HALF:
        return view.op == HN_OP_SUM;
    case ONE_TERM:
        return view.op == HN_OP_SUM && view.n_args > 2;
    case POWER:
        return s->arg == 0 && view.op == HN_OP_POW;
    case DIVISOR:
        return view.op == HN_OP_RECIP;
    case WHOLE_DIVISOR:
        return view.op == HN_OP_MUL && hn_graph_node(g, view.args[s->arg].n).op == HN_OP_RECIP;
    case SINE:
    case NO_SINE:
    case SINE_TURNED:
        return s->arg == 0 && (view.op == HN_OP_SIN || view.op == HN_OP_COS);
    case ROOT:
        return s->arg == 0 && view.op == HN_OP_SQRT;
    case SQUARE:
        return view.op == HN_OP_MUL && has_factor(g, view.args[1 - s->arg].n, view.args[s->arg].n);
    case FACTOR:
        return view.op == HN_OP_MUL && hn_graph_node(g, view.args[s->arg].n).op == HN_OP_SYMBOL &&
               !has_factor(g, view.args[1 - s->arg].n, view.args[s->arg].n);
    }
    return false;
}

/// The node whose arguments are `a`, with the slip.
static hn_ex write_slip(hn_graph *g, hn_op op, hn_ex *a, int n, double *c, const void *user) {
    const slip *s = user;
    switch (s->kind) {
    case TERM_MISSING:
        a[s->arg] = hn_num(0);
        return hn_sum(g, a, n);
    case TERM_SIGN:
        a[s->arg] = hn_neg(a[s->arg]);
        return hn_sum(g, a, n);
    case TERM_TWICE:
        a[s->arg] = hn_scale(2, a[s->arg]);
        return hn_sum(g, a, n);
    case TERM_HALF:
        a[s->arg] = hn_scale(0.5, a[s->arg]);
        return hn_sum(g, a, n);
    case SINE:
        return op == HN_OP_SIN ? hn_cos(g, a[0]) : hn_sin(g, a[0]);
    case SINE_TURNED:
        return hn_neg(op == HN_OP_SIN ? hn_cos(g, a[0]) : hn_sin(g, a[0]));
    case ROOT:
    case POWER:
        return a[0];
    case DIVISOR:
    case NO_SINE:
        return hn_num(1);
    case WHOLE_DIVISOR:
        *c = copysign(1, *c);
        return a[1 - s->arg];
    case SQUARE:
    case FACTOR:
        return a[1 - s->arg];
    case ONE_TERM:
        return a[s->arg];
    }
    return hn_num(0);
}

/// At how many places of an expression a node stands, as far as `most`.
static int count_places(const hn_graph *g, int32_t from, int32_t node, int most) {
    const hn_node_view view = hn_graph_node(g, from);
    int n = from == node;
    for (int i = 0; i < view.n_args && n < most; i++) {
        n += count_places(g, view.args[i].n, node, most - n);
    }
    return n;
}

/// Calls `visit` for each slip of the kinds before `end` that can happen, everywhere or, where
/// `single`, at one of several places. Returns how many there are.
static int visit_slips(hn_value_search *f, const hn_value_places *list, int end, bool single,
                       void (*visit)(hn_value_search *, const slip *)) {
    const bool symbolic = f->sheet->symbolic;
    const hn_graph *g = f->sheet->draw->graph;
    const int32_t whole = f->sheet->reference.e[f->entry].n;
    int n = 0;
    for (int i = 0; i < list->n; i++) {
        const int n_args = hn_graph_node(g, list->node[i]).n_args;
        const int places = single ? count_places(g, whole, list->node[i], MAX_PLACES) : 0;
        const int last = places > 1 ? places : 0;
        for (int k = 0; k < n_args * end; k++) {
            slip s = {(kind)(k % end), list->node[i], k / end, 0};
            if ((!symbolic && !ROWS[s.kind].numbers) || !can_happen(g, &s)) {
                continue;
            }
            for (s.place = single; s.place <= last; s.place++) {
                n++;
                if (visit) {
                    visit(f, &s);
                }
            }
        }
    }
    return n;
}

static void try_slip(hn_value_search *f, const slip *s) {
    const struct slip_row *row = &ROWS[s->kind];
    const hn_ex e = hn_value_rewrite(f->sheet->draw->graph, f->sheet->reference.e[f->entry],
                                     s->node, s->place, write_slip, s);
    hn_value_search_try(f, e, 1, row->id, row->share, "%s", row->says);
}

void hn_value_slips_try(hn_value_search *f) {
    hn_value_places list;
    const bool symbolic = f->sheet->symbolic;
    hn_value_places_find(&list, f->sheet->draw->graph, f->sheet->reference.e[f->entry]);
    if (!list.whole) {
        return;
    }

    // the usual slips first; the more there are, the closer one of them must be
    static const struct {
        int end;
        bool single;
    } ROUNDS[] = {{FIRST_RARE, false}, {N_KINDS, false}, {N_KINDS, true}};
    int before = 0;
    for (int i = 0; i < 3 && f->n_found == 0; i++) {
        const int n = visit_slips(f, &list, ROUNDS[i].end, ROUNDS[i].single, NULL);
        const int all = ROUNDS[i].single ? before + n : n;
        f->closeness = symbolic || all <= FEW ? 1 : 2;
        if (symbolic || all <= MANY) {
            visit_slips(f, &list, ROUNDS[i].end, ROUNDS[i].single, try_slip);
        }
        before = all;
    }
    f->closeness = 0;
}
