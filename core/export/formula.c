// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/formula.h"

#include "export/spelling.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_FACTORS = 192 }; // two pieces of 160 letters have fewer different names

/// A product as powers of nodes that are not products.
typedef struct product {
    double c;
    int n;
    int32_t base[MOST_FACTORS];
    int power[MOST_FACTORS];
} product;

static void put_sum(const hn_formula *f, hn_ex e, bool *is_first);

// ---- variables ----

int hn_formula_variable(int number, hn_piece_kind kind) {
    return HN_PIECE_KINDS * number + (int)kind;
}

void hn_formula_variable_name(const char *const *prefix, int variable, char out[32]) {
    snprintf(out, 32, "%s%d", prefix[variable % HN_PIECE_KINDS], variable / HN_PIECE_KINDS);
}

// ---- products ----

static bool is_open(const hn_formula *f, int32_t node, hn_op op) {
    return f->variable[node] == 0 && hn_graph_node(f->g, node).op == op;
}

/// Multiplies p by node^power.
static void collect(const hn_formula *f, product *p, int32_t node, int power) {
    const hn_node_view view = hn_graph_node(f->g, node);
    if (node == HN_NODE_ONE) {
        return;
    }
    if (is_open(f, node, HN_OP_MUL) || is_open(f, node, HN_OP_RECIP)) {
        const int sign = view.op == HN_OP_RECIP ? -1 : 1;
        for (int i = 0; i < view.n_args; i++) {
            p->c *= pow(view.args[i].c, sign * power);
            collect(f, p, view.args[i].n, sign * power);
        }
        return;
    }

    // a base that is there gets a higher power
    int at = 0;
    while (at < p->n && p->base[at] != node) {
        at++;
    }
    if (at == MOST_FACTORS) {
        f->b->failed = true;
        return;
    }
    if (at == p->n) {
        p->base[p->n] = node;
        p->power[p->n++] = 0;
    }
    p->power[at] += power;
}

/// Masses first, then other symbols, then functions and sums: m l^2 sin(th).
static int rank_of(const hn_formula *f, int32_t node) {
    const hn_node_view view = hn_graph_node(f->g, node);
    if (f->variable[node] > 0 || view.op != HN_OP_SYMBOL) {
        return f->variable[node] > 0 ? 1 : 2;
    }
    return hn_graph_symbol_name(f->g, view.symbol)[0] == 'm' ? 0 : 1;
}

/// Sorts the factors by rank; the order among equals stays. Drops those of power 0.
static void order(const hn_formula *f, product *p) {
    product sorted = {.c = p->c};
    for (int rank = 0; rank <= 2; rank++) {
        for (int i = 0; i < p->n; i++) {
            if (p->power[i] != 0 && rank_of(f, p->base[i]) == rank) {
                sorted.base[sorted.n] = p->base[i];
                sorted.power[sorted.n++] = p->power[i];
            }
        }
    }
    *p = sorted;
}

// ---- factors ----

static void put_inner(const hn_formula *f, hn_ex e) {
    bool is_first = true;
    put_sum(f, e, &is_first);
}

static void put_exponent(const hn_formula *f, int power) {
    char text[16];
    snprintf(text, sizeof text, "%d", power);
    hn_code_fill(f->b, f->language->raised, (const char *[]){text});
}

/// A call by its form; a power of sin, cos and tan stands before the parentheses.
static void put_call(const hn_formula *f, const hn_node_view *view, int power) {
    for (const char *c = f->language->call[view->op]; *c; c++) {
        if (*c == '(' && power > 1) {
            put_exponent(f, power);
            power = 1;
        }
        if (*c == '#') {
            put_inner(f, view->args[*++c - '1']);
        } else {
            hn_strbuf_add_n(f->b, c, 1);
        }
    }
}

static void put_factor(const hn_formula *f, int32_t node, int power, bool is_alone) {
    const hn_node_view view = hn_graph_node(f->g, node);
    if (f->variable[node] > 0 || view.op == HN_OP_SYMBOL) {
        char name[32] = "";
        if (f->variable[node] > 0) {
            hn_formula_variable_name(f->prefix, f->variable[node], name);
        }
        hn_code_name(f->b, f->language,
                     f->variable[node] > 0 ? name : hn_graph_symbol_name(f->g, view.symbol));
    } else if (view.op == HN_OP_SIN || view.op == HN_OP_COS || view.op == HN_OP_TAN) {
        put_call(f, &view, power);
        return;
    } else {
        const bool is_sum = view.op == HN_OP_SUM;
        const bool parentheses = power > 1 || (is_sum && !is_alone);
        hn_strbuf_add(f->b, parentheses ? "(" : "");
        if (is_sum) {
            put_inner(f, (hn_ex){1, node});
        } else {
            put_call(f, &view, 1);
        }
        hn_strbuf_add(f->b, parentheses ? ")" : "");
    }
    if (power > 1) {
        put_exponent(f, power);
    }
}

static int count_factors(const product *p, int sign) {
    int n = 0;
    for (int i = 0; i < p->n; i++) {
        n += p->power[i] * sign > 0;
    }
    return n;
}

/// The factors above (sign 1) or below (sign -1) the line.
static void put_factors(const hn_formula *f, const product *p, int sign, bool is_alone) {
    const bool is_single = is_alone && count_factors(p, sign) == 1;
    bool is_first = true;
    for (int i = 0; i < p->n; i++) {
        if (p->power[i] * sign > 0) {
            hn_strbuf_add(f->b, is_first ? "" : f->language->times);
            put_factor(f, p->base[i], p->power[i] * sign, is_single);
            is_first = false;
        }
    }
}

/// A positive number before factors: halves and quarters are fractions too.
static void put_coefficient(const hn_formula *f, double c) {
    char above[16];
    for (int d = 2; d <= 4; d += 2) {
        const double n = round(c * d);
        if (n / d == c && n < 100 && round(c) != c) {
            snprintf(above, sizeof above, "%.0f", n);
            hn_code_fill(f->b, f->language->fraction, (const char *[]){above, d == 2 ? "2" : "4"});
            return;
        }
    }
    hn_code_number(f->b, f->language, c);
}

/// A term of a sum, with its sign.
static void put_term(const hn_formula *f, hn_ex e, bool *is_first) {
    product p = {.c = e.c};
    collect(f, &p, e.n, 1);
    order(f, &p);
    hn_strbuf_add(f->b, p.c < 0 ? (*is_first ? "-" : " - ") : *is_first ? "" : " + ");
    *is_first = false;
    p.c = fabs(p.c);

    const int above = count_factors(&p, 1), below = count_factors(&p, -1);
    if (above + below == 0) {
        hn_code_number(f->b, f->language, p.c);
        return;
    }
    if (p.c != 1) {
        put_coefficient(f, p.c);
        hn_strbuf_add(f->b, f->language->times);
    }
    if (below == 0) {
        put_factors(f, &p, 1, false);
        return;
    }

    // a quotient
    hn_strbuf_add(f->b, "\\frac{");
    hn_strbuf_add(f->b, above == 0 ? "1" : "");
    put_factors(f, &p, 1, true);
    hn_strbuf_add(f->b, "}{");
    put_factors(f, &p, -1, true);
    hn_strbuf_add(f->b, "}");
}

/// The terms of e behind those that are there; a nested sum becomes terms too.
static void put_sum(const hn_formula *f, hn_ex e, bool *is_first) {
    if (!is_open(f, e.n, HN_OP_SUM)) {
        put_term(f, e, is_first);
        return;
    }
    const hn_node_view view = hn_graph_node(f->g, e.n);
    for (int i = 0; i < view.n_args; i++) {
        put_sum(f, (hn_ex){e.c * view.args[i].c, view.args[i].n}, is_first);
    }
}

void hn_formula_write(const hn_formula *f, hn_ex e) {
    put_inner(f, e);
}

int hn_formula_length(const char *text) {
    int n = 0;
    while (*text) {
        if (*text == '\\') {
            const size_t letters =
                strspn(text + 1, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
            text += letters ? 1 + letters : 2;
            n += letters > 0;
            continue;
        }
        n += !strchr("{}_^ ", *text++);
    }
    return n;
}
