// SPDX-License-Identifier: GPL-3.0-or-later
#include "lesson/tex_text.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NAME = 40, MAX_NESTING = 30 };

// clang-format off
static const struct {
    const char *name, *text;
} SYMBOLS[] = {
    {"alpha", "α"}, {"beta", "β"}, {"gamma", "γ"}, {"delta", "δ"}, {"varepsilon", "ε"},
    {"epsilon", "ε"}, {"eta", "η"}, {"theta", "θ"}, {"kappa", "κ"}, {"lambda", "λ"},
    {"mu", "μ"}, {"nu", "ν"}, {"xi", "ξ"}, {"pi", "π"}, {"rho", "ρ"}, {"sigma", "σ"},
    {"tau", "τ"}, {"phi", "φ"}, {"varphi", "φ"}, {"psi", "ψ"}, {"omega", "ω"},
    {"Gamma", "Γ"}, {"Delta", "Δ"}, {"Lambda", "Λ"}, {"Phi", "Φ"}, {"Psi", "Ψ"},
    {"Omega", "Ω"}, {"Sigma", "Σ"}, {"Theta", "Θ"}, {"ell", "ℓ"}, {"partial", "∂"},
    {"le", "≤"}, {"leq", "≤"}, {"ge", "≥"},
    {"geq", "≥"}, {"ne", "≠"}, {"neq", "≠"}, {"approx", "≈"}, {"sim", "~"},
    {"in", "∈"}, {"to", "→"}, {"mapsto", "↦"}, {"sum", "Σ"}, {"int", "∫"},
    {"infty", "∞"}, {"pm", "±"}, {"mp", "∓"}, {"forall", "∀"}, {"Rightarrow", "⇒"},
    {"iff", "⇔"}, {"top", "ᵀ"}, {"dots", "…"}, {"ldots", "…"}, {"cdots", "…"},
    {"vdots", "…"}, {"lVert", "‖"}, {"rVert", "‖"}, {"Vert", "‖"}, {"|", "‖"},
    {"quad", "  "}, {"qquad", "    "}, {",", " "}, {";", " "}, {":", " "}, {"!", ""},
    {" ", " "}, {"{", "{"}, {"}", "}"}, {"%", "%"}, {"left", ""}, {"right", ""}, {"big", ""},
    {"Big", ""}, {"bigl", ""}, {"bigr", ""}, {"Bigl", ""}, {"Bigr", ""}, {"circ", "°"},
    {"prime", "'"}, {"propto", "∝"}, {"otimes", "⊗"},
    {"ll", "≪"}, {"gg", "≫"}, {"langle", "⟨"}, {"rangle", "⟩"}, {"equiv", "≡"},
    {"displaystyle", ""}, {"nabla", "∇"},
};
/// Commands whose argument is shown as it is.
static const char *const PLAIN[] = {"mathbf", "boldsymbol", "mathrm", "text",
                                    "operatorname", "mathit", "mathsf", "mbox"};
/// Accents: a combining character behind the first character of the argument.
static const struct {
    const char *name, *mark;
} ACCENTS[] = {{"dot", "\u0307"}, {"ddot", "\u0308"}, {"hat", "\u0302"}, {"bar", "\u0304"},
               {"tilde", "\u0303"}, {"overline", "\u0304"}, {"vec", "\u20d7"}};
/// Fractions that are one character.
static const struct {
    const char *over, *under, *text;
} FRACTIONS[] = {{"1", "2", "½"}, {"1", "3", "⅓"}, {"2", "3", "⅔"}, {"1", "4", "¼"}};
static const char RAISED[][4] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
static const char LOWERED[][4] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
// clang-format on
#define COUNT(table) ((int)(sizeof(table) / sizeof *(table)))

typedef struct reader {
    const char *at;
    hn_strbuf *out;
    int nesting;
    bool matrix; ///< columns are separated by commas, rows by semicolons
} reader;

static void read_until(reader *r, char stop);

/// Reads what follows as one argument: a group in braces, a command, or one character.
static void read_argument(reader *r, hn_strbuf *into);

static void read_name(reader *r, char name[MAX_NAME]) {
    int n = 0;
    if (!isalpha((unsigned char)*r->at)) {
        name[n++] = *r->at;
        r->at += *r->at != 0;
    }
    while (n < MAX_NAME - 1 && isalpha((unsigned char)*r->at) &&
           (n == 0 || isalpha((unsigned char)name[0]))) {
        name[n++] = *r->at++;
    }
    name[n] = 0;
}

/// The first character of a text, in bytes.
static size_t first_character(const char *text) {
    size_t n = *text != 0;
    while (((unsigned char)text[n] & 0xC0) == 0x80) {
        n++;
    }
    return n;
}

static int is_simple(const char *text) {
    return text[first_character(text)] == 0 || strpbrk(text, " +-*/=") == NULL;
}

static void put_part(hn_strbuf *b, const char *text) {
    hn_strbuf_printf(b, is_simple(text) ? "%s" : "(%s)", text);
}

/// The one character of a fraction; NULL when it has none.
static const char *fraction_character(const char *over, const char *under) {
    for (int i = 0; i < COUNT(FRACTIONS); i++) {
        if (strcmp(FRACTIONS[i].over, over) == 0 && strcmp(FRACTIONS[i].under, under) == 0) {
            return FRACTIONS[i].text;
        }
    }
    return NULL;
}

static void read_fraction(reader *r) {
    hn_strbuf over, under;
    hn_strbuf_init(&over);
    hn_strbuf_init(&under);
    read_argument(r, &over);
    read_argument(r, &under);

    const char *one = fraction_character(hn_strbuf_text(&over), hn_strbuf_text(&under));
    if (one) {
        hn_strbuf_add(r->out, one);
    } else {
        put_part(r->out, hn_strbuf_text(&over));
        hn_strbuf_add(r->out, "/");
        put_part(r->out, hn_strbuf_text(&under));
        // 1/12 m is not 1/(12 m)
        hn_strbuf_add(r->out, isalpha((unsigned char)*r->at) ? " " : "");
    }

    hn_strbuf_reset(&over);
    hn_strbuf_reset(&under);
}

static void read_accent(reader *r, const char *mark) {
    hn_strbuf inner;
    hn_strbuf_init(&inner);
    read_argument(r, &inner);
    const char *text = hn_strbuf_text(&inner);
    const size_t n = first_character(text);
    hn_strbuf_add_n(r->out, text, n);
    hn_strbuf_add(r->out, mark);
    hn_strbuf_add(r->out, text + n);
    hn_strbuf_reset(&inner);
}

/// "{name}" behind \begin and \end; returns whether it is a kind of matrix.
static bool read_environment(reader *r) {
    char name[MAX_NAME];
    int n = 0;
    r->at += *r->at == '{';
    while (*r->at && *r->at != '}' && n < MAX_NAME - 1) {
        name[n++] = *r->at++;
    }
    name[n] = 0;
    r->at += *r->at == '}';
    return strstr(name, "matrix") != NULL;
}

/// Reads what stands between \begin and its \end.
static void read_block(reader *r) {
    const bool outer = r->matrix;
    r->matrix = read_environment(r);
    const bool matrix = r->matrix;
    hn_strbuf_add(r->out, matrix ? "[" : "");
    read_until(r, 0);
    hn_strbuf_add(r->out, matrix ? "]" : "");
    read_environment(r);
    r->matrix = outer;
}

/// The sign between two cells, or rows, of a matrix, without blanks before it.
static void end_cell(reader *r, const char *sign) {
    while (r->out->n > 0 && r->out->text[r->out->n - 1] == ' ') {
        r->out->text[--r->out->n] = 0;
    }
    if (r->matrix) {
        hn_strbuf_printf(r->out, "%s ", sign);
        while (*r->at == ' ') {
            r->at++;
        }
    } else if (*sign == '\n') {
        hn_strbuf_add(r->out, sign);
    } else {
        hn_strbuf_add(r->out, " ");
        while (*r->at == ' ') {
            r->at++;
        }
    }
}

static bool read_known(reader *r, const char *name) {
    for (int i = 0; i < COUNT(SYMBOLS); i++) {
        if (strcmp(SYMBOLS[i].name, name) == 0) {
            hn_strbuf_add(r->out, SYMBOLS[i].text);
            return true;
        }
    }
    for (int i = 0; i < COUNT(PLAIN); i++) {
        if (strcmp(PLAIN[i], name) == 0) {
            read_argument(r, r->out);
            return true;
        }
    }
    for (int i = 0; i < COUNT(ACCENTS); i++) {
        if (strcmp(ACCENTS[i].name, name) == 0) {
            read_accent(r, ACCENTS[i].mark);
            return true;
        }
    }
    return false;
}

/// A blank, unless the text begins or ends with one.
static void put_blank(hn_strbuf *b) {
    const bool apart = b->n == 0 || strchr(" \n", hn_strbuf_text(b)[b->n - 1]);
    hn_strbuf_add(b, apart ? "" : " ");
}

/// A function such as \sin, apart from the factor before it and from what follows.
static void put_function(reader *r, const char *name) {
    const char *text = hn_strbuf_text(r->out);
    if (r->out->n > 0 && !strchr("([{-+/", text[r->out->n - 1])) {
        put_blank(r->out);
    }
    const bool apart = isalnum((unsigned char)*r->at) || *r->at == '\\';
    hn_strbuf_printf(r->out, "%s%s", name, apart ? " " : "");
}

/// A command; the backslash has been read. Returns 0 at \end, which is left to the block.
static int read_command(reader *r) {
    char name[MAX_NAME];
    read_name(r, name);

    // the end of a block belongs to the one that opened it
    if (strcmp(name, "end") == 0) {
        return 0;
    }

    // all else is read to its end here
    if (strcmp(name, "begin") == 0 && r->nesting < MAX_NESTING) {
        read_block(r);
    } else if (strcmp(name, "\\") == 0) {
        end_cell(r, r->matrix ? ";" : "\n");
        while (*r->at == ' ' || *r->at == '\n') {
            r->at++;
        }
    } else if (strcmp(name, "frac") == 0 || strcmp(name, "tfrac") == 0 ||
               strcmp(name, "dfrac") == 0) {
        read_fraction(r);
    } else if (strcmp(name, "sqrt") == 0) {
        hn_strbuf_add(r->out, "√(");
        read_argument(r, r->out);
        hn_strbuf_add(r->out, ")");
    } else if (strcmp(name, "mathbb") == 0) {
        // every blackboard letter is taken for the reals
        hn_strbuf_add(r->out, "ℝ");
        hn_strbuf inner;
        hn_strbuf_init(&inner);
        read_argument(r, &inner);
        hn_strbuf_reset(&inner);
    } else if (strcmp(name, "cdot") == 0 || strcmp(name, "times") == 0) {
        put_blank(r->out);
        hn_strbuf_add(r->out, name[0] == 'c' ? "· " : "× ");
        r->at += strspn(r->at, " ");
    } else if (!read_known(r, name)) {
        put_function(r, name);
    }
    return 1;
}

static void read_argument(reader *r, hn_strbuf *into) {
    reader inner = {.at = r->at, .out = into, .nesting = r->nesting + 1, .matrix = r->matrix};
    while (*inner.at == ' ') {
        inner.at++;
    }
    if (*inner.at == '{') {
        inner.at++;
        read_until(&inner, '}');
        inner.at += *inner.at == '}';
    } else if (*inner.at == '\\' && inner.nesting < MAX_NESTING) {
        inner.at++;
        read_command(&inner);
    } else if (*inner.at) {
        hn_strbuf_add_n(into, inner.at, first_character(inner.at));
        inner.at += first_character(inner.at);
    }
    r->at = inner.at;
}

/// ^ or _: digits as raised or lowered characters, everything else in brackets.
static void read_script(reader *r, bool raised) {
    hn_strbuf inner;
    hn_strbuf_init(&inner);
    read_argument(r, &inner);
    const char *text = hn_strbuf_text(&inner);
    const size_t digits = strspn(text, "0123456789-");
    if (strcmp(text, "ᵀ") == 0 || strcmp(text, "°") == 0 || strcmp(text, "'") == 0) {
        hn_strbuf_add(r->out, text);
    } else if (text[0] && digits == strlen(text)) {
        for (const char *p = text; *p; p++) {
            hn_strbuf_add(r->out, *p == '-' ? (raised ? "⁻" : "₋")
                                  : raised  ? RAISED[*p - '0']
                                            : LOWERED[*p - '0']);
        }
    } else {
        hn_strbuf_add(r->out, raised ? "^" : "_");
        hn_strbuf_printf(r->out, raised && !is_simple(text) ? "(%s)" : "%s", text);
    }
    hn_strbuf_reset(&inner);
}

/// Reads up to `stop`, to the \end of a block, or to the end.
static void read_until(reader *r, char stop) {
    r->nesting++;
    while (*r->at && (*r->at != stop || stop == 0)) {
        const char c = *r->at++;
        if (c == '\\') {
            if (!read_command(r)) {
                break;
            }
        } else if ((c == '^' || c == '_') && r->nesting < MAX_NESTING) {
            read_script(r, c == '^');
        } else if (c == '&') {
            end_cell(r, ",");
        } else if (c == '{' && r->nesting < MAX_NESTING) {
            read_until(r, '}');
            r->at += *r->at == '}';
        } else if (c != '}' && c != '{') {
            hn_strbuf_add_n(r->out, c == '\n' ? " " : &c, 1);
        }
    }
    r->nesting--;
}

void hn_tex_text(hn_strbuf *b, const char *tex) {
    reader r = {.at = tex, .out = b};
    while (*r.at) {
        read_until(&r, 0); // an \end without its \begin is stepped over
    }
}
