// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/matrix_text.h"

#include "linalg/lu.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHARS = 1000, MAX_DEPTH = 40, MAX_NAME = 32 };

typedef struct parser {
    const char *start, *at;
    const hn_matrix_names *names;
    hn_arena *arena;
    hn_diag *diag;
    int depth;
} parser;

hn_matrix hn_matrix_new(hn_arena *arena, int rows, int cols) {
    return (hn_matrix){
        .rows = rows, .cols = cols, .x = hn_arena_doubles(arena, (size_t)rows * (size_t)cols)};
}

// ---- arithmetic ----

static hn_status shapes(parser *p, const char *what, const hn_matrix *a, const hn_matrix *b) {
    return hn_diag_set(p->diag, HN_ERR_UNSUPPORTED, NULL, "a transpose may be missing",
                       "%s of %d x %d and %d x %d does not exist", what, a->rows, a->cols, b->rows,
                       b->cols);
}

static hn_status make(parser *p, int rows, int cols, hn_matrix *out) {
    *out = hn_matrix_new(p->arena, rows, cols);
    return out->x ? HN_OK : HN_ERR_MEMORY;
}

/// a + sign * b
static hn_status add(parser *p, const hn_matrix *a, const hn_matrix *b, double sign,
                     hn_matrix *out) {
    // the number 0 fits every shape
    if (a->number && a->x[0] == 0 && !b->number) {
        HN_TRY(make(p, b->rows, b->cols, out));
        for (int i = 0; i < b->rows * b->cols; i++) {
            out->x[i] = sign * b->x[i];
        }
        return HN_OK;
    }
    if (b->number && b->x[0] == 0) {
        *out = *a;
        return HN_OK;
    }

    // all else entry by entry, in one shape
    if (a->rows != b->rows || a->cols != b->cols) {
        return shapes(p, "the sum", a, b);
    }
    HN_TRY(make(p, a->rows, a->cols, out));
    out->number = a->number && b->number;
    for (int i = 0; i < a->rows * a->cols; i++) {
        out->x[i] = a->x[i] + sign * b->x[i];
    }
    return HN_OK;
}

static hn_status multiply(parser *p, const hn_matrix *a, const hn_matrix *b, hn_matrix *out) {
    // a number scales
    if (a->number || b->number) {
        const hn_matrix *m = a->number ? b : a;
        const double factor = a->number ? a->x[0] : b->x[0];
        HN_TRY(make(p, m->rows, m->cols, out));
        out->number = a->number && b->number;
        for (int i = 0; i < m->rows * m->cols; i++) {
            out->x[i] = factor * m->x[i];
        }
        return HN_OK;
    }

    // rows by columns
    if (a->cols != b->rows) {
        return shapes(p, "the product", a, b);
    }
    HN_TRY(make(p, a->rows, b->cols, out));
    for (int i = 0; i < a->rows; i++) {
        for (int j = 0; j < b->cols; j++) {
            for (int k = 0; k < a->cols; k++) {
                out->x[i * b->cols + j] += a->x[i * a->cols + k] * b->x[k * b->cols + j];
            }
        }
    }
    return HN_OK;
}

static hn_status transpose(parser *p, const hn_matrix *a, hn_matrix *out) {
    HN_TRY(make(p, a->cols, a->rows, out));
    out->number = a->number;
    for (int i = 0; i < a->rows; i++) {
        for (int j = 0; j < a->cols; j++) {
            out->x[j * a->rows + i] = a->x[i * a->cols + j];
        }
    }
    return HN_OK;
}

static hn_status invert(parser *p, const hn_matrix *a, hn_matrix *out) {
    const int n = a->rows;
    double lu[HN_MATRIX_LARGEST * HN_MATRIX_LARGEST], scale[HN_MATRIX_LARGEST];
    double column[HN_MATRIX_LARGEST];
    int pivot[HN_MATRIX_LARGEST];

    // square, and small enough for the arrays above
    if (n != a->cols || n > HN_MATRIX_LARGEST) {
        return hn_diag_set(p->diag, HN_ERR_UNSUPPORTED, NULL, NULL,
                           "a matrix of %d x %d has no inverse: it is not square", a->rows,
                           a->cols);
    }

    // the factors, of a copy: a stays as it is
    memcpy(lu, a->x, sizeof(double) * (size_t)(n * n));
    HN_TRY(make(p, n, n, out));
    out->number = a->number;
    if (hn_lu_factor(n, lu, pivot, scale) != HN_OK) {
        return hn_diag_set(p->diag, HN_ERR_SINGULAR, NULL, NULL,
                           "a matrix that is inverted here is singular");
    }

    // column j of the inverse solves A x = e_j
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            column[i] = i == j;
        }
        hn_lu_solve(n, lu, pivot, column);
        for (int i = 0; i < n; i++) {
            out->x[i * n + j] = column[i];
        }
    }
    return HN_OK;
}

// ---- reading ----

static hn_status fault(parser *p, const char *what) {
    return hn_diag_set(p->diag, HN_ERR_INPUT, NULL, NULL, "column %d: %s",
                       (int)(p->at - p->start) + 1, what);
}

static void skip(parser *p) {
    static const char *const silent[] = {" ",      "\t",      "\n",  "\\,", "\\;",   "\\ ",
                                         "\\left", "\\right", "\\!", "$",   "\\big", "\\quad"};
    for (size_t i = 0; i < sizeof silent / sizeof *silent;) {
        const size_t n = strlen(silent[i]);
        if (strncmp(p->at, silent[i], n) == 0) {
            p->at += n;
            i = 0;
        } else {
            i++;
        }
    }
}

/// Steps over `sign` when it stands here.
static bool take(parser *p, const char *sign) {
    skip(p);
    const size_t n = strlen(sign);
    if (strncmp(p->at, sign, n) != 0) {
        return false;
    }
    p->at += n;
    return true;
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
static const char *const TRANSPOSE[] = {
    "^{\\top}",       "^{T}",         "^\\top", "^T", "ᵀ", "'", ".T",
    "^{\\mathrm{T}}", "^\\mathrm{T}", "^t",     "’",  "′", NULL};
static const char *const INVERSE[] = {"^{-1}", "^-1", "^(-1)", "⁻¹", "**-1", NULL};
static const char *const SQUARE[] = {"^2", "^{2}", "²", "**2", NULL};
static const char *const DOT[] = {"\\dot", NULL};
static const char *const BOLD[] = {"\\mathbf", "\\boldsymbol", "\\mathrm", "\\bm", NULL};

// clang-format off
static const struct {
    const char *utf8, *name;
} LETTERS[] = {{"λ", "lambda"}, {"γ", "gamma"}, {"τ", "tau"}, {"Φ", "Phi"}, {"φ", "phi"},
               {"Ṅ", "Ndot"}, {"\u0307", "dot"}, {"J̇", "Jdot"}};
// clang-format on

/// A name without underscores and backslashes: \tau_a, S_a, N_dot. Empty when none stands here.
static void read_name(parser *p, char name[MAX_NAME]) {
    size_t n = 0;
    bool brace = false;
    name[0] = 0;
    p->at += *p->at == '\\';

    // letters, digits behind the first, and indices
    while (n < MAX_NAME - 8) {
        // a Greek letter in UTF-8 goes by its name
        size_t k = 0;
        const size_t letters = sizeof LETTERS / sizeof *LETTERS;
        while (k < letters && strncmp(p->at, LETTERS[k].utf8, strlen(LETTERS[k].utf8)) != 0) {
            k++;
        }
        if (k < letters) {
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
    p->at += brace && *p->at == '}';
}

static hn_status look_up(parser *p, const char *name, hn_matrix *out) {
    const hn_matrix *m = p->names->lookup(p->names->user, name);
    char other[MAX_NAME + 4];
    if (!m && name[0] == 'd' && name[1]) { // dN is Ndot
        snprintf(other, sizeof other, "%sdot", name + 1);
        m = p->names->lookup(p->names->user, other);
    }
    if (!m) {
        return hn_diag_set(
            p->diag, HN_ERR_INPUT, NULL, hn_nearest_name(name, p->names->known, p->names->n_known),
            "there is no matrix '%.30s'; products are written with a blank or *", name);
    }
    *out = *m;
    return HN_OK;
}

static hn_status read_sum(parser *p, hn_matrix *out);

static hn_status read_group(parser *p, const char *close, hn_matrix *out) {
    if (++p->depth > MAX_DEPTH) {
        return fault(p, "brackets are nested too deeply");
    }
    HN_TRY(read_sum(p, out));
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
    char name[MAX_NAME];
    read_name(p, name);
    const bool inverse = strcmp(name, "inv") == 0, transposed = strcmp(name, "transpose") == 0;
    if (!name[0]) {
        return fault(p, *p->at ? "expected a matrix, a number or a bracket"
                               : "the formula ends here, and something is missing");
    }
    if ((inverse || transposed) && take(p, "(")) {
        hn_matrix inner;
        HN_TRY(read_group(p, ")", &inner));
        return inverse ? invert(p, &inner, out) : transpose(p, &inner, out);
    }
    return look_up(p, name, out);
}

static hn_status read_primary(parser *p, hn_matrix *out) {
    skip(p);

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
    if (isdigit((unsigned char)*p->at) || *p->at == '.') {
        char *end;
        HN_TRY(make(p, 1, 1, out));
        out->number = 1;
        out->x[0] = strtod(p->at, &end);
        p->at = end > p->at ? end : p->at + 1;
        return HN_OK;
    }

    // what is left: a name, or a command
    return read_word(p, out);
}

/// A primary with its marks behind it.
static hn_status read_factor(parser *p, hn_matrix *out) {
    hn_matrix m;
    HN_TRY(read_primary(p, &m));
    for (;;) {
        if (take_any(p, TRANSPOSE)) {
            HN_TRY(transpose(p, &m, out));
        } else if (take_any(p, SQUARE)) {
            HN_TRY(multiply(p, &m, &m, out));
        } else if (take_any(p, INVERSE)) {
            HN_TRY(invert(p, &m, out));
        } else {
            *out = m;
            return HN_OK;
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
    HN_TRY(read_factor(p, &m));
    if (negative) {
        return multiply(p, &minus, &m, out);
    }
    *out = m;
    return HN_OK;
}

static hn_status read_product(parser *p, hn_matrix *out) {
    hn_matrix left, right;
    HN_TRY(read_signed(p, &left));
    for (;;) {
        const bool sign = take_any(p, TIMES);
        skip(p);
        const bool beside = *p->at && !strchr("+-)]},;", *p->at) && strncmp(p->at, "−", 3) != 0 &&
                            strncmp(p->at, "–", 3) != 0;
        if (!sign && !beside) {
            *out = left;
            return HN_OK;
        }
        HN_TRY(sign ? read_signed(p, &right) : read_factor(p, &right));
        HN_TRY(multiply(p, &left, &right, out));
        left = *out;
    }
}

static hn_status read_sum(parser *p, hn_matrix *out) {
    hn_matrix left, right;
    HN_TRY(read_product(p, &left));
    for (;;) {
        const bool plus = take_any(p, PLUS), minus = !plus && take_any(p, MINUS);
        if (!plus && !minus) {
            *out = left;
            return HN_OK;
        }
        HN_TRY(read_product(p, &right));
        HN_TRY(add(p, &left, &right, plus ? 1 : -1, out));
        left = *out;
    }
}

hn_status hn_matrix_eval(const char *text, const hn_matrix_names *names, hn_arena *arena,
                         hn_matrix *out, hn_diag *diag) {
    parser p = {.start = text, .at = text, .names = names, .arena = arena, .diag = diag};
    if (strlen(text) > MAX_CHARS) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "the formula has more than %d characters", MAX_CHARS);
    }
    HN_TRY(read_sum(&p, out));
    skip(&p);
    return *p.at ? fault(&p, "this was not expected") : HN_OK;
}
