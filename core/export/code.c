// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/code.h"

#include "export/formula.h"
#include "export/numbers.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 4 << 20, LONGEST = 160 }; // of all code; of a piece inside a line
enum { SHORT = 24, REPEATED = 120 };         // letters seen: of a piece, of its copies in a formula
enum { MOST_NAMED = 4 };                     // coordinates and velocities beside a piece

/// Binding strength of a piece; a weaker piece inside a stronger one gets parentheses.
typedef enum level { LEVEL_SUM, LEVEL_PRODUCT, LEVEL_ATOM } level;

typedef struct writer {
    hn_strbuf *b;
    const hn_graph *g;
    const hn_language *language;
    int indent;
    int n_nodes, n_shared;
    int *uses;     ///< of each node, by nodes and entries
    int *variable; ///< of each shared node (formula.h), 0: none yet
    int *kind;     ///< of each node (hn_piece_kind); NULL: they are not told apart
    const hn_code_symbols *symbols;
    const char *prefix[HN_PIECE_KINDS]; ///< of variables, that no symbol of the scene begins with
} writer;

// ---- which nodes get a variable ----

/// Counts how often each node below `node` is used; a node's own arguments count once.
static void count_uses(writer *w, int32_t node, int *stack) {
    int n = 0;
    w->uses[node]++;
    if (w->uses[node] > 1) {
        return;
    }
    stack[n++] = node;
    while (n > 0) {
        const hn_node_view view = hn_graph_node(w->g, stack[--n]);
        for (int i = 0; i < view.n_args; i++) {
            const int32_t arg = view.args[i].n;
            if (w->uses[arg]++ == 0) {
                stack[n++] = arg;
            }
        }
    }
}

static bool is_leaf(const writer *w, int32_t node) {
    const hn_op op = hn_graph_node(w->g, node).op;
    return op == HN_OP_ONE || op == HN_OP_SYMBOL;
}

static bool has_symbol(const int *list, int n, int symbol) {
    for (int i = 0; i < n; i++) {
        if (list[i] == symbol) {
            return true;
        }
    }
    return false;
}

/// A prefix such that no symbol is prefix and digits: "k", "kk", ...
static const char *choose_prefix(const hn_graph *g, hn_piece_kind kind) {
    static const char *const all[HN_PIECE_KINDS + 1][4] = {
        {"c", "cc", "constant", "holonom_constant"},
        {"k", "kk", "shared", "holonom_shared"},
        {"u", "uu", "moving", "holonom_moving"},
        {"n", "nn", "number", "holonom_number"}};
    const char *const *const candidates = all[kind];
    for (int c = 0; c < 3; c++) {
        const size_t n = strlen(candidates[c]);
        bool free = true;
        for (int i = 0; i < hn_graph_n_symbols(g); i++) {
            const char *name = hn_graph_symbol_name(g, i);
            free &= strncmp(name, candidates[c], n) != 0 || !isdigit((unsigned char)name[n]);
        }
        if (free) {
            return candidates[c];
        }
    }
    return candidates[3];
}

// ---- expressions ----

static void put_ex(writer *w, hn_ex e, level around);

static const char *times(const writer *w) {
    return w->language->times ? w->language->times : "*";
}

/// The name of a shared piece's variable.
static void put_variable(hn_strbuf *b, const writer *w, int variable) {
    char name[32];
    hn_formula_variable_name(w->prefix, variable, name);
    hn_code_name(b, w->language, name);
}

/// A call by its form, or as name(arguments).
static void put_call(writer *w, const hn_node_view *view) {
    const char *form = w->language->call[view->op];
    if (!form) {
        hn_strbuf_printf(w->b, "%s(", hn_op_get_info(view->op)->name);
        for (int i = 0; i < view->n_args; i++) {
            hn_strbuf_add(w->b, i ? ", " : "");
            put_ex(w, view->args[i], LEVEL_SUM);
        }
        hn_strbuf_add(w->b, ")");
        return;
    }
    for (const char *c = form; *c; c++) {
        if (*c == '#') {
            put_ex(w, view->args[*++c - '1'], LEVEL_SUM);
        } else {
            hn_strbuf_add_n(w->b, c, 1);
        }
    }
}

static void put_sum(writer *w, const hn_node_view *view) {
    for (int i = 0; i < view->n_args; i++) {
        hn_ex term = view->args[i];
        hn_strbuf_add(w->b, i == 0 ? "" : term.c < 0 ? " - " : " + ");
        term.c = i == 0 ? term.c : fabs(term.c);
        put_ex(w, term, LEVEL_PRODUCT);
    }
}

/// A node without its coefficient: its variable, or its own text.
static void put_node(writer *w, int32_t node, level around) {
    const hn_node_view view = hn_graph_node(w->g, node);
    if (w->variable[node] > 0) {
        put_variable(w->b, w, w->variable[node]);
        return;
    }

    // a quotient inside a product is safer in parentheses than left to the order of operators
    const level own = view.op == HN_OP_SUM                             ? LEVEL_SUM
                      : view.op == HN_OP_MUL || view.op == HN_OP_RECIP ? LEVEL_PRODUCT
                                                                       : LEVEL_ATOM;
    const bool parentheses =
        own < around || (own == LEVEL_PRODUCT && view.op == HN_OP_RECIP && around > LEVEL_SUM);
    hn_strbuf_add(w->b, parentheses ? "(" : "");
    if (view.op == HN_OP_SYMBOL) {
        hn_code_name(w->b, w->language, hn_graph_symbol_name(w->g, view.symbol));
    } else if (view.op == HN_OP_SUM) {
        put_sum(w, &view);
    } else if (view.op == HN_OP_MUL) {
        put_ex(w, view.args[0], LEVEL_PRODUCT);
        hn_strbuf_add(w->b, times(w));
        put_ex(w, view.args[1], LEVEL_PRODUCT);
    } else {
        put_call(w, &view);
    }
    hn_strbuf_add(w->b, parentheses ? ")" : "");
}

/// A coefficient times a node.
static void put_ex(writer *w, hn_ex e, level around) {
    if (e.n == HN_NODE_ONE) {
        const bool parentheses = e.c < 0 && around > LEVEL_SUM;
        hn_strbuf_add(w->b, parentheses ? "(" : "");
        hn_code_number(w->b, w->language, e.c);
        hn_strbuf_add(w->b, parentheses ? ")" : "");
        return;
    }

    // a coefficient of 1 is not written, one of -1 is a sign
    if (e.c == 1) {
        put_node(w, e.n, around);
        return;
    }
    const bool parentheses = e.c < 0 && around > LEVEL_PRODUCT;
    hn_strbuf_add(w->b, parentheses ? "(" : "");
    if (e.c == -1) {
        hn_strbuf_add(w->b, "-");
    } else {
        hn_code_number(w->b, w->language, e.c);
        hn_strbuf_add(w->b, times(w));
    }
    put_node(w, e.n, LEVEL_ATOM);
    hn_strbuf_add(w->b, parentheses ? ")" : "");
}

// ---- statements ----

/// The text of an expression on its own; reset by the caller.
static void text_of(writer *w, hn_ex e, hn_strbuf *text) {
    hn_strbuf *outer = w->b;
    w->b = text;
    hn_strbuf_clear(text);
    if (w->language->raised) {
        const hn_formula formula = {text, w->g, w->language, w->variable, w->prefix};
        hn_formula_write(&formula, e);
    } else {
        put_ex(w, e, LEVEL_SUM);
    }
    w->b = outer;
}

static void begin_line(writer *w) {
    hn_strbuf_printf(w->b, "%*s", w->indent, "");
}

/// Returns whether a piece stands where it is used: where that is one place, or, in a formula to
/// read, where its copies are short. Long pieces have a line of their own.
static bool is_written_out(const writer *w, int uses, const hn_strbuf *text) {
    if (!w->language->raised) {
        return uses < 2 && text->n <= LONGEST;
    }
    const int length = hn_formula_length(hn_strbuf_text(text));
    return length <= SHORT || (length <= LONGEST && length * (uses - 1) <= REPEATED);
}

/// Names the coordinates and velocities that a piece depends on, where they are few.
static void put_dependence(writer *w, int32_t node) {
    const hn_code_symbols *s = w->symbols;
    hn_strbuf names;
    int n = 0;
    hn_strbuf_init(&names);
    for (int i = 0; i < s->nq + s->nv && n <= MOST_NAMED; i++) {
        const int symbol = i < s->nq ? s->q[i] : s->v[i - s->nq];
        if (hn_depends_on(w->g, (hn_ex){1, node}, symbol)) {
            hn_strbuf_add(&names, n++ ? ",\\, " : "");
            hn_code_name(&names, w->language, hn_graph_symbol_name(w->g, symbol));
        }
    }
    if (n > 0 && n <= MOST_NAMED) {
        hn_code_fill(w->b, w->language->depends, (const char *[]){hn_strbuf_text(&names)});
    }
    w->b->failed |= names.failed;
    hn_strbuf_reset(&names);
}

/// Gives a node a variable, and writes its line.
static void write_piece(writer *w, int32_t node, const char *text) {
    hn_strbuf name;
    hn_strbuf_init(&name);
    const hn_piece_kind kind = w->kind ? (hn_piece_kind)w->kind[node] : HN_PIECE_POSITION;
    const int variable = hn_formula_variable(++w->n_shared, kind);
    put_variable(&name, w, variable);
    begin_line(w);
    hn_code_fill(w->b, w->language->constant, (const char *[]){hn_strbuf_text(&name), text});
    if (w->kind) {
        put_dependence(w, node);
    }
    hn_strbuf_add(w->b, "\n");
    w->b->failed |= name.failed;
    hn_strbuf_reset(&name);
    w->variable[node] = variable;
}

/// Gives a variable to each node that is shared, or whose text is long. Arguments have smaller
/// numbers than the nodes that use them, so the order of numbers is an order to compute in.
static void write_shared(writer *w, hn_piece_kind kind, hn_strbuf *text) {
    w->n_shared = w->kind ? 0 : w->n_shared; // kinds are counted by themselves
    for (int32_t node = 0; node < w->n_nodes && w->b->n < MAX_BYTES; node++) {
        if (w->uses[node] == 0 || is_leaf(w, node) || w->variable[node] > 0 ||
            (w->kind && w->kind[node] != (int)kind)) {
            continue;
        }
        text_of(w, (hn_ex){1, node}, text);
        if (is_written_out(w, w->uses[node], text)) {
            continue;
        }
        if (w->kind && w->n_shared == 0) {
            begin_line(w);
            hn_strbuf_printf(w->b, "%s\n", w->language->pieces[kind]);
        }
        write_piece(w, node, hn_strbuf_text(text));
    }
}

/// Pieces of one kind after another: what depends on less stands first. Without kinds all at once.
static void write_all_shared(writer *w, hn_strbuf *text) {
    if (!w->kind) {
        write_shared(w, HN_PIECE_POSITION, text);
        return;
    }
    const int nq = w->symbols->nq, nv = w->symbols->nv;
    for (int32_t node = 0; node < w->n_nodes; node++) {
        const hn_node_view view = hn_graph_node(w->g, node);
        int kind = HN_PIECE_CONSTANT;
        for (int i = 0; i < view.n_args; i++) {
            const int of_arg = w->kind[view.args[i].n];
            kind = of_arg > kind ? of_arg : kind;
        }
        if (view.op == HN_OP_SYMBOL) {
            const bool is_v = has_symbol(w->symbols->v, nv, view.symbol);
            const bool is_q = has_symbol(w->symbols->q, nq, view.symbol);
            kind = is_v                                   ? HN_PIECE_VELOCITY
                   : is_q || view.symbol == w->symbols->t ? HN_PIECE_POSITION
                                                          : HN_PIECE_CONSTANT;
        }
        w->kind[node] = kind;
    }
    for (int kind = 0; kind < HN_PIECE_KINDS; kind++) {
        write_shared(w, (hn_piece_kind)kind, text);
    }
}

static void write_entry(writer *w, const hn_code_entry *e, hn_strbuf *text) {
    char row[16], column[16];
    hn_strbuf array;
    hn_strbuf_init(&array);
    if (w->language->put_array) {
        w->language->put_array(&array, e->array);
    } else {
        hn_strbuf_add(&array, e->array);
    }

    // the statement: an entry of a vector or of a matrix
    const char *const name = hn_strbuf_text(&array);
    text_of(w, e->value, text);
    snprintf(row, sizeof row, "%d", e->row + w->language->first);
    snprintf(column, sizeof column, "%d", e->column + w->language->first);
    begin_line(w);
    if (e->column < 0) {
        hn_code_fill(w->b, w->language->vector, (const char *[]){name, row, hn_strbuf_text(text)});
    } else {
        hn_code_fill(w->b, w->language->matrix,
                     (const char *[]){name, row, column, hn_strbuf_text(text)});
    }
    hn_strbuf_add(w->b, "\n");
    w->b->failed |= array.failed;
    hn_strbuf_reset(&array);
}

hn_status hn_code_write(hn_strbuf *b, const hn_graph *g, const hn_language *language,
                        const hn_code_symbols *symbols, const hn_code_entry *entries, int n,
                        int indent) {
    const int n_nodes = hn_graph_size(g);
    const size_t from = b->n;
    int *scratch = calloc(4 * (size_t)n_nodes + 1, sizeof *scratch);
    if (!scratch) {
        return HN_ERR_MEMORY;
    }
    writer w = {.b = b,
                .g = g,
                .language = language,
                .indent = indent,
                .n_nodes = n_nodes,
                .uses = scratch,
                .variable = scratch + n_nodes,
                .kind = symbols && language->pieces[0] ? scratch + 3 * n_nodes : NULL,
                .symbols = symbols};
    for (int kind = 0; kind < HN_PIECE_KINDS; kind++) {
        w.prefix[kind] = choose_prefix(g, (hn_piece_kind)kind);
    }
    hn_strbuf text;
    hn_strbuf_init(&text);

    // shared pieces first, in the order of their numbers, then the entries
    for (int i = 0; i < n; i++) {
        count_uses(&w, entries[i].value.n, scratch + 2 * n_nodes);
    }
    write_all_shared(&w, &text);
    for (int i = 0; i < n && b->n < MAX_BYTES; i++) {
        write_entry(&w, &entries[i], &text);
    }

    if (language->numbers && b->n < MAX_BYTES) {
        hn_code_name_numbers(b, from, language, choose_prefix(g, HN_PIECE_NUMBER));
    }

    const bool failed = b->failed || text.failed;
    hn_strbuf_reset(&text);
    free(scratch);
    return failed ? HN_ERR_MEMORY : b->n >= MAX_BYTES ? HN_ERR_LIMIT : HN_OK;
}
