// SPDX-License-Identifier: GPL-3.0-or-later
#include "expr/parse.h"

#include "base/suggest.h"
#include "expr/construct.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_DEPTH = 200, DEFAULT_CHARS = 20000, MAX_NAME = 80, MAX_POWER = 1000, CHUNK = 32 };

/// Precedence climbing over the text. After a fault everything returns zero at once.
typedef struct parser {
    hn_graph *g;
    const char *text;
    size_t at;
    const hn_parse_opts *opts;
    hn_diag *diag;
    hn_status status;
    int depth, max_depth;
} parser;

static hn_ex parse_sum(parser *p);

HN_PRINTF(4, 5)
static hn_ex fail(parser *p, size_t at, const char *hint, const char *format, ...) {
    if (p->status == HN_OK) {
        char what[HN_DIAG_MESSAGE - 32];
        va_list args;
        va_start(args, format);
        vsnprintf(what, sizeof what, format, args);
        va_end(args);
        p->status = hn_diag_set(p->diag, HN_ERR_INPUT, NULL, hint, "column %zu: %s", at + 1, what);
        if (p->diag) {
            p->diag->column = (int)at + 1;
        }
    }
    return hn_num(0);
}

static char peek(parser *p) {
    while (p->text[p->at] == ' ' || p->text[p->at] == '\t' || p->text[p->at] == '\n' ||
           p->text[p->at] == '\r') {
        p->at++;
    }
    return p->text[p->at];
}

/// Names the text here, for a message: "'x'", "the end", "a byte that is not ASCII".
static const char *found(parser *p, char out[32]) {
    const char c = peek(p);
    if (!c) {
        return "the end of the formula";
    }
    if ((unsigned char)c >= 0x80) {
        return "a character outside ASCII";
    }
    if (!isprint((unsigned char)c)) {
        return "a control character";
    }
    snprintf(out, 32, "'%c'", c);
    return out;
}

static const char *how_to_shorten(const parser *p) {
    return p->opts->shorten ? p->opts->shorten : "split it with parameters";
}

static bool enter(parser *p) {
    if (++p->depth > p->max_depth) {
        fail(p, p->at, how_to_shorten(p), "nested more than %d deep", p->max_depth);
        return false;
    }
    return true;
}

static bool is_name_start(char c) {
    return isalpha((unsigned char)c) || c == '_';
}

static bool is_name_char(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

/// Digits with an optional fraction and exponent; the end of it, or NULL. strtod alone would take
/// hex, inf and nan.
static const char *scan_number(const char *s) {
    const char *c = s;
    int digits = 0;
    for (; isdigit((unsigned char)*c); c++) {
        digits++;
    }
    if (*c == '.') {
        for (c++; isdigit((unsigned char)*c); c++) {
            digits++;
        }
    }

    if (!digits) {
        return NULL;
    }

    // an exponent only where digits follow: 2e is 2 and the name e
    if (*c == 'e' || *c == 'E') {
        const char *x = c + 1 + (c[1] == '+' || c[1] == '-');
        if (isdigit((unsigned char)*x)) {
            for (c = x; isdigit((unsigned char)*c); c++) {}
        }
    }
    return c;
}

static hn_ex parse_number(parser *p) {
    const size_t start = p->at;
    const char *end = scan_number(p->text + start);
    if (!end) {
        return fail(p, start, NULL, "a lone '.' is not a number");
    }

    const double value = strtod(p->text + start, NULL);
    p->at = (size_t)(end - p->text);
    if (!isfinite(value)) {
        return fail(p, start, NULL, "%.*s is too large for a double",
                    (int)(p->at - start < 40 ? p->at - start : 40), p->text + start);
    }

    // what may not follow a number
    if (p->text[p->at] == '.') {
        return fail(p, p->at, NULL, "a second '.' in a number");
    }
    const char next = peek(p);
    if (is_name_start(next) || next == '(' || isdigit((unsigned char)next)) {
        char buffer[32];
        return fail(
            p, p->at, "write the product: 3*x; a unit is not written, numbers are in SI units",
            "a number is followed by %s; '*' or another operator is missing", found(p, buffer));
    }
    return hn_num(value);
}

/// A function applied to numbers must give a number.
static hn_ex apply_checked(parser *p, hn_op op, const hn_ex *args, size_t at) {
    const hn_op_info *info = hn_op_get_info(op);
    double x[2] = {0, 0};
    int numbers = 1;
    for (int i = 0; i < info->arity; i++) {
        numbers &= hn_is_number(args[i], &x[i]);
    }
    if (numbers && !isfinite(info->value(x))) {
        return info->arity == 2
                   ? fail(p, at, NULL, "%s(%g, %g) is not a finite number", info->name, x[0], x[1])
                   : fail(p, at, NULL, "%s(%g) is not a finite number", info->name, x[0]);
    }
    return hn_apply(p->g, op, args);
}

static hn_ex unknown_function(parser *p, size_t at, const char *name) {
    const char *names[HN_OP_COUNT + 1];
    int n = 0;
    for (int op = 0; op < HN_OP_COUNT; op++) {
        if (hn_op_get_info((hn_op)op)->typed) {
            names[n++] = hn_op_get_info((hn_op)op)->name;
        }
    }
    names[n++] = "hypot";
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, name, names, n,
               "functions are sin, cos, tan, asin, acos, atan, atan2, sqrt, exp, log, abs and "
               "their like");
    return fail(p, at, hint, "there is no function '%.60s'", name);
}

/// The arguments behind '(' up to ')'; how many, at most `max` of them kept.
static int parse_arguments(parser *p, hn_ex *args, int max) {
    int n = 0;
    p->at++; // (
    if (peek(p) == ')') {
        p->at++;
        return 0;
    }

    // all are read, the first `max` kept: the caller reports how many there are
    for (;;) {
        const hn_ex a = parse_sum(p);
        if (n < max) {
            args[n] = a;
        }
        n++;
        const char c = peek(p);
        if (p->status != HN_OK) {
            return n;
        }
        if (c == ')') {
            p->at++;
            return n;
        }
        if (c != ',') {
            char buffer[32];
            fail(p, p->at, NULL, "%s was found where ',' or ')' is expected", found(p, buffer));
            return n;
        }
        p->at++;
    }
}

/// sqrt(x^2 + y^2); a square that no double holds is refused.
static hn_ex hypotenuse(parser *p, const hn_ex args[2], size_t at) {
    hn_ex square[2];
    for (int i = 1; i >= 0; i--) {
        square[i] = hn_mul(p->g, args[i], args[i]);
        if (!isfinite(args[i].c * args[i].c)) {
            return fail(p, at, "divide both by a common factor",
                        "hypot: the square of a number near %g is too large for a double",
                        args[i].c);
        }
    }
    return hn_sqrt(p->g, hn_add(p->g, square[0], square[1]));
}

static hn_ex parse_call(parser *p, size_t at, const char *name) {
    const int is_hypot = strcmp(name, "hypot") == 0;
    const hn_op op = hn_op_find(name);
    if (op == HN_OP_COUNT && !is_hypot) {
        return unknown_function(p, at, name);
    }

    const int arity = is_hypot ? 2 : hn_op_get_info(op)->arity;
    hn_ex args[2] = {hn_num(0), hn_num(0)};
    const int n = parse_arguments(p, args, 2);
    if (p->status != HN_OK) {
        return hn_num(0);
    }
    if (n != arity) {
        return fail(p, at, NULL, "%s takes %d argument%s; %d %s given", name, arity,
                    arity == 1 ? "" : "s", n, n == 1 ? "was" : "were");
    }

    // hypot is no operator: sqrt(a^2 + b^2)
    if (is_hypot) {
        return hypotenuse(p, args, at);
    }
    return apply_checked(p, op, args, at);
}

static hn_ex unknown_name(parser *p, size_t at, const char *name) {
    char hint[HN_DIAG_HINT] = "";
    const char *near = hn_nearest_name(name, p->opts->known, p->opts->n_known);
    if (strcmp(name, "nan") == 0 || strcmp(name, "inf") == 0 || strcmp(name, "NaN") == 0 ||
        strcmp(name, "Infinity") == 0) {
        return fail(p, at, NULL, "'%s' is not a number that a formula may hold", name);
    }
    if (near) {
        snprintf(hint, sizeof hint, "did you mean '%.80s'?", near);
    } else if (hn_op_find(name) != HN_OP_COUNT) {
        snprintf(hint, sizeof hint, "a function needs its argument in parentheses: %s(x)", name);
    }
    return fail(p, at, hint, "'%.60s' is not known here", name);
}

static hn_ex parse_name(parser *p) {
    const size_t start = p->at;
    char name[MAX_NAME];
    size_t n = 0;
    while (is_name_char(p->text[p->at])) {
        if (n + 1 == MAX_NAME) {
            return fail(p, start, NULL, "a name is longer than %d characters", MAX_NAME - 1);
        }
        name[n++] = p->text[p->at++];
    }
    name[n] = 0;

    // a function, a name of the context, a built-in constant
    if (peek(p) == '(') {
        return parse_call(p, start, name);
    }
    hn_ex value;
    if (p->opts->lookup && p->opts->lookup(p->opts->user, name, &value)) {
        return value;
    }
    if (strcmp(name, "pi") == 0) {
        return hn_num(3.14159265358979323846);
    }
    if (strcmp(name, "e") == 0) {
        return hn_num(2.71828182845904523536);
    }
    return unknown_name(p, start, name);
}

static hn_ex parse_group(parser *p) {
    const size_t open = p->at++;
    const hn_ex inside = parse_sum(p);
    const char c = peek(p);
    if (p->status != HN_OK) {
        return hn_num(0);
    }
    if (c == ',') {
        return fail(p, p->at, "write 0.5, not 0,5",
                    "',' separates arguments of a function; it is no decimal point");
    }
    if (c != ')') {
        char buffer[32];
        return fail(p, p->at, NULL, "%s was found where ')' is expected, for the '(' at column %zu",
                    found(p, buffer), open + 1);
    }
    p->at++;
    return inside;
}

static hn_ex parse_atom(parser *p) {
    const char c = peek(p);
    if (isdigit((unsigned char)c) || c == '.') {
        return parse_number(p);
    }
    if (is_name_start(c)) {
        return parse_name(p);
    }
    if (c == '(') {
        return parse_group(p);
    }
    char buffer[32];
    const char *hint = (unsigned char)c >= 0x80
                           ? "write names in ASCII: th1, omega; pi for the circle's number"
                           : NULL;
    return fail(p, p->at, hint, "%s was found where a number, a name or '(' is expected",
                found(p, buffer));
}

static hn_ex raise_to(parser *p, hn_ex base, hn_ex exponent, size_t at) {
    double n, b;
    if (hn_is_number(exponent, &n) && n == floor(n) && fabs(n) <= MAX_POWER) {
        if (hn_is_number(base, &b) && !isfinite(pow(b, n))) {
            return fail(p, at, NULL, "%g^%g is not a finite number", b, n);
        }
        return hn_pow_int(p->g, base, (int)n);
    }
    const hn_ex args[2] = {base, exponent};
    return apply_checked(p, HN_OP_POW, args, at);
}

static hn_ex parse_signed(parser *p);

/// atom, or atom ^ signed power: right associative and above the sign, so that -x^2 is -(x^2).
static hn_ex parse_power(parser *p) {
    const hn_ex base = parse_atom(p);
    const char c = peek(p);
    const size_t at = p->at;
    if (p->status != HN_OK) {
        return hn_num(0);
    }
    if (c == '^' || (c == '*' && p->text[at + 1] == '*')) {
        p->at += c == '^' ? 1 : 2;

        // as deep as pow(base, exponent), which is how it is printed: what is read here can be
        // read again
        const hn_ex exponent = enter(p) ? parse_signed(p) : hn_num(0);
        p->depth--;
        return p->status == HN_OK ? raise_to(p, base, exponent, at) : hn_num(0);
    }
    return base;
}

static hn_ex parse_signed(parser *p) {
    const char c = peek(p);
    if (!enter(p)) {
        return hn_num(0);
    }
    hn_ex e;
    if (c == '-' || c == '+') {
        p->at++;
        e = parse_signed(p);
        e = c == '-' ? hn_neg(e) : e;
    } else {
        e = parse_power(p);
    }
    p->depth--;
    return e;
}

static hn_ex parse_product(parser *p) {
    hn_ex e = parse_signed(p);
    while (p->status == HN_OK) {
        const char c = peek(p);
        const size_t at = p->at;
        if (c != '*' && c != '/') {
            break;
        }
        p->at++;

        const hn_ex b = parse_signed(p);
        double divisor;
        if (c == '*') {
            e = hn_mul(p->g, e, b);
        } else if (hn_is_number(b, &divisor) && p->status == HN_OK &&
                   (divisor == 0 || !isfinite(1 / divisor))) {
            return fail(p, at, NULL, "division by %g", divisor);
        } else {
            e = hn_div(p->g, e, b);
        }

        // numbers fold at once: say where they overflow
        if (!isfinite(e.c)) {
            return fail(p, at, NULL, "the product of the numbers here is too large for a double");
        }
    }
    return e;
}

/// The terms of one chain of + and -, so that it becomes one flat sum. Few fit without asking for
/// memory.
typedef struct chain {
    hn_ex *term;
    int n, cap;
    hn_ex few[CHUNK];
} chain;

static bool chain_add(parser *p, chain *s, hn_ex term) {
    if (s->n == s->cap) {
        hn_ex *term_list = malloc(2 * (size_t)s->cap * sizeof *term_list);
        if (!term_list) {
            p->status = hn_diag_set(p->diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
            return false;
        }
        memcpy(term_list, s->term, (size_t)s->n * sizeof *term_list);
        if (s->term != s->few) {
            free(s->term);
        }
        s->term = term_list;
        s->cap *= 2;
    }
    s->term[s->n++] = term;
    return true;
}

/// False where a coefficient of the expression, or of its terms, left the range of numbers.
static int is_finite(const hn_graph *g, hn_ex e) {
    const hn_node_view node = hn_graph_node(g, e.n);
    int all = isfinite(e.c) != 0;
    for (int i = 0; node.op == HN_OP_SUM && i < node.n_args; i++) {
        all = all && isfinite(node.args[i].c);
    }
    return all;
}

static hn_ex parse_sum(parser *p) {
    if (!enter(p)) {
        return hn_num(0);
    }
    size_t at = p->at;
    chain s = {.n = 0, .cap = CHUNK};
    s.term = s.few;

    // terms are gathered and summed at once: a chain of sums would cost n^2
    char sign = '+';
    int more = 0;
    do {
        const hn_ex term = parse_product(p);
        if (p->status != HN_OK || !chain_add(p, &s, sign == '-' ? hn_neg(term) : term)) {
            break;
        }
        sign = peek(p);
        more = sign == '+' || sign == '-';
        if (more) {
            at = p->at++;
        }
    } while (more);

    hn_ex e = p->status != HN_OK ? hn_num(0) : s.n == 1 ? s.term[0] : hn_sum(p->g, s.term, s.n);
    if (!is_finite(p->g, e)) {
        e = fail(p, at, NULL, "the sum of the numbers here is too large for a double");
    }
    if (s.term != s.few) {
        free(s.term);
    }
    p->depth--;
    return e;
}

static hn_ex unexpected_rest(parser *p) {
    char buffer[32];
    const char c = peek(p);
    const char *hint = c == ','   ? "write 0.5, not 0,5"
                       : c == '=' ? "write the difference: the formula is set to zero"
                       : is_name_start(c) || isdigit((unsigned char)c) || c == '('
                           ? "write the product: a*b"
                           : NULL;
    if (c == ')') {
        return fail(p, p->at, NULL, "a ')' without its '('");
    }
    return fail(p, p->at, hint, "%s was found where an operator or the end is expected",
                found(p, buffer));
}

hn_status hn_parse(hn_graph *g, const char *text, const hn_parse_opts *opts, hn_ex *out,
                   hn_diag *diag) {
    static const hn_parse_opts none = {0};
    parser p = {.g = g, .text = text, .opts = opts ? opts : &none, .diag = diag};
    p.max_depth = p.opts->max_depth > 0 ? p.opts->max_depth : DEFAULT_DEPTH;
    const int max_chars = p.opts->max_chars > 0 ? p.opts->max_chars : DEFAULT_CHARS;
    const size_t n = strlen(text);

    // texts that are no formula
    if (n > (size_t)max_chars) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, how_to_shorten(&p),
                           "the formula has %zu characters; at most %d are read", n, max_chars);
    }
    if (peek(&p) == 0) {
        fail(&p, 0, NULL, "the formula is empty");
        return p.status;
    }

    // one expression and nothing behind it
    const hn_ex e = parse_sum(&p);
    if (p.status == HN_OK && peek(&p) != 0) {
        unexpected_rest(&p);
    }
    if (p.status == HN_OK && hn_graph_failed(g)) {
        p.status = hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "out of memory");
    }
    if (p.status == HN_OK) {
        *out = e;
    }
    return p.status;
}
