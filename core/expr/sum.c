// SPDX-License-Identifier: GPL-3.0-or-later
// The constructor of sums: merge equal terms, c^2 + s^2 = 1, flatten nested sums where that is no
// longer, leading coefficient 1.

#include "expr/construct.h"

#include "expr/graph_internal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    SMALL = 48,         ///< terms that fit without asking for memory
    MAX_EXPANSIONS = 6, ///< nested sums opened in search of something that cancels
    MAX_EXCESS = 12,    ///< a search is given up once the list grew by this much
};

typedef struct terms {
    hn_ex *t;
    int n, cap;
    hn_ex small[SMALL];
} terms;

static void terms_init(terms *s) {
    s->t = s->small;
    s->n = 0;
    s->cap = SMALL;
}

static void terms_reset(terms *s) {
    if (s->t != s->small) {
        free(s->t);
    }
}

static bool terms_reserve(hn_graph *g, terms *s, int n) {
    if (n <= s->cap) {
        return true;
    }
    hn_ex *t = malloc(2 * (size_t)n * sizeof *t);
    if (!t) {
        g->failed = 1;
        return false;
    }
    memcpy(t, s->t, (size_t)s->n * sizeof *t);
    terms_reset(s);
    s->t = t;
    s->cap = 2 * n;
    return true;
}

static bool terms_copy(hn_graph *g, terms *to, const terms *from) {
    if (!terms_reserve(g, to, from->n)) {
        return false;
    }
    memcpy(to->t, from->t, (size_t)from->n * sizeof *to->t);
    to->n = from->n;
    return true;
}

/// Order of terms: by node, the constant last (so that it never leads).
static int32_t sort_key(hn_ex e) {
    return e.n == HN_NODE_ONE ? INT32_MAX : e.n;
}

static int compare_terms(const void *a, const void *b) {
    const hn_ex *x = a, *y = b;
    const int32_t i = sort_key(*x), k = sort_key(*y);
    if (i != k) {
        return i < k ? -1 : 1;
    }
    return (x->c > y->c) - (x->c < y->c); // the order of equal nodes must not depend on qsort
}

static void sort_terms(terms *s) {
    if (s->n > 16) {
        qsort(s->t, (size_t)s->n, sizeof *s->t, compare_terms);
        return;
    }
    for (int i = 1; i < s->n; i++) {
        const hn_ex x = s->t[i];
        int k = i;
        for (; k > 0 && compare_terms(&s->t[k - 1], &x) > 0; k--) {
            s->t[k] = s->t[k - 1];
        }
        s->t[k] = x;
    }
}

/// Sorts, adds the coefficients of equal nodes, and drops what cancels.
static void merge(terms *s) {
    sort_terms(s);
    int n = 0;
    for (int i = 0; i < s->n;) {
        const int32_t node = s->t[i].n;
        double c = 0, largest = 0;
        for (; i < s->n && s->t[i].n == node; i++) {
            c += s->t[i].c;
            largest = fmax(largest, fabs(s->t[i].c));
        }
        if (fabs(c) > HN_CANCEL_TOL * largest || c != c) {
            s->t[n++] = (hn_ex){c, node};
        }
    }
    s->n = n;
}

static int find_term(const terms *s, int32_t node) {
    int low = 0, high = s->n - 1;
    while (low <= high) {
        const int mid = (low + high) / 2;
        const int32_t key = sort_key(s->t[mid]);
        if (key == node) {
            return mid;
        }
        if (key < node) {
            low = mid + 1;
        } else {
            high = mid - 1;
        }
    }
    return -1;
}

// ---- c^2 + s^2 ----

/// The factors of a product with one square of factor `i` taken out, and `add` squared put in (if
/// >= 0).
static int exchange_square(const hn_factor *f, int n, int i, int32_t add, hn_factor *out) {
    int m = 0;
    for (int k = 0; k < n; k++) {
        const hn_factor x = {f[k].node, f[k].power - (k == i ? 2 : 0)};
        if (x.power > 0) {
            out[m++] = x;
        }
    }

    if (add < 0) {
        return m;
    }

    // the place of `add` in the sorted list, or its power raised
    int k = m;
    for (; k > 0 && out[k - 1].node > add; k--) {
        out[k] = out[k - 1];
    }
    if (k > 0 && out[k - 1].node == add) {
        memmove(out + k, out + k + 1, (size_t)(m - k) * sizeof *out);
        out[k - 1].power += 2;
        return m;
    }
    out[k] = (hn_factor){add, 2};
    return m + 1;
}

/// For the square of a sine or cosine in term i: the term with the square of the other, the rest
/// the same.
static int find_partner(const hn_graph *g, const terms *s, int i, int factor) {
    const hn_node *node = &g->nodes[s->t[i].n];
    const hn_node *trig = &g->nodes[node->factors[factor].node];
    const hn_op other_op = trig->op == HN_OP_SIN ? HN_OP_COS : HN_OP_SIN;
    const int32_t other = hn_graph_lookup_args(g, other_op, trig->args, 1);
    if (other < 0) {
        return -1;
    }
    hn_factor f[HN_MAX_FACTORS + 1];
    const int n = exchange_square(node->factors, node->n_factors, factor, other, f);
    const int32_t partner = hn_graph_lookup_product(g, f, n);
    const int k = partner < 0 ? -1 : find_term(s, partner);
    if (k < 0) {
        return -1;
    }
    const double a = s->t[i].c, b = s->t[k].c;
    return fabs(a - b) <= HN_CANCEL_TOL * fmax(fabs(a), fabs(b)) ? k : -1;
}

static hn_ex without_square(hn_graph *g, hn_ex term, int factor) {
    hn_factor f[HN_MAX_FACTORS + 1];
    const hn_node *node = &g->nodes[term.n];
    const int n = exchange_square(node->factors, node->n_factors, factor, -1, f);
    hn_ex rest = {term.c, HN_NODE_ONE};
    for (int i = 0; i < n; i++) {
        rest = hn_mul(g, rest, hn_pow_int(g, (hn_ex){1, f[i].node}, f[i].power));
    }
    return rest;
}

static bool combine_one_square(hn_graph *g, terms *s) {
    for (int i = 0; i < s->n; i++) {
        if (!(g->nodes[s->t[i].n].flags & HN_NODE_TRIG_SQUARE)) {
            continue;
        }
        for (int f = 0; f < g->nodes[s->t[i].n].n_factors; f++) {
            const hn_factor x = g->nodes[s->t[i].n].factors[f];
            const int op = g->nodes[x.node].op;
            const int k = x.power >= 2 && (op == HN_OP_SIN || op == HN_OP_COS)
                              ? find_partner(g, s, i, f)
                              : -1;
            if (k >= 0) {
                s->t[i] = without_square(g, s->t[i], f);
                s->t[k] = s->t[--s->n];
                merge(s);
                return true;
            }
        }
    }
    return false;
}

static void reduce(hn_graph *g, terms *s) {
    merge(s);
    while (!g->failed && combine_one_square(g, s)) {}
}

// ---- nested sums ----

/// The cost of a list: its terms, and the coefficients that are not those of the leading term up to
/// sign.
static int cost(const terms *s) {
    int n = s->n;
    for (int i = 1; i < s->n; i++) {
        n += s->t[i].n != HN_NODE_ONE && fabs(s->t[i].c) != fabs(s->t[0].c);
    }
    return n;
}

/// Replaces the term at `at`, a sum, by its terms.
static bool expand(hn_graph *g, terms *s, int at) {
    const double c = s->t[at].c;
    const hn_node sum = g->nodes[s->t[at].n];
    if (!terms_reserve(g, s, s->n + sum.n_args)) {
        return false;
    }
    s->t[at] = s->t[--s->n];
    for (int i = 0; i < sum.n_args; i++) {
        s->t[s->n++] = hn_scale(c, sum.args[i]);
    }
    reduce(g, s);
    return !g->failed;
}

static int last_sum(const hn_graph *g, const terms *s) {
    for (int i = s->n - 1; i >= 0; i--) {
        if (g->nodes[s->t[i].n].op == HN_OP_SUM) {
            return i;
        }
    }
    return -1;
}

/// Opens nested sums one after the other, the outermost first, starting with term `first`; keeps
/// the list in *s as soon as one is found that costs no more.
static int flatten_from(hn_graph *g, terms *s, int first, int depth) {
    terms trial;
    terms_init(&trial);
    int better = 0;
    const int limit = cost(s), longest = s->n + MAX_EXCESS;
    if (terms_copy(g, &trial, s)) {
        for (int at = first; at >= 0 && depth-- > 0 && !better; at = last_sum(g, &trial)) {
            if (!expand(g, &trial, at) || trial.n > longest) {
                break;
            }
            better = cost(&trial) <= limit;
        }
    }
    better = better && terms_copy(g, s, &trial);
    terms_reset(&trial);
    return better;
}

/// Two searches: through all levels from the outermost sum, and each nested sum on its own.
static bool flatten_once(hn_graph *g, terms *s) {
    const int last = last_sum(g, s);
    if (last < 0 || flatten_from(g, s, last, MAX_EXPANSIONS)) {
        return last >= 0;
    }
    int tried = 0;
    for (int i = last - 1; i >= 0 && tried < MAX_EXPANSIONS; i--) {
        if (g->nodes[s->t[i].n].op == HN_OP_SUM) {
            tried++;
            if (flatten_from(g, s, i, 1)) {
                return true;
            }
        }
    }
    return false;
}

// ---- the sum ----

/// Quotients of coefficients that are 1 but for rounding are 1: a last bit must not cost a product.
static double snap(double k) {
    const double tolerance = 4 * 2.220446049250313e-16;
    return fabs(fabs(k) - 1) <= tolerance ? copysign(1, k) : k;
}

/// False where division by the leading coefficient would lose another one to the ends of the range
/// of numbers.
static bool may_divide(const terms *s) {
    for (int i = 1; i < s->n; i++) {
        if (!isnormal(s->t[i].c / s->t[0].c)) {
            return false;
        }
    }
    return true;
}

static hn_ex finish(hn_graph *g, terms *s) {
    if (s->n == 0) {
        return hn_zero();
    }
    if (s->n == 1) {
        return s->t[0].c == 0 ? hn_zero() : s->t[0];
    }
    double lead = 1;
    if (may_divide(s)) {
        lead = s->t[0].c;
        for (int i = 1; i < s->n; i++) {
            s->t[i].c = snap(s->t[i].c / lead);
        }
        s->t[0].c = 1;
    }
    const int32_t node = hn_graph_intern_args(g, HN_OP_SUM, s->t, s->n);
    return node < 0 ? hn_zero() : (hn_ex){lead, node};
}

hn_ex hn_sum(hn_graph *g, const hn_ex *list, int n) {
    terms s;
    terms_init(&s);
    hn_ex result = hn_zero();
    if (!g->failed && terms_reserve(g, &s, n)) {
        for (int i = 0; i < n; i++) {
            if (!hn_is_zero(list[i])) {
                s.t[s.n++] = list[i];
            }
        }
        reduce(g, &s);
        while (!g->failed && s.n > 1 && flatten_once(g, &s)) {}
        result = g->failed ? hn_zero() : finish(g, &s);
    }
    terms_reset(&s);
    return result;
}

hn_ex hn_add(hn_graph *g, hn_ex a, hn_ex b) {
    if (a.n == b.n || a.c == 0 || b.c == 0) { // quick ways out
        const double c = a.c + b.c;
        const double largest = fmax(fabs(a.c), fabs(b.c));
        if (a.n != b.n) {
            return a.c == 0 ? b : a;
        }
        return fabs(c) <= HN_CANCEL_TOL * largest ? hn_zero() : (hn_ex){c, a.n};
    }
    return hn_sum(g, (hn_ex[2]){a, b}, 2);
}

hn_ex hn_sub(hn_graph *g, hn_ex a, hn_ex b) {
    return hn_add(g, a, hn_neg(b));
}
