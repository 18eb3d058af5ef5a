// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/print.h"

#include "expr/construct.h"
#include "expr/graph_internal.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A shared node is written out at each use, so text can grow far beyond the graph: bounded, see
// hn_print().
enum { MAX_DEPTH = 2000, MAX_BYTES = 4 << 20 };

/// Binding strength of a piece; a weaker piece inside a stronger one gets parentheses.
typedef enum level { LEVEL_SUM, LEVEL_PRODUCT, LEVEL_POWER, LEVEL_ATOM } level;

typedef struct printer {
    hn_strbuf *b;
    const hn_graph *g;
    hn_print_form form;
    int digits, depth;
    size_t start;
} printer;

static void print_ex(printer *p, hn_ex e, level around);

static void put(printer *p, const char *text) {
    hn_strbuf_add(p->b, text);
}

static void open_paren(printer *p) {
    put(p, p->form == HN_PRINT_LATEX ? "\\left(" : "(");
}

static void close_paren(printer *p) {
    put(p, p->form == HN_PRINT_LATEX ? "\\right)" : ")");
}

// ---- numbers ----

/// The shortest text that reads back exactly, or `digits` significant digits.
static void format_number(double value, int digits, char out[40]) {
    for (int n = digits > 0 ? digits : 1; n <= 17; n++) {
        snprintf(out, 40, "%.*g", n, value);
        if (digits > 0 || strtod(out, NULL) == value) {
            return;
        }
    }
}

/// 1/2, 5/12: small fractions read better than decimals.
static bool put_fraction(printer *p, double value) {
    for (int q = 2; q <= 12; q++) {
        const double top = value * q;
        if (fabs(top) < 100 && fabs(top - round(top)) < 1e-12 * fabs(top) &&
            fabs(value - round(value)) > 1e-12) {
            hn_strbuf_printf(p->b, "\\tfrac{%.0f}{%d}", round(top), q);
            return true;
        }
    }
    return false;
}

static void put_latex_number(printer *p, double value) {
    if (put_fraction(p, value)) {
        return;
    }
    char text[40];
    format_number(value, p->digits, text);
    char *e = strchr(text, 'e');
    if (!e) {
        put(p, text);
        return;
    }
    *e = 0;
    hn_strbuf_printf(p->b, "%s \\cdot 10^{%d}", text, (int)strtol(e + 1, NULL, 10));
}

/// The fraction that reads back exactly where decimals would be long: 1/3 for 0.3333333333333333.
/// Returns whether there is one; of a number cut to some digits there is none.
static bool find_fraction(const printer *p, double value, char out[40]) {
    enum { LONG = 10, MOST_TOP = 100, MOST_BOTTOM = 12 };
    if (p->form != HN_PRINT_TEXT || p->digits != 0) {
        return false;
    }
    format_number(value, 0, out);
    for (int q = 3; strlen(out) > LONG && q <= MOST_BOTTOM; q++) {
        const double top = round(value * q);
        if (top >= 1 && top < MOST_TOP && top / q == value) {
            snprintf(out, 40, "%.0f/%d", top, q);
            return true;
        }
    }
    return false;
}

/// value >= 0
static void put_number(printer *p, double value) {
    if (p->form == HN_PRINT_LATEX) {
        put_latex_number(p, value);
        return;
    }
    char text[40];
    if (!find_fraction(p, value, text)) {
        format_number(value, p->digits, text);
    }
    put(p, text);
    if (p->form == HN_PRINT_C && !strpbrk(text, ".e")) {
        put(p, ".0"); // an integer constant would make C divide whole numbers
    }
}

// ---- names ----

static const char *const GREEK[][2] = {
    {"alpha", "\\alpha"}, {"beta", "\\beta"}, {"gamma", "\\gamma"},   {"delta", "\\delta"},
    {"theta", "\\theta"}, {"th", "\\theta"},  {"lambda", "\\lambda"}, {"mu", "\\mu"},
    {"phi", "\\varphi"},  {"psi", "\\psi"},   {"omega", "\\omega"},   {"tau", "\\tau"},
    {"rho", "\\rho"},     {"eta", "\\eta"},   {"kappa", "\\kappa"},
};

void hn_print_latex_name(hn_strbuf *b, const char *name) {
    if (strncmp(name, "d_", 2) == 0 && name[2]) {
        hn_strbuf_add(b, "\\dot{");
        hn_print_latex_name(b, name + 2);
        hn_strbuf_add(b, "}");
        return;
    }

    // the stem is a Greek letter, a single letter or a word
    size_t n = 0;
    while (isalpha((unsigned char)name[n])) {
        n++;
    }
    const char *rest = name + n;
    char stem[80];
    snprintf(stem, sizeof stem, "%.*s", (int)(n < 79 ? n : 79), name);
    const char *greek = NULL;
    for (size_t i = 0; i < sizeof GREEK / sizeof *GREEK; i++) {
        greek = strcmp(GREEK[i][0], stem) == 0 ? GREEK[i][1] : greek;
    }
    if (greek) {
        hn_strbuf_add(b, greek);
    } else {
        hn_strbuf_printf(b, n > 1 ? "\\mathrm{%s}" : "%s", stem);
    }

    // everything behind it is the index
    if (*rest == '_') {
        rest++;
    }
    if (*rest) {
        hn_strbuf_add(b, "_{");
        for (; *rest; rest++) {
            hn_strbuf_printf(b, *rest == '_' ? "\\_" : "%c", *rest);
        }
        hn_strbuf_add(b, "}");
    }
}

static void put_symbol(printer *p, int symbol) {
    const hn_symbol_entry *s = &p->g->symbols[symbol];
    if (p->form != HN_PRINT_LATEX) {
        put(p, s->name);
    } else if (s->latex) {
        put(p, s->latex);
    } else {
        hn_print_latex_name(p->b, s->name);
    }
}

// ---- functions ----

/// A form with #1 and #2 for the arguments.
static void put_template(printer *p, const char *form, const hn_ex *args) {
    for (const char *c = form; *c; c++) {
        if (*c == '#' && (c[1] == '1' || c[1] == '2')) {
            // the base of a power needs its parentheses, everything else stands inside brackets
            const int is_base = strncmp(c + 2, "}^", 2) == 0;
            print_ex(p, args[c[1] - '1'], is_base ? LEVEL_ATOM : LEVEL_SUM);
            c++;
        } else {
            hn_strbuf_add_n(p->b, c, 1);
        }
    }
}

static void put_arguments(printer *p, const hn_ex *args, int n) {
    open_paren(p);
    for (int i = 0; i < n; i++) {
        put(p, i ? ", " : "");
        print_ex(p, args[i], LEVEL_SUM);
    }
    close_paren(p);
}

static void put_function(printer *p, const hn_node *node, int power) {
    const hn_op_info *info = hn_op_get_info((hn_op)node->op);
    if (p->form == HN_PRINT_C) {
        put_template(p, info->c_name, node->args);
        return;
    }
    if (p->form == HN_PRINT_TEXT) {
        put(p, info->name);
        put_arguments(p, node->args, node->n_args);
        return;
    }

    // LaTeX: a template, or a name with its power and arguments
    if (strchr(info->latex, '#')) {
        put_template(p, info->latex, node->args);
        return;
    }
    put(p, info->latex);
    if (power > 1) {
        hn_strbuf_printf(p->b, "^{%d}", power);
    }

    const int lone = node->n_args == 1 && hn_ex_symbol(p->g, node->args[0]) >= 0;
    if (lone) {
        put(p, " ");
        print_ex(p, node->args[0], LEVEL_ATOM);
    } else {
        put_arguments(p, node->args, node->n_args);
    }
}

static bool is_function(const hn_node *node) {
    return node->op > HN_OP_MUL && node->op != HN_OP_RECIP;
}

/// LaTeX writes sin^2 x; only functions with a macro and no template of their own do.
static bool takes_power(const printer *p, const hn_node *node) {
    return p->form == HN_PRINT_LATEX && is_function(node) &&
           !strchr(hn_op_get_info((hn_op)node->op)->latex, '#');
}

// ---- products ----

/// base^power as text of at least the strength of a factor.
static void put_power(printer *p, hn_ex base, int power) {
    const hn_node *node = &p->g->nodes[base.n];
    if (power == 1) {
        print_ex(p, base, LEVEL_POWER);
    } else if (base.c == 1 && takes_power(p, node)) {
        put_function(p, node, power);
    } else if (p->form == HN_PRINT_C) {
        for (int i = 0; i < power; i++) {
            put(p, i ? "*" : "");
            print_ex(p, base, LEVEL_POWER);
        }
    } else {
        print_ex(p, base, LEVEL_ATOM);
        hn_strbuf_printf(p->b, p->form == HN_PRINT_LATEX ? "^{%d}" : "^%d", power);
    }
}

/// The factors of a product; those that are reciprocals stand below the line.
typedef struct parts {
    hn_factor single;
    const hn_factor *f;
    int n, n_top, n_bottom;
} parts;

static parts split_factors(const hn_graph *g, int32_t n, parts *out) {
    const hn_node *node = &g->nodes[n];
    out->single = (hn_factor){n, 1};
    out->f = node->op == HN_OP_MUL ? node->factors : &out->single;
    out->n = node->op == HN_OP_MUL ? node->n_factors : 1;
    out->n_top = out->n_bottom = 0;
    for (int i = 0; i < out->n; i++) {
        if (g->nodes[out->f[i].node].op == HN_OP_RECIP) {
            out->n_bottom++;
        } else {
            out->n_top++;
        }
    }
    return *out;
}

static bool is_bottom(const printer *p, const hn_factor *f) {
    return p->g->nodes[f->node].op == HN_OP_RECIP;
}

static const char *times(const printer *p) {
    return p->form == HN_PRINT_LATEX ? "\\, " : "*";
}

static void put_top(printer *p, const parts *x, double c) {
    int first = 1;
    if (c != 1 || x->n_top == 0) {
        put_number(p, c);
        first = 0;
    }
    for (int i = 0; i < x->n; i++) {
        if (!is_bottom(p, &x->f[i])) {
            put(p, first ? "" : times(p));
            put_power(p, (hn_ex){1, x->f[i].node}, x->f[i].power);
            first = 0;
        }
    }
}

static void put_latex_fraction(printer *p, const parts *x, double c) {
    put(p, "\\frac{");
    put_top(p, x, c);
    put(p, "}{");
    int first = 1;
    for (int i = 0; i < x->n; i++) {
        if (is_bottom(p, &x->f[i])) {
            const hn_ex under = p->g->nodes[x->f[i].node].args[0];
            put(p, first ? "" : times(p));
            if (x->n_bottom == 1 && x->f[i].power == 1) {
                print_ex(p, under, LEVEL_SUM);
            } else {
                put_power(p, under, x->f[i].power);
            }
            first = 0;
        }
    }
    put(p, "}");
}

/// c > 0 times the node.
static void put_product(printer *p, int32_t n, double c) {
    parts x;
    split_factors(p->g, n, &x);
    if (x.n_bottom > 0 && p->form == HN_PRINT_LATEX) {
        put_latex_fraction(p, &x, c);
        return;
    }
    put_top(p, &x, c);
    for (int i = 0; i < x.n; i++) {
        if (is_bottom(p, &x.f[i])) {
            for (int k = 0; k < x.f[i].power; k++) {
                put(p, "/");
                print_ex(p, p->g->nodes[x.f[i].node].args[0], LEVEL_ATOM);
            }
        }
    }
}

// ---- sums ----

/// A factor before a sum is given to its terms: 3*x + 1 reads better than the graph's own 3*(x +
/// 1/3). Text must give the same node when read, so there only where division by the factor brings
/// every coefficient back.
static bool can_distribute(const printer *p, const hn_node *node, double factor) {
    if (factor == 1 || p->form != HN_PRINT_TEXT || p->digits != 0) {
        return true;
    }
    for (int i = 0; i < node->n_args; i++) {
        const double c = node->args[i].c;
        if (factor * c / factor != c || !isnormal(factor * c)) {
            return false;
        }
    }
    return true;
}

static void put_sum(printer *p, const hn_node *node, double factor) {
    for (int i = 0; i < node->n_args; i++) {
        hn_ex term = hn_scale(factor, node->args[i]);
        const int minus = term.c < 0;
        put(p, minus ? (i ? " - " : "-") : (i ? " + " : ""));
        term.c = fabs(term.c);
        // a sum that leads a sum keeps its parentheses as text: read without them it would be flat
        print_ex(p, term, minus || i || p->form == HN_PRINT_TEXT ? LEVEL_PRODUCT : LEVEL_SUM);
    }
}

static level level_of(const printer *p, hn_ex e) {
    const hn_node *node = &p->g->nodes[e.n];
    double value;
    char text[40];
    if (hn_is_number(e, &value)) {
        return value < 0 ? LEVEL_SUM : find_fraction(p, value, text) ? LEVEL_PRODUCT : LEVEL_ATOM;
    }
    if (e.c < 0 || (node->op == HN_OP_SUM && can_distribute(p, node, e.c))) {
        return LEVEL_SUM;
    }
    if (e.c != 1 || node->op == HN_OP_MUL || node->op == HN_OP_RECIP) {
        return LEVEL_PRODUCT;
    }
    return p->form == HN_PRINT_LATEX && takes_power(p, node) ? LEVEL_POWER : LEVEL_ATOM;
}

static void put_unwrapped(printer *p, hn_ex e) {
    const hn_node *node = &p->g->nodes[e.n];
    if (node->op == HN_OP_SUM && can_distribute(p, node, e.c)) {
        put_sum(p, node, e.c);
    } else if (e.c < 0) {
        put(p, "-");
        print_ex(p, hn_neg(e), LEVEL_PRODUCT);
    } else if (e.n == HN_NODE_ONE) {
        put_number(p, e.c);
    } else if (e.c != 1 || node->op == HN_OP_MUL || node->op == HN_OP_RECIP) {
        put_product(p, e.n, e.c);
    } else if (node->op == HN_OP_SYMBOL) {
        put_symbol(p, node->symbol);
    } else {
        put_function(p, node, 1);
    }
}

static void print_ex(printer *p, hn_ex e, level around) {
    if (p->depth >= MAX_DEPTH || p->b->n - p->start > MAX_BYTES) {
        p->b->failed = 1;
    }
    if (p->b->failed) {
        return;
    }
    p->depth++;
    const int wrap = level_of(p, e) < around;
    if (wrap) {
        open_paren(p);
    }
    put_unwrapped(p, e);
    if (wrap) {
        close_paren(p);
    }
    p->depth--;
}

void hn_print(hn_strbuf *b, const hn_graph *g, hn_ex e, hn_print_form form, int digits) {
    printer p = {.b = b, .g = g, .form = form, .digits = digits, .start = b->n};
    print_ex(&p, e, LEVEL_SUM);
}
