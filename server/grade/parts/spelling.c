// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/spelling.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_NAME = 64, MAX_NESTING = 50 };

// ---- characters beyond ASCII ----

// clang-format off
static const struct {
    const char *utf8, *ascii;
} CHARACTERS[] = {
    {"\xef\xbb\xbf", ""},                                                        // byte-order mark
    {"−", "-"},     {"–", "-"},    {"—", "-"},   {"‐", "-"},      {"‑", "-"},    // dashes
    {"×", "*"},     {"·", "*"},    {"⋅", "*"},   {"∗", "*"},      {"•", "*"},    // products
    {"÷", "/"},     {"∕", "/"},    {"⁄", "/"},   {"√", "sqrt"},                  // quotients
    {"⁰", "^0"},    {"¹", "^1"},   {"²", "^2"},  {"³", "^3"},     {"⁴", "^4"},   // powers
    {"₀", "0"},     {"₁", "1"},    {"₂", "2"},   {"₃", "3"},      {"₄", "4"},    // indices
    {"₅", "5"},     {"₆", "6"},    {"₇", "7"},   {"₈", "8"},      {"₉", "9"},    //
    {"α", "alpha"}, {"β", "beta"}, {"γ", "gamma"}, {"δ", "delta"}, {"θ", "theta"}, // letters
    {"ϑ", "theta"}, {"λ", "lambda"}, {"μ", "mu"}, {"π", "pi"},     {"ρ", "rho"},   //
    {"φ", "phi"},   {"ϕ", "phi"},  {"ψ", "psi"}, {"ω", "omega"}, {"ℓ", "l"},     //
    {"\xc2\xa0", " "}, {"\xe2\x80\x89", " "}, {"\xe2\x80\xaf", " "}, {"\xe2\x80\x8b", ""}, // spaces
    {"（", "("},    {"）", ")"},                                                 // wide brackets
};
// clang-format on
enum { N_CHARACTERS = sizeof CHARACTERS / sizeof *CHARACTERS };

/// Copies the text with the characters of the table in ASCII; others stay.
static void to_ascii(hn_strbuf *out, const char *text) {
    while (*text) {
        int i = (unsigned char)*text < 0x80 ? N_CHARACTERS : 0;
        while (i < N_CHARACTERS &&
               strncmp(text, CHARACTERS[i].utf8, strlen(CHARACTERS[i].utf8)) != 0) {
            i++;
        }

        if (i < N_CHARACTERS) {
            hn_strbuf_add(out, CHARACTERS[i].ascii);
            text += strlen(CHARACTERS[i].utf8);
        } else {
            hn_strbuf_add_n(out, text++, 1);
        }
    }
}

// ---- names ----

/// Functions of the parser, and what others call them. Capital letters are ignored.
static const char *const FUNCTIONS[][2] = {
    {"sin", "sin"},     {"cos", "cos"},     {"tan", "tan"},       {"asin", "asin"},
    {"acos", "acos"},   {"atan", "atan"},   {"arcsin", "asin"},   {"arccos", "acos"},
    {"arctan", "atan"}, {"sinh", "sinh"},   {"cosh", "cosh"},     {"tanh", "tanh"},
    {"exp", "exp"},     {"log", "log"},     {"ln", "log"},        {"sqrt", "sqrt"},
    {"abs", "abs"},     {"atan2", "atan2"}, {"arctan2", "atan2"}, {"sign", "sign"},
};
enum { N_FUNCTIONS = sizeof FUNCTIONS / sizeof *FUNCTIONS };

static const char *find_function(const char *name) {
    for (int i = 0; i < N_FUNCTIONS; i++) {
        if (strcasecmp(name, FUNCTIONS[i][0]) == 0) {
            return FUNCTIONS[i][1];
        }
    }
    return NULL;
}

static bool is_one_of(const char *const *words, const char *word) {
    while (*words && strcmp(*words, word) != 0) {
        words++;
    }
    return *words != NULL;
}

/// Modules that a formula copied from a program names before its functions.
static const char *const MODULES[] = {"np",    "numpy", "math", "Math",  "sp",
                                      "sympy", "cmath", "jnp",  "torch", NULL};
/// Commands of LaTeX that say nothing about the value.
static const char *const SILENT[] = {"left", "right", "big",    "Big",          "bigl", "bigr",
                                     "quad", "qquad", "mathrm", "operatorname", "text", NULL};
/// Commands that set the word in braces behind them upright; a function may be that word.
static const char *const UPRIGHT[] = {"mathrm", "operatorname", "text", NULL};
/// Letters of LaTeX that are written in two ways.
static const char *const LETTERS[][2] = {
    {"varphi", "phi"}, {"vartheta", "theta"}, {"varrho", "rho"}, {"ell", "l"}};
static const char *const PRODUCTS[] = {"cdot", "times", "ast", NULL};
static const char *const FRACTIONS[] = {"frac", "dfrac", "tfrac", NULL};

// ---- rewriting ----

typedef struct rewriter {
    const char *at;
    hn_strbuf *out;
    int latex;   ///< 1: factors side by side are multiplied
    int operand; ///< 1: the output ends in an operand
    int nesting;
} rewriter;

static void rewrite(rewriter *w, char stop);

static void skip_spaces(rewriter *w) {
    while (*w->at == ' ' || *w->at == '\t' || *w->at == '\n' || *w->at == '\r') {
        hn_strbuf_add_n(w->out, w->at++, 1);
    }
}

/// Called before an operand is written.
static void begin_operand(rewriter *w) {
    if (w->latex && w->operand) {
        hn_strbuf_add(w->out, "*");
    }
    w->operand = 0;
}

/// A name with its index: theta_1, theta_{12}; the backslash has been read.
static void read_name(rewriter *w, char name[MAX_NAME]) {
    size_t n = 0;
    while ((isalnum((unsigned char)*w->at) || *w->at == '_') && n < MAX_NAME - 1) {
        name[n++] = *w->at++;
    }
    if (n > 0 && name[n - 1] == '_' && *w->at == '{') {
        for (w->at++; isalnum((unsigned char)*w->at) && n < MAX_NAME - 1;) {
            name[n++] = *w->at++;
        }
        w->at += *w->at == '}';
    }
    name[n] = 0;
}

static void write_number(rewriter *w) {
    begin_operand(w);
    while (isdigit((unsigned char)*w->at) || *w->at == '.') {
        hn_strbuf_add_n(w->out, w->at++, 1);
    }

    // 1e-3, but not the e of 2exp(x)
    const char *digits = w->at + 1 + (w->at[0] && (w->at[1] == '-' || w->at[1] == '+'));
    if ((*w->at == 'e' || *w->at == 'E') && isdigit((unsigned char)*digits)) {
        hn_strbuf_add_n(w->out, w->at, (size_t)(digits - w->at));
        for (w->at = digits; isdigit((unsigned char)*w->at);) {
            hn_strbuf_add_n(w->out, w->at++, 1);
        }
    }
    w->operand = 1;
}

/// What stands between this bracket and its partner, in round brackets.
static void write_group(rewriter *w) {
    const char close = *w->at == '(' ? ')' : *w->at == '[' ? ']' : '}';
    w->at++;
    begin_operand(w);
    hn_strbuf_add(w->out, "(");
    rewrite(w, close);
    if (*w->at == close) {
        w->at++;
        hn_strbuf_add(w->out, ")");
    }
    w->operand = 1;
}

/// \frac{a}{b} as ((a)/(b)); without its braces it is left to the parser to report.
static void write_fraction(rewriter *w) {
    begin_operand(w);
    hn_strbuf_add(w->out, "(");
    for (int part = 0; part < 2; part++) {
        skip_spaces(w);
        if (*w->at == '{') {
            write_group(w);
        }
        w->operand = 0;
        hn_strbuf_add(w->out, part == 0 ? "/" : ")");
    }
    w->operand = 1;
}

static void write_word(rewriter *w);

/// The exponent of sin^2(x), which stands behind the argument in the parser's spelling.
static void read_exponent(rewriter *w, char exponent[MAX_NAME]) {
    exponent[0] = 0;
    if (*w->at != '^') {
        return;
    }
    const char *p = w->at + 1;
    const int braces = *p == '{';
    size_t n = 0;
    for (p += braces; isdigit((unsigned char)*p) && n < MAX_NAME - 1; p++) {
        exponent[n++] = *p;
    }
    exponent[n] = 0;
    if (n > 0 && (!braces || *p == '}')) {
        w->at = p + braces;
    } else {
        exponent[0] = 0;
    }
}

/// A function and its argument: a group or, in LaTeX, the one name that follows. A number without
/// brackets (sin 2x) is left to the parser to refuse: its end would be a guess.
static void write_function(rewriter *w, const char *function) {
    char exponent[MAX_NAME];
    begin_operand(w);
    hn_strbuf_add(w->out, function);
    read_exponent(w, exponent);
    skip_spaces(w);
    if (w->latex && strncmp(w->at, "\\left", 5) == 0) {
        w->at += 5;
    }

    // the argument, then the exponent that stood before it
    if (*w->at == '(' || *w->at == '[' || *w->at == '{') {
        write_group(w);
    } else if (w->latex && (isalpha((unsigned char)*w->at) || *w->at == '\\')) {
        hn_strbuf_add(w->out, "(");
        write_word(w);
        hn_strbuf_add(w->out, ")");
    }
    if (exponent[0]) {
        hn_strbuf_printf(w->out, "^%s", exponent);
    }
}

/// \operatorname{sin} is \sin: reads the braces when a function stands in them.
static void read_upright(rewriter *w, char name[MAX_NAME]) {
    rewriter ahead = *w;
    char word[MAX_NAME];
    if (*ahead.at++ != '{') {
        return;
    }
    read_name(&ahead, word);
    if (*ahead.at == '}' && find_function(word)) {
        w->at = ahead.at + 1;
        snprintf(name, MAX_NAME, "%s", word);
    }
}

/// Puts the plain letter for \varphi, \ell_1 and their like.
static void plain_letter(char name[MAX_NAME]) {
    for (size_t i = 0; i < sizeof LETTERS / sizeof *LETTERS; i++) {
        const size_t n = strlen(LETTERS[i][0]), m = strlen(LETTERS[i][1]);
        if (strncmp(name, LETTERS[i][0], n) == 0 && !isalpha((unsigned char)name[n])) {
            memmove(name + m, name + n, strlen(name + n) + 1);
            memcpy(name, LETTERS[i][1], m);
            return;
        }
    }
}

/// A name, a function, a module or a command of LaTeX.
static void write_word(rewriter *w) {
    const int command = *w->at == '\\';
    char name[MAX_NAME];
    w->at += command;
    if (command && !isalpha((unsigned char)*w->at)) {
        w->at += *w->at != 0; // "\," and other spaces
        return;
    }
    read_name(w, name);
    if (command && is_one_of(UPRIGHT, name)) {
        read_upright(w, name);
    } else if (command) {
        plain_letter(name);
    }
    if (command && is_one_of(SILENT, name)) {
        return;
    }
    if (is_one_of(MODULES, name) && *w->at == '.') {
        w->at++;
        return;
    }

    const char *function = find_function(name);
    if (command && is_one_of(PRODUCTS, name)) {
        hn_strbuf_add(w->out, "*");
        w->operand = 0;
    } else if (command && is_one_of(FRACTIONS, name) && w->nesting < MAX_NESTING) {
        write_fraction(w);
    } else if (function && w->nesting < MAX_NESTING) {
        write_function(w, function);
    } else {
        begin_operand(w);
        hn_strbuf_add(w->out, strcasecmp(name, "pi") == 0 ? "pi" : name);
        w->operand = 1;
    }
}

static void write_operator(rewriter *w) {
    if (*w->at == '$') {
        w->at++;
        return;
    }
    w->operand = *w->at == ')' || *w->at == ']' || *w->at == '}';
    hn_strbuf_add_n(w->out, w->at++, 1);
}

/// Rewrites up to the bracket `stop`, or to the end of the text.
static void rewrite(rewriter *w, char stop) {
    w->nesting++;
    w->operand = 0;
    for (skip_spaces(w); *w->at && *w->at != stop; skip_spaces(w)) {
        const int opens = *w->at == '(' || *w->at == '[' || *w->at == '{';
        if (isdigit((unsigned char)*w->at) || *w->at == '.') {
            write_number(w);
        } else if (isalpha((unsigned char)*w->at) || *w->at == '_' || *w->at == '\\') {
            write_word(w);
        } else if (opens && w->nesting < MAX_NESTING) {
            write_group(w);
        } else {
            write_operator(w);
        }
    }
    w->nesting--;
}

void hn_spelling_normalise(hn_strbuf *out, const char *text) {
    hn_strbuf ascii;
    hn_strbuf_init(&ascii);
    to_ascii(&ascii, text);
    rewriter w = {.at = hn_strbuf_text(&ascii), .out = out};
    w.latex = strchr(w.at, '\\') != NULL;
    rewrite(&w, 0);
    out->failed |= ascii.failed;
    hn_strbuf_reset(&ascii);
}

int hn_spelling_join(const char *name, char *out, size_t size) {
    size_t n = 0;
    for (const char *p = name; *p && n + 1 < size; p++) {
        if (*p != '_') {
            out[n++] = *p;
        }
    }
    out[n] = 0;
    return n > 0 && n < strlen(name) && strlen(name) < size;
}
