// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/code.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 4 << 20, LONGEST = 160 }; // of all code; of a piece inside a line

/// How tightly a piece binds; a weaker piece inside a stronger one gets parentheses.
typedef enum level { LEVEL_SUM, LEVEL_PRODUCT, LEVEL_ATOM } level;

typedef struct writer {
    hn_strbuf *b;
    const hn_graph *g;
    const hn_language *language;
    int indent;
    int n_nodes, n_shared;
    int *uses;          ///< of each node, by nodes and entries
    int *variable;      ///< number of a shared node's variable, 0: none yet
    const char *prefix; ///< of variables, that no symbol of the scene begins with
} writer;

// ---- numbers, names, forms ----

enum { LARGEST_DENOMINATOR = 24 }; // of the fractions that inertias of simple bodies bring

/// Writes a number that is a fraction to the last bit, 1/3, as one; false where it is none.
static bool put_fraction(hn_strbuf *b, const hn_language *language, double value) {
    char above[16], below[16];
    for (int d = 3; d <= LARGEST_DENOMINATOR && fabs(value) < 1000; d++) {
        const double n = round(fabs(value) * d);
        if (n >= 1 && n / d == fabs(value) && round(1000 * value) != 1000 * value) {
            snprintf(above, sizeof above, "%.0f", n);
            snprintf(below, sizeof below, "%d", d);
            hn_strbuf_add(b, value < 0 ? "-" : "");
            hn_code_fill(b, language->fraction, (const char *[]){above, below});
            return true;
        }
    }
    return false;
}

void hn_code_number(hn_strbuf *b, const hn_language *language, double value) {
    char text[40];
    if (language->fraction && put_fraction(b, language, value)) {
        return;
    }
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    // a number of few digits needs no power of ten to be read
    if (language->fraction && fabs(value) >= 1e-3 && fabs(value) < 1e6) {
        snprintf(text, sizeof text, "%.*g", (int)DBL_DIG, value);
        if (strtod(text, NULL) != value) {
            snprintf(text, sizeof text, "%.17g", value);
        }
    }
    char *const e = language->power ? strchr(text, 'e') : NULL;
    if (e) {
        // the power of ten as a number of its own, without its sign of plus and leading zeros
        *e = '\0';
        char exponent[16];
        snprintf(exponent, sizeof exponent, "%d", atoi(e + 1));
        hn_code_fill(b, language->power, (const char *[]){text, exponent});
        return;
    }
    hn_strbuf_add(b, text);
    if (language->needs_point && !strpbrk(text, ".e")) {
        hn_strbuf_add(b, ".0");
    }
}

/// Whether `word` is among the words of `list`.
static bool lists(const char *list, const char *word) {
    const size_t n = strlen(word);
    for (const char *at = list; (at = strstr(at, word)) != NULL; at += n) {
        const bool begins = at == list || at[-1] == ' ', ends = at[n] == ' ' || at[n] == '\0';
        if (begins && ends) {
            return true;
        }
    }
    return false;
}

void hn_code_name(hn_strbuf *b, const hn_language *language, const char *name) {
    char whole[128];
    snprintf(whole, sizeof whole, "%s%s", name, lists(language->reserved, name) ? "_" : "");
    if (language->put_name) {
        language->put_name(b, whole);
    } else {
        hn_strbuf_add(b, whole);
    }
}

void hn_code_words(hn_strbuf *b, const hn_language *language, const char *words) {
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    for (; *words; words++) {
        const unsigned char c = (unsigned char)*words;
        const char kept[2] = {(char)(c < 32 || c == 127 ? ' '
                                     : c == '"'         ? '\''
                                     : c == '\\'        ? '/'
                                                        : c),
                              0};
        hn_strbuf_add(&plain, kept);
    }
    if (language->put_words) {
        language->put_words(b, hn_strbuf_text(&plain));
    } else {
        hn_strbuf_add(b, hn_strbuf_text(&plain));
    }
    b->failed |= plain.failed;
    hn_strbuf_reset(&plain);
}

void hn_code_fill(hn_strbuf *b, const char *form, const char *const *texts) {
    for (const char *c = form; *c; c++) {
        if (*c == '#' && isdigit((unsigned char)c[1])) {
            hn_strbuf_add(b, texts[*++c - '1']);
        } else {
            hn_strbuf_add_n(b, c, 1);
        }
    }
}

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

/// A prefix such that no symbol is prefix and digits: "k", "kk", ...
static const char *choose_prefix(const hn_graph *g) {
    static const char *const candidates[] = {"k", "kk", "shared", "holonom_shared"};
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
static void put_variable(hn_strbuf *b, const writer *w, int number) {
    char name[32];
    snprintf(name, sizeof name, "%s%d", w->prefix, number);
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
    put_ex(w, e, LEVEL_SUM);
    w->b = outer;
}

static void begin_line(writer *w) {
    hn_strbuf_printf(w->b, "%*s", w->indent, "");
}

/// Gives a variable to each node that is shared, or whose text is long. Arguments have smaller
/// numbers than the nodes that use them, so the order of numbers is an order to compute in.
static void write_shared(writer *w, hn_strbuf *text) {
    for (int32_t node = 0; node < w->n_nodes && w->b->n < MAX_BYTES; node++) {
        if (w->uses[node] == 0 || is_leaf(w, node) || w->variable[node] > 0) {
            continue;
        }
        text_of(w, (hn_ex){1, node}, text);
        if (w->uses[node] < 2 && text->n <= LONGEST) {
            continue;
        }
        hn_strbuf name;
        hn_strbuf_init(&name);
        put_variable(&name, w, ++w->n_shared);
        begin_line(w);
        hn_code_fill(w->b, w->language->constant,
                     (const char *[]){hn_strbuf_text(&name), hn_strbuf_text(text)});
        hn_strbuf_add(w->b, "\n");
        w->b->failed |= name.failed;
        hn_strbuf_reset(&name);
        w->variable[node] = w->n_shared;
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
                        const hn_code_entry *entries, int n, int indent) {
    const int n_nodes = hn_graph_size(g);
    int *scratch = calloc(3 * (size_t)n_nodes + 1, sizeof *scratch);
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
                .prefix = choose_prefix(g)};
    hn_strbuf text;
    hn_strbuf_init(&text);

    // shared pieces first, in the order of their numbers, then the entries
    for (int i = 0; i < n; i++) {
        count_uses(&w, entries[i].value.n, scratch + 2 * n_nodes);
    }
    write_shared(&w, &text);
    for (int i = 0; i < n && b->n < MAX_BYTES; i++) {
        write_entry(&w, &entries[i], &text);
    }

    const bool failed = b->failed || text.failed;
    hn_strbuf_reset(&text);
    free(scratch);
    return failed ? HN_ERR_MEMORY : b->n >= MAX_BYTES ? HN_ERR_LIMIT : HN_OK;
}
