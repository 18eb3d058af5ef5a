// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/matrix_text.h"

#include "base/suggest.h"
#include "grade/parts/formula_frame.h"
#include "grade/parts/latex_letters.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARS = 1000, MAX_DEPTH = 40, MAX_NAME = 32, LONGEST_SHOWN = 60 };

typedef struct parser {
    const char *start, *at;
    const hn_matrix_names *names;
    hn_matrix_desk desk;
    int depth;
    hn_strbuf *read; ///< the text as it is read; NULL: not wanted
} parser;

// ---- reading ----

static hn_status fault(parser *p, const char *what) {
    return hn_diag_set(p->desk.diag, HN_ERR_INPUT, NULL, NULL, "column %d: %s",
                       (int)(p->at - p->start) + 1, what);
}

static void note(parser *p, const char *read) {
    if (p->read) {
        hn_strbuf_add(p->read, read);
    }
}

/// Returns how many characters `sign` takes at `at`, with blanks behind the mark of a power (^ 2,
/// ** 2); 0 when it does not stand there.
static size_t match(const char *at, const char *sign) {
    const char *start = at;
    for (; *sign; sign++) {
        if (*at++ != *sign) {
            return 0;
        }
        const bool power = *sign == '^' || (*sign == '*' && at - start > 1 && at[-2] == '*');
        at += power && sign[1] ? strspn(at, " ") : 0;
    }
    return (size_t)(at - start);
}

/// Returns how many characters `sign` takes at `at`, as a whole: \cdot is not the start of \cdots,
/// nor ^2 that of ^25 or ^2.5, nor .T that of a product with tau; 0 when it does not stand there.
static size_t stands(const char *at, const char *sign) {
    const size_t n = match(at, sign);
    if (n == 0) {
        return 0;
    }
    const unsigned char last = (unsigned char)sign[strlen(sign) - 1], next = (unsigned char)at[n];
    bool whole = !isalpha(last) || sign[0] != '\\' || !isalpha(next);
    if (isdigit(last)) {
        whole = !isdigit(next) && !(next == '.' && isdigit((unsigned char)at[n + 1]));
    } else if (isalpha(last) && sign[0] == '.') {
        whole = !isalnum(next) && next != '_';
    }
    return whole ? n : 0;
}

static void skip(parser *p) {
    static const char *const silent[] = {
        " ",      "\t",      "\n",    "\\,",   "\\;",    "\\:",    "\\!",    "$",
        "\\left", "\\right", "\\big", "\\Big", "\\bigl", "\\bigr", "\\quad", "\\qquad"};
    for (size_t i = 0; i < sizeof silent / sizeof *silent;) {
        const size_t n = stands(p->at, silent[i]);
        p->at += n;
        i = n > 0 ? 0 : i + 1;
    }
}

/// Steps over `sign` when it stands here.
static bool take(parser *p, const char *sign) {
    skip(p);
    const size_t n = stands(p->at, sign);
    p->at += n;
    return n > 0;
}

static bool take_any(parser *p, const char *const *signs) {
    for (int i = 0; signs[i]; i++) {
        if (take(p, signs[i])) {
            return true;
        }
    }
    return false;
}

static const char *const PLUS[] = {"+", NULL};
static const char *const MINUS[] = {"-", "−", "–", NULL};
static const char *const TIMES[] = {"*", "@", "·", "⋅", "×", "\\cdot", "\\times", NULL};
static const char *const PRIMES[] = {"ᵀ", "'", ".'", ".T", "’", "′", NULL};
static const char *const FONTS[] = {"\\mathsf", "\\mathrm", "\\text", "\\mathit", "\\mathbf", NULL};
static const char *const TRANSPOSED[] = {"\\top", "\\intercal", "\\prime", "T", "t", NULL};
static const char *const INVERSE[] = {"^{-1}", "^-1", "^(-1)", "⁻¹", "**-1", NULL};
static const char *const SQUARE[] = {"^2", "^{2}", "²", "**2", NULL};
static const char *const SQUARE_ENTRIES[] = {".^2", ".^{2}", ".**2", NULL};
static const char *const DOT[] = {"\\dot", NULL};
static const char *const BOLD[] = {"\\mathbf", "\\boldsymbol", "\\mathrm",
                                   "\\mathsf", "\\bm",         NULL};

// clang-format off
static const struct {
    const char *utf8, *name;
} LETTERS[] = {{"λ", "lambda"}, {"γ", "gamma"}, {"τ", "tau"}, {"Φ", "Phi"}, {"φ", "phi"},
               {"ϕ", "phi"}, {"α", "alpha"}, {"β", "beta"}, {"θ", "theta"}, {"ω", "omega"},
               {"Ṅ", "Ndot"}, {"\u0307", "dot"}, {"J̇", "Jdot"}};
// clang-format on

enum { N_LETTERS = sizeof LETTERS / sizeof *LETTERS };

/// Commands that stand before an operand, or for a product.
static const char *const COMMANDS[] = {"dot", "mathbf", "boldsymbol", "mathrm", "mathsf",
                                       "bm",  "cdot",   "times",      NULL};

/// The letter in UTF-8 that stands at `at`; N_LETTERS when none does.
static size_t find_letter(const char *at) {
    size_t k = 0;
    while (k < N_LETTERS && strncmp(at, LETTERS[k].utf8, strlen(LETTERS[k].utf8)) != 0) {
        k++;
    }
    return k;
}

/// A name without underscores and backslashes: \tau_a, S_a, N_dot. Empty when none stands here.
static void read_name(parser *p, char name[MAX_NAME]) {
    size_t n = 0;
    bool brace = false;
    name[0] = 0;
    if (*p->at == '\\') {
        // of the commands the letters alone are names
        if (!hn_latex_is_letter(p->at + 1)) {
            return;
        }
        p->at += hn_latex_is_variant(p->at + 1) ? 1 + strlen("var") : 1;
    }

    // letters, digits behind the first, and indices
    while (n < MAX_NAME - 8) {
        const size_t k = find_letter(p->at);
        if (k < N_LETTERS) { // a Greek letter in UTF-8 goes by its name
            n += (size_t)snprintf(name + n, MAX_NAME - n, "%s", LETTERS[k].name);
            p->at += strlen(LETTERS[k].utf8);
        } else if (isalpha((unsigned char)*p->at) || (n > 0 && isdigit((unsigned char)*p->at))) {
            name[n++] = *p->at++;
        } else if (n > 0 && *p->at == '_' && !brace) {
            // the sign of an index and its brace leave nothing in the name
            brace = p->at[1] == '{';
            p->at += 1 + brace;
        } else {
            break;
        }
        name[n] = 0;
    }

    // the brace that the index opened
    if (brace && *p->at != '}') {
        name[0] = 0;
    }
    p->at += brace && *p->at == '}';
}

static hn_status refuse_name(parser *p, const char *name) {
    char hint[HN_DIAG_HINT];
    hn_strbuf known;
    hn_strbuf_init(&known);
    hn_suggest(hint, name, p->names->known, p->names->n_known, NULL);
    hn_formula_put_known(&known, p->names->known, p->names->n_known);
    const hn_status status =
        hn_diag_set(p->desk.diag, HN_ERR_INPUT, NULL, hint,
                    "there is no matrix '%.30s'%s%.120s; products are written with a blank or *",
                    name, hint[0] ? "" : "; ", hint[0] ? "" : hn_strbuf_text(&known));
    hn_strbuf_reset(&known);
    return status;
}

static hn_status look_up(parser *p, const char *name, hn_matrix *out) {
    const hn_matrix *m = p->names->lookup(p->names->user, name);
    char other[MAX_NAME + 4];
    snprintf(other, sizeof other, "%s", name);
    if (!m && name[0] == 'd' && name[1]) { // dN is Ndot
        snprintf(other, sizeof other, "%sdot", name + 1);
        m = p->names->lookup(p->names->user, other);
    }
    if (!m) {
        return refuse_name(p, name);
    }
    note(p, other);
    *out = *m;
    return HN_OK;
}

static hn_status read_sum(parser *p, hn_matrix *out);

static hn_status read_group(parser *p, const char *close, hn_matrix *out) {
    if (++p->depth > MAX_DEPTH) {
        return fault(p, "brackets are nested too deeply");
    }
    const bool round = strcmp(close, "}") != 0; // a brace of LaTeX groups nothing
    note(p, round ? "(" : "");
    HN_TRY(read_sum(p, out));
    note(p, round ? ")" : "");
    p->depth--;
    return take(p, close) ? HN_OK : fault(p, "a bracket is not closed");
}

/// \dot N, \dot{N}: the name with "dot" behind it.
static hn_status read_dotted(parser *p, hn_matrix *out) {
    char name[MAX_NAME], dotted[MAX_NAME + 4];
    const bool brace = take(p, "{");
    skip(p);
    read_name(p, name);
    if (brace && !take(p, "}")) {
        return fault(p, "a brace is not closed");
    }
    snprintf(dotted, sizeof dotted, "%sdot", name);
    return name[0] ? look_up(p, dotted, out) : fault(p, "a name is missing behind \\dot");
}

static hn_status read_word(parser *p, hn_matrix *out) {
    static const char *const modules[] = {"np",    "numpy",  "jnp", "sp",
                                          "scipy", "linalg", "la",  NULL};
    char name[MAX_NAME];

    // the modules before a function, unless a matrix has that name
    do {
        read_name(p, name);
    } while (hn_latex_is_word(name, modules) && !p->names->lookup(p->names->user, name) &&
             *p->at == '.' && isalpha((unsigned char)p->at[1]) && p->at++);
    if (!name[0]) {
        return fault(p, *p->at == '\\' ? "this command of LaTeX is not known here"
                        : *p->at       ? "expected a matrix, a number or a bracket"
                                       : "the formula ends here, and something is missing");
    }

    // a function and its argument
    const bool inverse = strcmp(name, "inv") == 0 || strcmp(name, "Inverse") == 0;
    const bool transposed = strcmp(name, "transpose") == 0 || strcmp(name, "Transpose") == 0;
    const bool round = (inverse || transposed) && take(p, "(");
    if (round || ((inverse || transposed) && take(p, "["))) {
        hn_matrix inner;
        note(p, inverse ? "inv" : "");
        HN_TRY(read_group(p, round ? ")" : "]", &inner));
        note(p, inverse ? "" : "'");
        return inverse ? hn_matrix_invert(&p->desk, &inner, out)
                       : hn_matrix_transpose(&p->desk, &inner, out);
    }
    return look_up(p, name, out);
}

static hn_status read_primary(parser *p, hn_matrix *out) {
    while (take(p, "\\ ")) { // a space of LaTeX: no operand stands before it
    }

    // what stands in brackets is read as a whole
    if (take(p, "(")) {
        return read_group(p, ")", out);
    }
    if (take(p, "[")) {
        return read_group(p, "]", out);
    }

    // marks before a name: the dot of a rate, the bold face of a matrix
    if (take_any(p, DOT)) {
        return read_dotted(p, out);
    }
    if (take_any(p, BOLD) || *p->at == '{') {
        return take(p, "{") ? read_group(p, "}", out) : fault(p, "expected a brace");
    }

    // a number is a matrix of one by one
    if (isdigit((unsigned char)p->at[*p->at == '.'])) {
        char *end;
        *out = hn_matrix_new(p->desk.arena, 1, 1);
        if (!out->x) {
            return HN_ERR_MEMORY;
        }
        out->number = 1;
        out->x[0] = strtod(p->at, &end);
        if (p->read) {
            hn_strbuf_add_n(p->read, p->at, (size_t)(end - p->at));
        }
        p->at = end;
        return isdigit((unsigned char)p->at[*p->at == '.']) ? fault(p, "a number in a number")
                                                            : HN_OK;
    }

    // what is left: a name, or a command
    return read_word(p, out);
}

/// Steps over a mark of the transpose: ', .T, ^T, ^{\top}, ^{\mathsf{T}} and their like.
static bool take_transpose(parser *p) {
    if (take_any(p, PRIMES)) {
        return true;
    }
    const char *before = p->at;
    if (!take(p, "^")) {
        return false;
    }
    const bool outer = take(p, "{");
    const bool inner = take_any(p, FONTS) && take(p, "{");
    if (take_any(p, TRANSPOSED) && (!inner || take(p, "}")) && (!outer || take(p, "}"))) {
        return true;
    }
    p->at = before;
    return false;
}

/// A primary with its marks behind it.
static hn_status read_factor(parser *p, hn_matrix *out) {
    hn_matrix m;
    HN_TRY(read_primary(p, &m));
    for (;;) {
        if (take_transpose(p)) {
            note(p, "'");
            HN_TRY(hn_matrix_transpose(&p->desk, &m, out));
        } else if (take_any(p, SQUARE)) {
            note(p, "^2");
            HN_TRY(hn_matrix_multiply(&p->desk, &m, &m, out));
        } else if (take_any(p, SQUARE_ENTRIES)) {
            note(p, ".^2");
            HN_TRY(hn_matrix_multiply_entries(&p->desk, &m, &m, out));
        } else if (take_any(p, INVERSE)) {
            note(p, "^-1");
            HN_TRY(hn_matrix_invert(&p->desk, &m, out));
        } else {
            *out = m;
            return *p->at == '^' ? fault(p, "the powers known here are ^T, ^2 and ^-1") : HN_OK;
        }
        m = *out;
    }
}

static hn_status read_signed(parser *p, hn_matrix *out) {
    hn_matrix m, minus = {.rows = 1, .cols = 1, .number = 1, .x = &(double){-1}};
    bool negative = false;
    while (take_any(p, MINUS)) {
        negative = !negative;
    }
    take_any(p, PLUS);
    note(p, negative ? "-" : "");
    HN_TRY(read_factor(p, &m));
    if (negative) {
        return hn_matrix_multiply(&p->desk, &minus, &m, out);
    }
    *out = m;
    return HN_OK;
}

/// Kinds of joints between two factors.
typedef enum joint { END, PRODUCT, BESIDE, ENTRIES, QUOTIENT, SOLVE, UNCLEAR } joint;

/// The text has what only LaTeX has, so that a backslash belongs to a command.
static bool is_latex(const parser *p) {
    if (strpbrk(p->start, "{}$") || strstr(p->start, "^\\")) {
        return true;
    }
    for (const char *at = p->start; (at = strchr(at, '\\')) != NULL; at++) {
        const bool open =
            at == p->start || strchr(" +-*(", at[-1]) || isdigit((unsigned char)at[-1]);
        if (hn_latex_is_word(at + 1, COMMANDS) || (open && hn_latex_is_letter(at + 1))) {
            return true;
        }
    }
    return false;
}

/// A backslash behind a factor: MATLAB's left division, or a command or space of LaTeX. If it
/// can be either, it is neither.
static joint read_backslash(parser *p) {
    const char *next = p->at + 1;
    const bool blank = p->at > p->start && p->at[-1] == ' ', latex = is_latex(p);
    if (hn_latex_is_word(next, COMMANDS)) {
        return BESIDE;
    }
    if (hn_latex_is_letter(next)) {
        return blank || latex ? BESIDE : UNCLEAR;
    }

    // LaTeX knows no command of this name: a matrix, a function or a bracket divided from the left
    char name[MAX_NAME];
    parser ahead = *p;
    ahead.at = next;
    skip(&ahead);
    read_name(&ahead, name);
    if (*next == ' ' && blank == latex) {
        return UNCLEAR;
    }
    if (*next == ' ' && latex) {
        return BESIDE;
    }
    static const char *const functions[] = {"inv", "transpose", "Inverse", "Transpose", NULL};
    if (*ahead.at == '\\' || (name[0] && !hn_latex_is_word(name, functions) &&
                              !p->names->lookup(p->names->user, name))) {
        return BESIDE; // reported as an unknown command
    }
    p->at++;
    return SOLVE;
}

static joint read_joint(parser *p) {
    skip(p);
    if (*p->at == '\\' &&
        !hn_latex_is_word(p->at + 1, (const char *const[]){"cdot", "times", NULL})) {
        return read_backslash(p);
    }
    if (take(p, ".*")) {
        return ENTRIES;
    }
    if (take(p, "./") || take(p, "/")) {
        return QUOTIENT;
    }

    // the dot of a product, not that of a number
    const bool dot = *p->at == '.' && !isdigit((unsigned char)p->at[1]);
    if (take_any(p, TIMES) || (dot && take(p, "."))) {
        return PRODUCT;
    }
    const bool ends =
        !*p->at || strchr("+-)]},;", *p->at) || stands(p->at, "−") || stands(p->at, "–");
    return ends ? END : BESIDE;
}

/// a / b with a number b.
static hn_status divide(parser *p, const hn_matrix *a, const hn_matrix *b, hn_matrix *out) {
    hn_matrix inverse;
    if (!b->number) {
        return fault(p, "what stands before this is no number and divides nothing; write inv()");
    }
    HN_TRY(hn_matrix_invert(&p->desk, b, &inverse));
    return hn_matrix_multiply(&p->desk, a, &inverse, out);
}

static hn_status join(parser *p, joint how, const hn_matrix *a, const hn_matrix *b,
                      hn_matrix *out) {
    hn_matrix inverse;
    switch (how) {
    case ENTRIES:
        return hn_matrix_multiply_entries(&p->desk, a, b, out);
    case QUOTIENT:
        return divide(p, a, b, out);
    case SOLVE:
        HN_TRY(hn_matrix_invert(&p->desk, a, &inverse));
        return hn_matrix_multiply(&p->desk, &inverse, b, out);
    default:
        return hn_matrix_multiply(&p->desk, a, b, out);
    }
}

/// A stretch of the formula, without blanks at its ends.
typedef struct span {
    const char *at;
    int n;
} span;

static span make_span(const char *at, const char *end) {
    at += strspn(at, " ");
    while (end > at && end[-1] == ' ') {
        end--;
    }
    return (span){at, (int)(end - at)};
}

/// Says which two operands have shapes that do not fit; `what` cannot be done with them.
static hn_status name_operands(parser *p, hn_status status, span a, const hn_matrix *left, span b,
                               const hn_matrix *right, const char *what) {
    if (status != HN_ERR_UNSUPPORTED || a.n > LONGEST_SHOWN || b.n > LONGEST_SHOWN) {
        return status;
    }
    return hn_diag_set(p->desk.diag, status, NULL, "a factor or a transpose may be missing",
                       "%.*s is %d x %d and %.*s is %d x %d: they cannot be %s", a.n, a.at,
                       left->rows, left->cols, b.n, b.at, right->rows, right->cols, what);
}

static hn_status read_product(parser *p, hn_matrix *out) {
    hn_matrix left, right;
    const char *start = p->at;
    HN_TRY(read_signed(p, &left));
    for (;;) {
        const char *end = p->at;
        const joint how = read_joint(p);
        const char *next = p->at;
        if (how == END) {
            *out = left;
            return HN_OK;
        }
        if (how == UNCLEAR) {
            return fault(p, "this backslash may be LaTeX or a division from the left; write * "
                            "for the product, inv(A)*b for A\\b");
        }
        static const char *const signs[] = {
            [PRODUCT] = "*", [BESIDE] = "*", [ENTRIES] = ".*", [QUOTIENT] = "/", [SOLVE] = "\\"};
        note(p, signs[how]);
        HN_TRY(how == BESIDE ? read_factor(p, &right) : read_signed(p, &right));
        const hn_status status = join(p, how, &left, &right, out);
        HN_TRY(how == SOLVE ? status
                            : name_operands(p, status, make_span(start, end), &left,
                                            make_span(next, p->at), &right, "multiplied"));
        left = *out;
    }
}

static hn_status read_sum(parser *p, hn_matrix *out) {
    hn_matrix left, right;
    const char *start = p->at;
    HN_TRY(read_product(p, &left));
    for (;;) {
        const char *end = p->at;
        const bool plus = take_any(p, PLUS), minus = !plus && take_any(p, MINUS);
        const char *next = p->at;
        if (!plus && !minus) {
            *out = left;
            return HN_OK;
        }
        note(p, plus ? " + " : " - ");
        HN_TRY(read_product(p, &right));
        const hn_status status = hn_matrix_add(&p->desk, &left, &right, plus ? 1 : -1, out);
        HN_TRY(name_operands(p, status, make_span(start, end), &left, make_span(next, p->at),
                             &right, plus ? "added" : "subtracted"));
        left = *out;
    }
}

hn_status hn_matrix_eval(const char *text, const hn_matrix_names *names, hn_arena *arena,
                         hn_matrix *out, hn_diag *diag) {
    return hn_matrix_read(text, names, arena, out, NULL, diag);
}

hn_status hn_matrix_read(const char *text, const hn_matrix_names *names, hn_arena *arena,
                         hn_matrix *out, hn_strbuf *read, hn_diag *diag) {
    parser p = {.start = text, .at = text, .names = names, .desk = {arena, diag}, .read = read};
    if (strlen(text) > MAX_CHARS) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "the formula has more than %d characters", MAX_CHARS);
    }
    HN_TRY(read_sum(&p, out));
    skip(&p);
    return *p.at ? fault(&p, "this was not expected") : HN_OK;
}
